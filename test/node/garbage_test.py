#!/usr/bin/python3
"""Four clients that send garbage while a run goes on don't change one bit of it, and the node takes no more memory."""
import json
import os
import subprocess
import sys
import unittest

import rospy
import rostest

HERE = os.path.dirname(os.path.realpath(__file__))
sys.path.insert(0, HERE)
from chip_client import Chip, memory_of, pid_of  # noqa: E402

CLIENTS = 4


class GarbageTest(unittest.TestCase):
    def test_a_run_among_garbage_has_the_same_bits(self):
        rospy.init_node("garbage_test")
        calls = rospy.get_param("~calls", 1000)
        chip = Chip()
        # Commands that are taken, once for the run among garbage and once for the same run alone.
        def begin():
            self.assertTrue(chip.set_hv(60.0, 1000.0, True).success)
            self.assertTrue(chip.set_electrodes([1]).success)
        begin()
        chip.unpause_physics()
        clients = [subprocess.Popen([sys.executable, "-B", os.path.join(HERE, "garbage_client.py"),
                                     str(calls // CLIENTS), str(seed)], stdout=subprocess.PIPE, text=True)
                   for seed in range(CLIENTS)]
        for client in clients:
            output, _ = client.communicate(timeout=800)
            self.assertEqual(client.returncode, 0)
            self.assertEqual(json.loads(output), [])
        chip.pause_physics()
        steps, found = chip.get_state(False).state.step, chip.hash()
        self.assertGreater(steps, 50)
        print(f"{steps} steps among {calls} calls")

        self.assertTrue(chip.reset().success)
        begin()
        self.assertTrue(chip.step(steps).success)
        self.assertEqual(chip.hash(), found)
        # A list that claims more than memory must not be taken at its word.
        peak = memory_of(pid_of("/chip"), "VmHWM")
        print(f"peak memory {peak:.0f} MB after {calls} calls")
        self.assertLess(peak, 1000)


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "garbage_test", GarbageTest)
