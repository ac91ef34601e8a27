#!/usr/bin/python3
"""Chip and controller together: every action over the public interface only."""
import subprocess
import time
import unittest

import rospy
import rostest
from actionlib import GoalStatus
from chip_client import Chip, Listener
from controller_client import Client
from dmf_sim.msg import (DispenseAction, DispenseGoal, DropletArray, ElectrodeArray, MergeAction, MergeGoal, MixAction,
                         MixGoal, MoveDropletAction, MoveDropletGoal, OperationLimits, RunProtocolAction,
                         RunProtocolGoal, SensedDropletArray, SplitAction, SplitGoal)


class ControllerTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("controller_test")
        cls.chip = Chip()
        cls.move = Client("move_droplet", MoveDropletAction)
        cls.merge = Client("merge", MergeAction)
        cls.split = Client("split", SplitAction)
        cls.dispense = Client("dispense", DispenseAction)
        cls.mix = Client("mix", MixAction)
        cls.protocol = Client("run_protocol", RunProtocolAction)

    def setUp(self):
        self.assertTrue(self.chip.reset().success)
        time.sleep(0.3)  # of wall time: the controller hears that the rail is off
        # Until it has seen both droplets where the scene has them.
        sensed = Listener("/chip_controller/droplets", SensedDropletArray)
        sensed.wait(lambda m: sorted(d.channel for d in m.droplets) == [0, 5])
        sensed.stop()

    def droplets_on(self):
        """The electrodes under the droplets as the simulation knows them: the controller is not asked."""
        listener = Listener("/chip/droplets", DropletArray)
        message = listener.wait(lambda m: m.droplets)
        listener.stop()
        return [d.centroid.x for d in message.droplets]

    def check(self, handle, status, *words):
        result = handle.get_result()
        self.assertEqual(handle.get_goal_status(), status, result.message)
        for word in words:
            self.assertIn(word, result.message)
        return result

    def test_a_droplet_is_moved_and_tells_how_far_it_is(self):
        handle = self.move.run(MoveDropletGoal(channel=0, target=2))
        result = self.check(handle, GoalStatus.SUCCEEDED, "moved to electrode 2")
        self.assertEqual([d.channel for d in result.droplets], [2])
        progress = [f.progress for f in handle.feedback]
        self.assertGreater(len(progress), 10)
        self.assertEqual(progress, sorted(progress))
        self.assertTrue(all(f.time_left >= 0 and f.text for f in handle.feedback))
        layout = self.chip.get_layout().layout
        goal = next(e.centroid.x for e in layout.electrodes if e.channel == 2)
        self.assertLess(min(abs(x - goal) for x in self.droplets_on()), 3 * layout.length_unit)

    def test_goals_that_cannot_be_are_rejected_with_the_reason(self):
        for client, goal, words in (
                (self.move, MoveDropletGoal(channel=0, target=40), ["to: 40", "0-6"]),
                (self.move, MoveDropletGoal(channel=0, target=8), ["to: 8", "0-6"]),
                (self.move, MoveDropletGoal(channel=0, path=[1, 7]), ["path: 7", "0-6"]),
                (self.move, MoveDropletGoal(channel=0, path=[2]), ["path: from 0 to 2", "one of 1, 6"]),
                (self.move, MoveDropletGoal(channel=3, target=4), ["no droplet on channel 3"]),
                (self.move, MoveDropletGoal(channel=0, target=1, limits=OperationLimits(success_threshold=1.5)),
                 ["success_threshold: 1.5", "(0, 1]"]),
                (self.move, MoveDropletGoal(channel=0, target=1, limits=OperationLimits(timeout=-1)), ["timeout: -1"]),
                (self.merge, MergeGoal(channel=0, into=0), ["into: 0"]),
                (self.split, SplitGoal(channel=0), ["opposite"]),
                (self.dispense, DispenseGoal(reservoir=0, path=[1]), ["path: 1 channels"]),
                (self.mix, MixGoal(channel=0, laps=5000), ["laps: 5000"])):
            self.check(client.run(goal, 10), GoalStatus.REJECTED, *words)

    def test_a_second_operation_on_a_droplet_is_rejected_and_cancel_holds_it(self):
        first = self.move.send(MoveDropletGoal(channel=0, target=3))
        end = time.time() + 20
        while not first.feedback and time.time() < end:
            time.sleep(0.01)
        self.check(self.move.run(MoveDropletGoal(channel=0, target=1), 10), GoalStatus.REJECTED, "another operation")
        first.cancel()
        self.move.wait(first, 10)
        result = self.check(first, GoalStatus.PREEMPTED, "cancelled")
        electrodes = Listener("/chip/electrodes", ElectrodeArray)
        message = electrodes.wait(lambda m: m.electrodes)
        electrodes.stop()
        on = [e.channel for e in message.electrodes if e.on]
        self.assertIn(5, on, "the droplet that nobody moved is held")
        self.assertEqual(len(on), 2)
        self.assertTrue(set(on) & set(result.droplets[0].channels), "and so is this one")

    def test_two_droplets_move_at_once(self):
        right = self.move.send(MoveDropletGoal(channel=0, target=6))
        left = self.move.send(MoveDropletGoal(channel=5, target=3))
        self.check(self.move.wait(right), GoalStatus.SUCCEEDED)
        self.check(self.move.wait(left), GoalStatus.SUCCEEDED)

    def test_an_electrode_at_fault_is_named(self):
        self.assertTrue(self.chip.inject_fault("stuck_off", 1, 0, False).success)
        self.check(self.move.run(MoveDropletGoal(channel=0, target=2)), GoalStatus.ABORTED,
                   "electrode 1 does not answer", "The board says")
        self.chip.inject_fault("clear", 0, 0, True)

    def test_a_disabled_electrode_is_named(self):
        self.assertTrue(self.chip.set_disabled_channels([1]).success)
        self.check(self.move.run(MoveDropletGoal(channel=0, target=2)), GoalStatus.ABORTED, "electrode 1 is disabled")
        self.assertTrue(self.chip.set_disabled_channels([]).success)

    def test_a_halt_ends_an_operation_by_name(self):
        handle = self.move.send(MoveDropletGoal(channel=0, target=3))
        end = time.time() + 20
        while not handle.feedback and time.time() < end:
            time.sleep(0.01)
        self.chip.halt()
        self.check(self.move.wait(handle), GoalStatus.ABORTED, "high-voltage rail is off")

    def test_a_blocked_droplet_names_who_is_in_its_way(self):
        self.check(self.move.run(MoveDropletGoal(channel=0, target=4)), GoalStatus.ABORTED, "blocked by droplet")

    def test_the_examples_do_what_they_say(self):
        for example, channel, target in (("move_droplet.py", 0, 1), ("move_droplet", 1, 0)):
            done = subprocess.run(["rosrun", "dmf_sim", example, str(channel), str(target)], capture_output=True,
                                  text=True, timeout=60, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn(f"moved to electrode {target}", done.stdout)
        refused = subprocess.run(["rosrun", "dmf_sim", "move_droplet.py", "0", "40"], capture_output=True, text=True,
                                 timeout=60, check=False)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("to: 40", refused.stdout)

    def test_protocols_run_from_file_and_text(self):
        back = "steps:\n  - move: {channel: 1, to: 0}\n  - wait: 0.1 s\n"
        for goal in (RunProtocolGoal(protocol="walk"), RunProtocolGoal(yaml=back),
                     RunProtocolGoal(protocol="walk.yaml")):
            handle = self.protocol.run(goal)
            result = self.check(handle, GoalStatus.SUCCEEDED, "2 steps done")
            self.assertEqual(result.steps_done, 2)
            self.assertEqual({f.steps for f in handle.feedback}, {2})

    def test_bad_protocols_are_rejected_line_by_line(self):
        text = "steps:\n  - move: {channel: 0, to: 9}\n  - wait: -1 s\n  - {channels: [77], duration: 1 s}\n"
        self.check(self.protocol.run(RunProtocolGoal(yaml=text), 10), GoalStatus.REJECTED, "yaml:2:", "yaml:3:",
                   "yaml:4:", "channel 77")
        self.check(self.protocol.run(RunProtocolGoal(), 10), GoalStatus.REJECTED, "one of both")
        self.check(self.protocol.run(RunProtocolGoal(protocol="no_such"), 10), GoalStatus.REJECTED, "no_such")

    def test_a_protocol_can_be_cancelled(self):
        handle = self.protocol.send(RunProtocolGoal(protocol="walk"))
        end = time.time() + 20
        while not handle.feedback and time.time() < end:
            time.sleep(0.01)
        self.check(self.protocol.run(RunProtocolGoal(protocol="walk"), 10), GoalStatus.REJECTED, "under way")
        handle.cancel()
        self.check(self.protocol.wait(handle, 10), GoalStatus.PREEMPTED, "cancelled in step")


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "controller_test", ControllerTest)
