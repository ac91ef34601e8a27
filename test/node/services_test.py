#!/usr/bin/python3
"""Every service of the chip: what it does, and what it refuses without changing a bit of the state."""
import math
import os
import subprocess
import sys
import unittest

import rospy
import rostest
from dmf_sim.msg import Command, DropletArray, ElectrodeArray, Event

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import Chip, Listener  # noqa: E402

NAN, INF = math.nan, math.inf

# service, arguments, what the refusal has to name.
BAD_INPUT = [
    ("set_electrodes", ([9],), ["9", "0-3"]),
    ("set_electrodes", ([1, 1],), ["1", "twice"]),
    ("set_electrodes", ([0, 4294967295],), ["4294967295", "0-3"]),
    ("set_hv", (81.0, 1000.0, True), ["81", "80"]),
    ("set_hv", (-1.0, 1000.0, True), ["-1", "80"]),
    ("set_hv", (NAN, 1000.0, True), ["nan", "80"]),
    ("set_hv", (63.0, INF, True), ["inf", "frequency"]),
    ("set_hv", (63.0, -5.0, True), ["-5", "frequency"]),
    ("set_electrode_voltages", ([1, 2], [10.0]), ["2", "1"]),
    ("set_electrode_voltages", ([7], [10.0]), ["7", "0-3"]),
    ("set_electrode_voltages", ([1], [100.0]), ["100", "80"]),
    ("set_electrode_voltages", ([1], [NAN]), ["nan", "80"]),
    ("set_electrode_voltages", ([2, 2], [1.0, 1.0]), ["2", "twice"]),
    ("set_electrode_voltages", ([], []), ["channels"]),
    ("set_wettability", ([0.0, 1e-5], [90.0]), ["2", "1"]),
    ("set_wettability", ([1e-5, 0.0], [90.0, 80.0]), ["rising"]),
    ("set_wettability", ([0.0, 0.0], [90.0, 80.0]), ["rising"]),
    ("set_wettability", ([0.0, 1.0], [90.0, 80.0]), ["plate"]),
    ("set_wettability", ([0.0, 1e-5], [90.0, 190.0]), ["190"]),
    ("set_wettability", ([NAN, 1e-5], [90.0, 80.0]), ["nan"]),
    ("set_wettability", ([0.0, 1e-5], [90.0, NAN]), ["nan"]),
    ("set_wettability", ([], []), ["positions"]),
    ("load_pattern", ("blank",), ["blank", "blink"]),
    ("load_pattern", ("",), ["blink"]),
    ("dispense_droplet", (-9e-5, 0.0, 1e-13), ["occupied"]),
    ("dispense_droplet", (1.0, 0.0, 1e-13), ["x", "1"]),
    ("dispense_droplet", (9e-5, 0.0, -1e-13), ["volume", "-1e-13"]),
    ("dispense_droplet", (9e-5, 0.0, 1e-9), ["radius"]),
    ("dispense_droplet", (9e-5, 0.0, 1e-18), ["20"]),
    ("dispense_droplet", (9e-5, NAN, 1e-13), ["nan"]),
    ("dispense_droplet", (9e-5, 0.0, INF), ["inf"]),
    ("remove", (99,), ["99"]),
    ("remove", (0,), ["0"]),
    ("step", (0,), ["0", "1000000"]),
    ("step", (1000001,), ["1000001", "1000000"]),
    ("save_checkpoint", ("../outside",), ["../outside", "bare"]),
    ("save_checkpoint", ("/tmp/outside",), ["/tmp/outside", "bare"]),
    ("save_checkpoint", ("",), ["bare"]),
    ("load_checkpoint", ("missing",), ["missing"]),
    ("load_checkpoint", ("../../etc/passwd",), ["../../etc/passwd", "bare"]),
]


class ServicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("services_test")
        cls.chip = Chip()
        cls.events = Listener("/chip/events", Event)
        cls.commands = Listener("/chip/commands", Command)

    def setUp(self):
        self.assertTrue(self.chip.reset().success)
        self.run_number = self.chip.get_state(False).state.run

    def accepted(self, reply):
        self.assertTrue(reply.success, reply.message)
        return reply

    def test_bad_input_is_refused_by_name_and_changes_nothing(self):
        self.accepted(self.chip.step(5))
        before = self.chip.hash()
        for service, arguments, named in BAD_INPUT:
            call = f"{service}{arguments}"
            reply = getattr(self.chip, service)(*arguments)
            self.assertFalse(reply.success, f"{call}: {reply.message}")
            for word in named:
                self.assertIn(word, reply.message, call)
            self.assertEqual(self.chip.hash(), before, call)
        told = [c for c in self.commands.messages if c.run == self.run_number and c.name != "reset"]
        self.assertEqual(told, [], "a refused command is none")

    def test_layout_is_the_scenes(self):
        layout = self.accepted(self.chip.get_layout()).layout
        self.assertEqual([e.channel for e in layout.electrodes], [0, 1, 2, 3])
        self.assertEqual([tuple(e.neighbours) for e in layout.electrodes], [(1,), (0, 2), (1, 3), (2,)])
        self.assertAlmostEqual(layout.electrodes[0].centroid.x, -9 * layout.length_unit, delta=1e-9)
        self.assertEqual(layout.max_voltage, 80)

    def test_rail_and_channels_show_on_the_electrodes(self):
        electrodes = Listener("/chip/electrodes", ElectrodeArray)
        reply = self.accepted(self.chip.set_electrodes([2, 1]))
        self.assertEqual(sorted(reply.applied_channels), [1, 2])
        self.accepted(self.chip.set_hv(63, 1000, True))
        message = electrodes.wait(lambda m: m.hv_enabled and m.electrodes[1].on)
        self.assertEqual([e.voltage for e in message.electrodes], [0, 63, 63, 0])
        self.assertAlmostEqual(message.electrodes[1].contact_angle_deg, 50)
        self.assertAlmostEqual(message.electrodes[0].contact_angle_deg, 120)
        self.accepted(self.chip.set_hv(63, 1000, False))
        message = electrodes.wait(lambda m: not m.hv_enabled and m.electrodes[1].on)
        self.assertEqual([e.voltage for e in message.electrodes], [0, 0, 0, 0])
        self.assertEqual(list(self.accepted(self.chip.set_electrodes([])).applied_channels), [])
        electrodes.stop()

    def test_single_electrodes_can_be_driven_past_the_rail(self):
        electrodes = Listener("/chip/electrodes", ElectrodeArray)
        self.accepted(self.chip.set_electrode_voltages([0, 3], [20, 40]))
        message = electrodes.wait(lambda m: m.electrodes[3].voltage > 0)
        self.assertEqual([e.voltage for e in message.electrodes], [20, 0, 0, 40])
        self.accepted(self.chip.set_electrode_voltages([0], [0]))
        electrodes.wait(lambda m: m.electrodes[0].voltage == 0 and m.electrodes[3].voltage == 40)
        electrodes.stop()

    def test_wettability_program_replaces_the_electrodes(self):
        electrodes = Listener("/chip/electrodes", ElectrodeArray)
        self.accepted(self.chip.set_wettability([-9e-5, 9e-5], [130, 70]))
        message = electrodes.wait(lambda m: abs(m.electrodes[0].contact_angle_deg - 130) < 0.1)
        for got, expected in zip(message.electrodes, (130, 110, 90, 70)):
            self.assertAlmostEqual(got.contact_angle_deg, expected, delta=0.1)
        electrodes.stop()

    def test_pattern_plays_its_sequence(self):
        electrodes = Listener("/chip/electrodes", ElectrodeArray)
        self.accepted(self.chip.load_pattern("blink"))
        electrodes.wait(lambda m: m.electrodes[0].on)
        self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.PATTERN and "blink" in e.message)
        self.accepted(self.chip.step(20))
        electrodes.wait(lambda m: m.step >= 10 and not m.electrodes[0].on)
        self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.SCHEDULED and e.step == 10)
        electrodes.stop()

    def test_droplets_come_and_go(self):
        droplets = Listener("/chip/droplets", DropletArray)
        self.accepted(self.chip.dispense_droplet(9e-5, 0, 8e-14))
        self.accepted(self.chip.step(50))
        two = droplets.wait(lambda m: m.step == 50 and len(m.droplets) == 2).droplets
        new = max(two, key=lambda d: d.centroid.x)
        self.assertAlmostEqual(new.centroid.x, 9e-5, delta=1e-5)
        self.assertAlmostEqual(new.volume, 8e-14, delta=2e-14)
        self.assertEqual(list(new.parents), [])
        self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.APPEARED and new.id in e.after)
        self.accepted(self.chip.remove(new.id))
        self.accepted(self.chip.step(50))
        left = droplets.wait(lambda m: m.step == 100 and len(m.droplets) == 1).droplets
        self.assertNotEqual(left[0].id, new.id)
        droplets.stop()

    def test_commands_are_on_record_with_their_step(self):
        self.accepted(self.chip.step(7))
        self.accepted(self.chip.set_hv(12.5, 50, True))
        record = self.commands.wait(lambda c: c.run == self.run_number and c.name == "set_hv")
        self.assertEqual(record.step, 7)
        self.assertIn("12.5", record.json)
        # A process of its own: within one, rospy shares a connection between all subscribers.
        late = subprocess.run(["rostopic", "echo", "-n", "2", "/chip/commands"], capture_output=True, text=True,
                              timeout=20, check=True)
        self.assertIn('"reset"', late.stdout)
        self.assertIn("set_hv", late.stdout)

    def test_commands_while_paused_say_so(self):
        self.assertIn("paused", self.chip.set_hv(10, 0, True).message)

    def test_a_checkpoint_brings_the_same_state_back(self):
        self.accepted(self.chip.step(20))
        saved = self.chip.hash()
        self.accepted(self.chip.save_checkpoint("first"))
        self.accepted(self.chip.step(20))
        later = self.chip.hash()
        self.assertNotEqual(saved, later)
        self.accepted(self.chip.load_checkpoint("first"))
        self.assertEqual(self.chip.hash(), saved)
        self.accepted(self.chip.step(20))
        self.assertEqual(self.chip.hash(), later)
        self.assertEqual(self.chip.get_state(False).state.run, self.run_number + 1)

    def test_step_is_refused_while_the_chip_runs(self):
        self.chip.unpause_physics()
        try:
            reply = self.chip.step(5)
            self.assertFalse(reply.success)
            self.assertIn("pause_physics", reply.message)
        finally:
            self.chip.pause_physics()

    def test_bad_parameters_end_the_node_with_one_line(self):
        chip = subprocess.run(["rospack", "find", "dmf_sim"], capture_output=True, text=True, check=True)
        scene = os.path.join(chip.stdout.strip(), "test/scenes/tiny_line.yaml")
        for given, named in ((["_threads:=-1"], ["~threads", "-1", "0 to 256"]),
                             (["_publish_rate:=fast"], ["~publish_rate", "fast", "0.1 to 1000"]),
                             (["_seed:=-4"], ["~seed", "-4", "0 to"]),
                             (["_treads:=2"], ["~treads", "threads"]),
                             (["_kernel:=quantum"], ["quantum", "reference"]),
                             (["_scene:=no_such_scene"], ["no_such_scene", "electrode_line"]),
                             (["_paused:=maybe", "_threads:=x"], ["~paused", "~threads"])):
            # A name for each: parameters stay on the master.
            name = "bad" + "".join(filter(str.isalnum, given[0]))
            ended = subprocess.run(["rosrun", "dmf_sim", "chip", f"__name:={name}", *given]
                                   + ([] if "scene" in given[0] else [f"_scene:={scene}"]),
                                   capture_output=True, text=True, timeout=20, check=False)
            self.assertNotEqual(ended.returncode, 0, given)
            self.assertEqual(len(ended.stderr.strip().splitlines()), 1, ended.stderr)
            for word in named:
                self.assertIn(word, ended.stderr)


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "services_test", ServicesTest)
