#!/usr/bin/python3
"""The board behind the chip: capacitance, faults, a rail that halts itself, and why a droplet does not move."""
import json
import math
import os
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dmf_sim.msg import Capacitance, Command, ElectrodeArray, Event
from dmf_sim.srv import InjectFaultRequest

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import Chip, Listener  # noqa: E402


class BoardTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("board_test")
        cls.chip = Chip()
        cls.events = Listener("/chip/events", Event)
        cls.electrodes = Listener("/chip/electrodes", ElectrodeArray)

    def setUp(self):
        self.assertTrue(self.chip.reset().success)
        self.run_number = self.chip.get_state(False).state.run
        self.electrodes.messages.clear()

    def accepted(self, reply):
        self.assertTrue(reply.success, reply.message)
        return reply

    def inject(self, kind, channel=0, strength=0.0, everywhere=False):
        return self.accepted(self.chip.inject_fault(kind, channel, strength, everywhere))

    def voltages(self, expected):
        """Waits for these voltages on the pads."""
        message = self.electrodes.wait(
            lambda m: all(abs(e.voltage - v) < 1e-9 for e, v in zip(m.electrodes, expected)))
        self.electrodes.messages.clear()
        return message

    def halted_event(self, text):
        return self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.HALTED and text in e.message)

    def test_the_layout_says_what_voltage_and_sensing_do(self):
        layout = self.accepted(self.chip.get_layout()).layout
        self.assertEqual((layout.threshold_voltage, layout.breakdown_voltage, layout.cutoff_frequency), (25, 75, 2e4))
        self.assertAlmostEqual(layout.charging_time, 0.1 * layout.time_unit, delta=1e-12)
        self.assertAlmostEqual(layout.sensing_interval, 0.2 * layout.time_unit, delta=1e-12)
        self.assertAlmostEqual(layout.capacitance_noise, 1e-15, delta=1e-20)
        self.assertAlmostEqual(layout.capacitance_offset, 20e-15, delta=1e-20)
        self.assertEqual((layout.plate_gap, layout.filler_capacitance), (0, 0))
        cosines = math.cos(math.radians(50)) - math.cos(math.radians(120))
        self.assertAlmostEqual(layout.liquid_capacitance / (2 * 0.072 * cosines / (63 ** 2 - 25 ** 2)), 1, delta=1e-6)

    def test_capacitance_tells_where_the_liquid_is(self):
        readings = Listener("/chip/capacitance", Capacitance)
        first = readings.wait(lambda m: m.run == self.run_number)
        self.assertEqual(list(first.channels), [0, 1, 2, 3])
        self.accepted(self.chip.step(110))
        reading = readings.wait(lambda m: m.run == self.run_number and m.step == 100)
        layout = self.chip.get_layout().layout
        wetted = [(c - 20e-15) / (layout.liquid_capacitance * layout.length_unit ** 2) for c in reading.capacitance]
        noise = 5e-15 / (layout.liquid_capacitance * layout.length_unit ** 2)
        for dry in wetted[2:]:
            self.assertAlmostEqual(dry, 0, delta=noise)
        self.assertGreater(min(wetted[:2]), 8, "r_c^2; a droplet between both")
        self.assertTrue(all(m.step % 20 == 0 for m in readings.messages[1:] if m.run == self.run_number))
        self.inject("disconnected")
        self.accepted(self.chip.step(20))
        blind = readings.wait(lambda m: m.run == self.run_number and m.step == 120)
        for value in blind.capacitance:
            self.assertAlmostEqual(value, 20e-15, delta=5e-15)
        readings.stop()

    def test_a_short_halts_the_rail_and_is_found_and_survived(self):
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.inject("short", 2)
        reply = self.accepted(self.chip.set_electrodes([1, 2]))
        self.assertIn("channel 2 is shorted", reply.message)
        self.assertEqual(list(reply.applied_channels), [])
        self.halted_event("channel 2 is shorted")
        state = self.chip.get_state(False).state
        self.assertFalse(state.hv_enabled)
        self.assertIn("channel 2 is shorted", state.halted)
        diagnostics = Listener("/diagnostics", DiagnosticArray)
        report = diagnostics.wait(lambda d: d.status[1].level == DiagnosticStatus.ERROR)
        self.assertIn("channel 2 is shorted", report.status[1].message)
        diagnostics.stop()
        self.assertEqual(list(self.accepted(self.chip.detect_shorts()).channels), [2])
        self.assertEqual(list(self.accepted(self.chip.set_disabled_channels([2])).disabled_channels), [2])
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.assertEqual(self.chip.get_state(False).state.halted, "")
        refused = self.chip.detect_shorts()
        self.assertFalse(refused.success)
        self.assertIn("the rail is enabled", refused.message)
        reply = self.accepted(self.chip.set_electrodes([1, 2]))
        self.assertEqual(list(reply.applied_channels), [1])
        self.assertIn("disabled and left out: 2", reply.message)
        message = self.voltages([0, 63, 0, 0])
        self.assertEqual([e.disabled for e in message.electrodes], [False, False, True, False])

    def test_breakdown_shorts_the_pad(self):
        self.accepted(self.chip.set_electrodes([3]))
        self.assertIn("broke down", self.accepted(self.chip.set_hv(80, 1000, True)).message)
        self.halted_event("channel 3 broke down")
        self.assertEqual(list(self.accepted(self.chip.detect_shorts()).channels), [3])

    def test_halt_is_at_once_and_set_hv_ends_it(self):
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.accepted(self.chip.set_electrodes([1]))
        self.voltages([0, 63, 0, 0])
        self.accepted(self.chip.halt())
        self.voltages([0, 0, 0, 0])
        self.halted_event("commanded")
        driven = self.chip.set_electrode_voltages([1], [10])
        self.assertFalse(driven.success)
        self.assertIn("halted", driven.message)
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.accepted(self.chip.set_electrodes([1]))
        self.voltages([0, 63, 0, 0])

    def test_faults_of_pads_show_and_clear(self):
        self.accepted(self.chip.set_hv(60, 1000, True))
        self.accepted(self.chip.set_electrodes([0, 1]))
        self.inject(InjectFaultRequest.STUCK_OFF, 0)
        self.inject(InjectFaultRequest.WEAK, 1, 0.5)
        self.inject(InjectFaultRequest.STUCK_ON, 3)
        self.voltages([0, 30, 0, 60])
        self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.FAULT_INJECTED
                         and "channel 3: stuck_on" in e.message)
        self.inject(InjectFaultRequest.CLEAR, 1)
        self.voltages([0, 60, 0, 60])
        self.inject(InjectFaultRequest.CLEAR, 99, everywhere=True)
        self.voltages([60, 60, 0, 0])

    def test_explain_droplet_names_what_is_in_the_way(self):
        self.accepted(self.chip.step(50))
        unknown = self.chip.explain_droplet(9)
        self.assertFalse(unknown.success)
        self.assertIn("droplets are [1]", unknown.message)
        self.assertIn("no electrode is actuated", self.accepted(self.chip.explain_droplet(1)).message)
        self.accepted(self.chip.set_electrodes([1]))
        self.assertIn("the rail is disabled", self.chip.explain_droplet(1).message)
        self.accepted(self.chip.set_hv(20, 1000, True))
        low = self.accepted(self.chip.explain_droplet(1))
        self.assertIn("below the threshold of 25 V", low.message)
        self.assertTrue(25 < low.needed_voltage < 40, low.needed_voltage)
        self.assertEqual((low.has_nearest_channel, low.nearest_channel, low.nearest_distance), (True, 1, 0))
        self.assertEqual(list(low.channels), [0, 1])
        self.assertEqual(len(low.side_forces), 4)
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.assertIn("charging", self.chip.explain_droplet(1).message)
        self.accepted(self.chip.step(100))
        pulled = self.accepted(self.chip.explain_droplet(1))
        self.assertIn("pulled towards channel 1", pulled.message)
        self.assertGreater(pulled.driving_force.x, 0)
        self.assertAlmostEqual(pulled.driving_force.x, pulled.side_forces[0] - pulled.side_forces[2], delta=1e-12)
        self.accepted(self.chip.set_electrodes([3]))
        far = self.accepted(self.chip.explain_droplet(1))
        self.assertIn("does not reach channel 3", far.message)
        self.assertGreater(far.nearest_distance, 0)
        self.assertTrue(math.isnan(far.needed_voltage))

    def test_a_run_with_faults_is_re_simulated_and_restored(self):
        commands = Listener("/chip/commands", Command)
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.inject("weak", 1, 0.75)
        self.accepted(self.chip.set_electrodes([1]))
        self.accepted(self.chip.step(13))
        self.accepted(self.chip.set_disabled_channels([0]))
        self.accepted(self.chip.save_checkpoint("charging"))
        self.accepted(self.chip.step(30))
        end = self.chip.hash()
        told = commands.wait(lambda c: c.run == self.run_number and c.name == "inject_fault")
        self.assertEqual(json.loads(told.json),
                         {"command": "inject_fault", "kind": "weak", "channel": 1, "strength": 0.75})
        self.accepted(self.chip.load_checkpoint("charging"))
        self.accepted(self.chip.step(30))
        self.assertEqual(self.chip.hash(), end)
        self.assertTrue(self.chip.reset().success)
        self.accepted(self.chip.set_hv(63, 1000, True))
        self.inject("weak", 1, 0.75)
        self.accepted(self.chip.set_electrodes([1]))
        self.accepted(self.chip.step(13))
        self.accepted(self.chip.set_disabled_channels([0]))
        self.accepted(self.chip.step(30))
        self.assertEqual(self.chip.hash(), end)
        commands.stop()


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "board_test", BoardTest)
