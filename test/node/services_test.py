#!/usr/bin/python3
"""Every service of the chip: what it does, and what it refuses without changing a bit of the state."""
import json
import math
import os
import subprocess
import sys
import unittest

import rospy
import rostest
from dmf_sim.msg import Command, DropletArray, ElectrodeArray, Event, Microparticle, MicroparticleArray
from geometry_msgs.msg import Point, Vector3

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
    ("dispense_droplet", (-9e-5, 0.0, 1e-13, 0.0, ""), ["occupied"]),
    ("dispense_droplet", (1.0, 0.0, 1e-13, 0.0, ""), ["x", "1"]),
    ("dispense_droplet", (9e-5, 0.0, -1e-13, 0.0, ""), ["volume", "-1e-13"]),
    ("dispense_droplet", (9e-5, 0.0, 1e-9, 0.0, ""), ["radius"]),
    ("dispense_droplet", (9e-5, 0.0, 1e-18, 0.0, ""), ["20"]),
    ("dispense_droplet", (9e-5, NAN, 1e-13, 0.0, ""), ["nan"]),
    ("dispense_droplet", (9e-5, 0.0, INF, 0.0, ""), ["inf"]),
    ("dispense_droplet", (9e-5, 0.0, 1e-13, 0.0, "oil"), ["oil", "liquid"]),
    ("remove", (99, 0), ["droplet 99"]),
    ("remove", (0, 0), ["droplet 0", "microparticle 0"]),
    ("remove", (1, 1), ["droplet 1", "microparticle 1"]),
    ("add_microparticle", {"x": NAN, "radius": 1e-5}, ["x", "nan"]),
    ("add_microparticle", {"x": 3e-5}, ["radius", "0"]),
    ("add_microparticle", {"x": 3e-5, "radius": INF}, ["radius", "inf"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "height": -1e-6}, ["height", "-1e-06"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "mass": -1.0}, ["mass", "-1"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "contact_angle_deg": 20.0}, ["contact angle: 20 degrees", "calibrated range"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "contact_angle_deg": 100.0, "attraction_mdpd": -15.0},
     ["contact_angle_deg", "attraction_mdpd"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "beads": 612, "points": [Point()]}, ["612", "points"]),
    ("add_microparticle", {"x": -9e-5, "radius": 1e-5}, ["to the liquid"]),
    ("add_microparticle", {"x": 1.35e-4, "radius": 1e-5}, ["x 13.5", "-13 to 13"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-3}, ["radius", "0.5 to 20"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "beads": 613}, ["613", "612"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "static_friction": -1.0}, ["static_friction", "-1"]),
    ("add_microparticle", {"x": 3e-5, "radius": 1e-5, "kinetic_friction": 0.5}, ["kinetic_friction", "0.5"]),
    ("remove", (0, 7), ["microparticle 7"]),
    ("set_body_forces", (Vector3(0, 0, 1e15), Vector3()), ["gravity"]),
    ("set_body_forces", (Vector3(0, NAN, 0), Vector3()), ["gravity", "nan"]),
    ("set_body_forces", (Vector3(), Vector3(0, 0, INF)), ["magnetic", "inf"]),
    ("inject_fault", ("melted", 1, 0.0, False), ["melted", "stuck_on"]),
    ("inject_fault", ("", 1, 0.0, False), ["kind", "disconnected"]),
    ("inject_fault", ("stuck_on", 9, 0.0, False), ["9", "0-3"]),
    ("inject_fault", ("weak", 1, 1.5, False), ["1.5", "0 to 1"]),
    ("inject_fault", ("weak", 1, NAN, False), ["nan", "0 to 1"]),
    ("inject_fault", ("short", 1, 0.0, True), ["all", "clear"]),
    ("set_disabled_channels", ([4],), ["4", "0-3"]),
    ("set_disabled_channels", ([2, 2],), ["2", "twice"]),
    ("explain_droplet", (5,), ["droplet 5", "[1]"]),
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
            call = f"{service} {arguments}"
            named_arguments = isinstance(arguments, dict)
            reply = getattr(self.chip, service)(*(() if named_arguments else arguments),
                                                **(arguments if named_arguments else {}))
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
        self.accepted(self.chip.dispense_droplet(9e-5, 0, 8e-14, 0, ""))
        self.accepted(self.chip.step(50))
        two = droplets.wait(lambda m: m.step == 50 and len(m.droplets) == 2).droplets
        new = max(two, key=lambda d: d.centroid.x)
        self.assertAlmostEqual(new.centroid.x, 9e-5, delta=1e-5)
        self.assertAlmostEqual(new.volume, 8e-14, delta=2e-14)
        self.assertEqual(list(new.parents), [])
        self.events.wait(lambda e: e.run == self.run_number and e.kind == Event.APPEARED and new.id in e.after)
        self.accepted(self.chip.remove(new.id, 0))
        self.accepted(self.chip.step(50))
        left = droplets.wait(lambda m: m.step == 100 and len(m.droplets) == 1).droplets
        self.assertNotEqual(left[0].id, new.id)
        droplets.stop()

    def add_ball(self, **more):
        return self.accepted(self.chip.add_microparticle(
            **{"x": 3e-5, "radius": 1e-5, "static_friction": 0.2, "kinetic_friction": 0.2, "rolling_friction": 0.1,
               **more})).microparticle

    def test_microparticles_come_and_go(self):
        listener = Listener("/chip/microparticles", MicroparticleArray)
        ball = self.add_ball()
        self.assertEqual(ball, 1)
        self.assertEqual(self.chip.get_state(False).state.microparticles, 1)
        occupied = self.chip.add_microparticle(x=3.5e-5, radius=1e-5)
        self.assertFalse(occupied.success)
        self.assertIn("microparticle 1", occupied.message)
        self.accepted(self.chip.step(50))
        seen = listener.wait(lambda m: m.step == 50 and m.microparticles).microparticles
        self.assertEqual([p.id for p in seen], [ball])
        self.assertAlmostEqual(seen[0].pose.position.x, 3e-5, delta=1e-6)
        self.assertAlmostEqual(seen[0].pose.position.z, 1e-5, delta=2e-7)
        self.assertEqual(seen[0].beads, 612)
        self.assertEqual(seen[0].droplet, 0)
        self.assertEqual(seen[0].place, Microparticle.DRY)
        self.assertGreater(seen[0].normal_force, 0, "the plate attracts it")
        layout = self.chip.get_layout().layout
        self.assertAlmostEqual(seen[0].mass, 612 * layout.mass_unit, delta=1e-15)
        self.accepted(self.chip.remove(0, ball))
        self.assertFalse(self.chip.remove(0, ball).success, "it is gone")
        listener.wait(lambda m: m.step == 50 and not m.microparticles)
        self.assertEqual(self.add_ball(), 2, "no id is given twice")
        listener.stop()

    def test_a_body_of_points_can_be_added(self):
        points = [Point(x, y, z) for x in (-5e-6, 0, 5e-6) for y in (-5e-6, 0, 5e-6) for z in (-5e-6, 0, 5e-6)]
        body = self.add_ball(points=points, mass=1e-10, height=1e-5)
        self.accepted(self.chip.step(10))
        self.accepted(self.chip.remove(0, body))

    def test_gravity_and_the_magnet_go_on_and_off(self):
        ball = self.add_ball(magnetic=True, height=3e-5)
        listener = Listener("/chip/microparticles", MicroparticleArray)
        too_strong = self.chip.set_body_forces(Vector3(), Vector3(1, 0, 0))
        self.assertFalse(too_strong.success)
        self.assertIn("magnetic", too_strong.message)
        self.accepted(self.chip.set_body_forces(Vector3(0, 0, -9.81), Vector3(1e-7, 0, 0)))
        state = self.chip.get_state(False).state
        self.assertAlmostEqual(state.gravity.z, -9.81, delta=1e-9)
        self.assertAlmostEqual(state.magnetic.x, 1e-7, delta=1e-16)
        self.accepted(self.chip.step(100))
        pushed = listener.wait(lambda m: m.step == 100).microparticles[0]
        layout = self.chip.get_layout().layout
        expected = 1e-7 / pushed.mass * 100 * layout.time_step_mdpd * layout.time_unit
        self.assertAlmostEqual(pushed.twist.linear.x / expected, 1, delta=0.02)
        self.accepted(self.chip.set_body_forces(Vector3(), Vector3()))
        self.assertEqual(self.chip.get_state(False).state.magnetic.x, 0)
        self.accepted(self.chip.step(100))
        free = listener.wait(lambda m: m.step == 200).microparticles[0]
        self.assertAlmostEqual(free.twist.linear.x, pushed.twist.linear.x, delta=0.01 * expected)
        self.assertEqual(free.id, ball)
        listener.stop()

    def test_commands_of_microparticles_re_simulate_the_run(self):
        self.add_ball(contact_angle_deg=109.0)
        self.accepted(self.chip.step(30))
        self.accepted(self.chip.set_body_forces(Vector3(0, 0, -1e4), Vector3()))
        self.accepted(self.chip.step(30))
        end = self.chip.hash()
        told = [self.commands.wait(lambda c, name=name: c.run == self.run_number and c.name == name)
                for name in ("add_microparticle", "set_body_forces")]
        self.assertEqual([c.step for c in told], [0, 30])
        said = json.loads(told[0].json)
        self.assertTrue(self.chip.reset().success)
        self.add_ball(contact_angle_deg=said["contact_angle"], x=said["x"])
        self.accepted(self.chip.step(30))
        gravity = json.loads(told[1].json)["gravity"]
        self.accepted(self.chip.set_body_forces(Vector3(*gravity), Vector3()))
        self.accepted(self.chip.step(30))
        self.assertEqual(self.chip.hash(), end)

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
