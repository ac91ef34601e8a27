#!/usr/bin/python3
"""What becomes of the liquid: dispense, mix, merge and split over their actions, between two plates, in one go."""
import unittest

import rospy
import rostest
from actionlib import GoalStatus
from chip_client import Chip, Listener
from controller_client import Client
from dmf_sim.msg import (DispenseAction, DispenseGoal, DropletArray, MergeAction, MergeGoal, MixAction, MixGoal,
                         SensedDropletArray, SplitAction, SplitGoal)


class ControllerOperationsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("controller_operations_test")
        cls.electrodes = Chip().get_layout().layout.electrodes
        sensed = Listener("/chip_controller/droplets", SensedDropletArray)
        sensed.wait(lambda m: sorted(d.channel for d in m.droplets) == [4, 6])
        sensed.stop()

    def run_and_check(self, name, action, goal, words):
        handle = Client(name, action).run(goal, 90)
        result = handle.get_result()
        self.assertEqual(handle.get_goal_status(), GoalStatus.SUCCEEDED, result.message)
        self.assertIn(words, result.message)
        return result

    def nearest(self, droplet):
        return min(self.electrodes, key=lambda e: (e.centroid.x - droplet.centroid.x)**2
                   + (e.centroid.y - droplet.centroid.y)**2).channel

    def volumes(self):
        """Of the droplets as the simulation knows them, m^3, by the electrode nearest to each."""
        listener = Listener("/chip/droplets", DropletArray)
        message = listener.wait(lambda m: m.droplets)
        listener.stop()
        found = {self.nearest(droplet): droplet.volume for droplet in message.droplets}
        self.assertEqual(len(found), len(message.droplets), "one droplet an electrode")
        return found

    def test_a_droplet_is_dispensed_mixed_merged_and_split(self):
        before = self.volumes()
        self.assertEqual(set(before), {4, 6})

        self.run_and_check("dispense", DispenseAction, DispenseGoal(reservoir=6, path=[0, 1], least=0.5),
                           "dispensed a droplet onto electrode 1")
        dispensed = self.volumes()
        self.assertEqual(set(dispensed), {1, 4, 6})
        self.assertAlmostEqual((dispensed[1] + dispensed[6]) / before[6], 1, delta=0.02)

        result = self.run_and_check("mix", MixAction, MixGoal(channel=1, loop=[2], laps=1), "mixed in 1 laps")
        self.assertEqual([d.channel for d in result.droplets], [1])
        self.assertEqual(set(self.volumes()), {1, 4, 6})

        self.run_and_check("merge", MergeAction, MergeGoal(channel=1, into=4), "merged on electrode 4")
        merged = self.volumes()
        self.assertEqual(set(merged), {4, 6})
        self.assertAlmostEqual(merged[4] / (dispensed[1] + dispensed[4]), 1, delta=0.02)

        result = self.run_and_check("split", SplitAction, SplitGoal(channel=4, onto=[3, 5]),
                                    "split onto electrodes 3 and 5")
        self.assertEqual(sorted(d.channel for d in result.droplets), [3, 5])
        halves = self.volumes()
        self.assertEqual(set(halves), {3, 5, 6})
        self.assertAlmostEqual((halves[3] + halves[5]) / merged[4], 1, delta=0.02)
        # The neck's liquid, up to 0.3 of two electrodes, goes to either end, and a tenth may lie off the middle.
        self.assertGreater(min(halves[3], halves[5]), 0.35 * merged[4])


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "controller_operations_test", ControllerOperationsTest)
