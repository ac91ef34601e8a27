"""What the tests of the controller's node share."""
import time

import actionlib
import rospy
from chip_client import PATIENCE


class Client:
    """An action client that waits by wall time and keeps the feedback."""

    def __init__(self, name, kind):
        self.client = actionlib.ActionClient(f"chip_controller/{name}", kind)
        assert self.client.wait_for_server(rospy.Duration(60 * PATIENCE)), name

    def send(self, goal):
        feedback = []
        handle = self.client.send_goal(goal, feedback_cb=lambda handle, message: feedback.append(message))
        handle.feedback = feedback
        return handle

    def run(self, goal, patience=60):
        return self.wait(self.send(goal), patience)

    @staticmethod
    def wait(handle, patience=60):
        end = time.time() + patience * PATIENCE
        while handle.get_comm_state() != actionlib.CommState.DONE:
            assert time.time() < end, handle.feedback[-1:]
            time.sleep(0.02)
        return handle
