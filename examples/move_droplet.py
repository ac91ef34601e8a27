#!/usr/bin/python3
"""Moves the droplet on one channel to another: rosrun dmf_sim move_droplet.py 0 5"""
import sys

import actionlib
import rospy
from dmf_sim.msg import MoveDropletAction, MoveDropletGoal

rospy.init_node("move_droplet_example")
channel, target = map(int, rospy.myargv()[1:3])
client = actionlib.SimpleActionClient("chip_controller/move_droplet", MoveDropletAction)
client.wait_for_server()


def show(feedback):
    print(f"{feedback.progress:4.0%}, {feedback.time_left:.1f} s left: {feedback.text}")


client.send_goal(MoveDropletGoal(channel=channel, target=target), feedback_cb=show)
client.wait_for_result()
print(client.get_result().message)
sys.exit(client.get_state() != actionlib.GoalStatus.SUCCEEDED)
