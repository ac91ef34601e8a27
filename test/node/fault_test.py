#!/usr/bin/python3
"""After an instability the chip says why, refuses commands, and recovers by ~reset."""
import math
import os
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dmf_sim.msg import ChipState, Event

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import Chip, Listener  # noqa: E402


class FaultTest(unittest.TestCase):
    def test_a_fault_is_told_and_reset_recovers(self):
        rospy.init_node("fault_test")
        chip = Chip()
        events = Listener("/chip/events", Event)
        states = Listener("/chip/state", ChipState)
        # The chip may have failed before this test could listen: fail again while it does.
        states.wait(lambda s: s.fault)
        self.assertTrue(chip.reset().success)
        chip.unpause_physics()
        event = events.wait(lambda e: e.kind == Event.FAULT and e.run == 1)
        state = states.wait(lambda s: s.fault and s.run == 1)
        self.assertEqual(state.fault, event.message)
        self.assertTrue(state.paused)
        self.assertEqual(state.limited_by, "fault")
        self.assertTrue(all(math.isfinite(s.temperature_mdpd) for s in states.messages))

        diagnostics = Listener("/diagnostics", DiagnosticArray)
        report = diagnostics.wait(lambda d: d.status[0].level == DiagnosticStatus.ERROR)
        self.assertIn(state.fault, report.status[0].message)

        for reply in (chip.set_hv(1, 0, False), chip.step(1), chip.save_checkpoint("broken")):
            self.assertFalse(reply.success)
            self.assertIn(state.fault, reply.message)
        with self.assertRaisesRegex(rospy.ServiceException, "halted"):
            chip.unpause_physics()
        self.assertFalse(chip.get_state(True).success)

        self.assertTrue(chip.reset().success)
        self.assertEqual(chip.get_state(False).state.fault, "")
        self.assertEqual(chip.get_state(False).state.step, 0)


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "fault_test", FaultTest)
