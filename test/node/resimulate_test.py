#!/usr/bin/python3
"""A bag is a complete record: it is computed again bit for bit from nothing else, and what is missing or altered in it is found."""
import atexit
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from dmf_sim.msg import ChipState

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import PATIENCE, Chip, Listener  # noqa: E402
from processes import ROOT, chip, recorder, resimulate, wait_until_recorded, wait_until_written  # noqa: E402

RC = 1e-5  # m, one r_c of the test's scene


def accept(reply):
    if not reply.success:
        raise AssertionError(reply.message)
    return reply


def command_everything(client):
    """Every command that there is, some steps after each; three runs: from the start, after a reset, from a checkpoint."""
    client.step(130)
    accept(client.set_hv(63, 1000, True))
    accept(client.set_electrodes([1]))
    client.step(120)
    accept(client.load_pattern("blink"))
    client.step(30)
    accept(client.set_electrode_voltages([2], [31.4159]))
    client.step(30)
    accept(client.set_wettability([-3 * RC, 7 * RC], [120, 77.7]))
    client.step(30)
    accept(client.dispense_droplet(x=9 * RC, y=0.1 * RC, volume=4.2 * 8 * RC**3))
    client.step(30)
    body = accept(client.add_microparticle(x=2 * RC, y=-4 * RC, radius=RC, contact_angle_deg=101, magnetic=True))
    client.step(30)
    forces = client.set_body_forces.request_class()
    forces.gravity.x, forces.magnetic.y = 40, 1e-9
    accept(client.set_body_forces(forces))
    client.step(30)
    accept(client.inject_fault(kind="weak", channel=1, strength=0.7))
    accept(client.inject_fault(kind="short", channel=3))
    client.step(30)
    accept(client.set_disabled_channels([3]))
    accept(client.set_electrodes([1, 2]))
    client.step(30)
    accept(client.halt())
    client.step(30)
    accept(client.set_hv(50, 0, True))
    accept(client.save_checkpoint("middle"))
    client.step(70)
    accept(client.remove(0, body.microparticle))
    client.step(60)
    accept(client.reset())
    accept(client.set_hv(63, 1000, True))
    client.step(40)
    accept(client.set_electrodes([1]))
    client.step(110)
    accept(client.load_checkpoint("middle"))
    client.step(55)
    accept(client.remove(0, body.microparticle))
    accept(client.set_electrodes([0]))
    client.step(115)  # to a step with a hash, the last in the record


class ResimulateTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("resimulate_test")
        cls.folder = tempfile.mkdtemp(prefix="dmf_sim_resimulate_")
        atexit.register(shutil.rmtree, cls.folder)
        cls.bag = os.path.join(cls.folder, "run.bag")
        scene = os.path.join(cls.folder, "own.yaml")
        shutil.copy(f"{ROOT}/test/scenes/tiny_line.yaml", scene)
        node = chip(scene, cls.folder, "_paused:=true", "_hash_interval:=50")
        client = Chip()
        client.step(10)  # the recorder comes late
        record = recorder(cls.bag)
        wait_until_recorded(client)
        command_everything(client)
        wait_until_written(cls.bag, client.hash())
        record.stop()
        node.stop()
        os.remove(scene)
        cls.commands, cls.hashes = {}, {}
        with rosbag.Bag(cls.bag) as bag:
            for _, message, _ in bag.read_messages(["/chip/run_record"]):
                cls.commands.update({(message.run, c.index): c for c in message.commands})
                cls.hashes.update({(message.run, h.index): h for h in message.hashes})

    def rewritten(self, change):
        """A copy of the bag, each message as `change(topic, message)` returns it; None leaves it out."""
        path = os.path.join(self.folder, f"{self._testMethodName}.bag")
        with rosbag.Bag(self.bag) as old, rosbag.Bag(path, "w") as new:
            for topic, message, stamp in old.read_messages():
                message = change(topic, message)
                if message is not None:
                    new.write(topic, message, stamp)
        return path

    def with_commands(self, change, topics=("/chip/commands", "/chip/run_record")):
        """A copy of the bag in which `change` of a list of commands stands for each such list."""
        def change_message(topic, message):
            if topic not in topics:
                return message
            if topic == "/chip/run_record":
                message.commands = change(message.commands)
                return message
            kept = change([message])
            return kept[0] if kept else None
        return self.rewritten(change_message)

    def first_hash_after(self, run, index):
        """Step of the first hash that counts a command."""
        return min(h.step for (r, _), h in self.hashes.items() if r == run and h.commands > index)

    def index_of(self, run, name):
        return min(i for (r, i), c in self.commands.items() if r == run and c.name == name)

    def test_every_run_is_computed_again_whatever_the_threads_and_the_kernel(self):
        named = {c.name for c in self.commands.values()}
        self.assertEqual(len(named), 13, f"every command there is, and not {sorted(named)}")
        help_text = resimulate("--help")[1]
        kernels = [k for k in ("auto", "avx2", "sse4", "scalar") if k in help_text]
        for options in (["--threads", "1"], ["--threads", "2"], ["--threads", "1", "--kernel", kernels[-1]]):
            status, text = resimulate(self.bag, *options)
            self.assertEqual(status, 0, text)
            self.assertEqual(len(re.findall(r"^run [012]: (\d+) of \1 hashes equal, the run is reproduced$", text,
                                            re.M)), 3, text)
        compared = sum(int(n) for n in re.findall(r"(\d+) of", text))
        self.assertEqual(compared, len(self.hashes))

    def test_the_report_says_what_there_is(self):
        status, text = resimulate(self.bag, "--commands")
        self.assertEqual(status, 0, text)
        for expected in ("own, fingerprint", "scene .*own.yaml", "calibration .*water_like.yaml", "seed: +7",
                         r"version: +\d", "reset 1", "set_wettability 1", r'"voltages":\[31.4159\]', "middle",
                         r"fault_injected 2"):
            self.assertRegex(text, expected)
        self.assertEqual(len(re.findall("^complete:", text, re.M)), 3, text)
        last = max((h for (run, _), h in self.hashes.items() if run == 2), key=lambda h: h.index)
        self.assertIn(f"hash {last.hash}, chain {last.chain}", text)

    def test_it_begins_at_a_checkpoint_and_ends_where_it_is_told(self):
        saved = self.first_checkpoint("middle")
        status, text = resimulate(self.bag, "--run", "0", "--from", str(saved + 10), "--until", str(saved + 60))
        self.assertEqual(status, 0, text)
        self.assertRegex(text, rf"steps {saved} to {saved // 50 * 50 + 50} ")
        status, text = resimulate(self.bag, "--run", "1", "--from", "1 s")
        self.assertEqual(status, 1)
        self.assertIn("allowed: within 0 to", text)

    def first_checkpoint(self, name):
        with rosbag.Bag(self.bag) as bag:
            return next(m.step for _, m, _ in bag.read_messages(["/chip/checkpoint"]) if m.name == name)

    def test_an_altered_command_is_found_at_the_next_hash(self):
        index = self.index_of(0, "set_electrodes")

        def alter(commands):
            for command in commands:
                if (command.run, command.index) == (0, index):
                    command.json = command.json.replace("[1]", "[2]")
            return commands
        status, text = resimulate(self.with_commands(alter), "--run", "0")
        self.assertEqual(status, 1, text)
        step = self.first_hash_after(0, index)
        self.assertIn(f"differs first at step {step}, equal up to step", text)
        self.assertIn("the hash chain does not hold", text)
        self.assertEqual(resimulate(self.with_commands(alter), "--info")[0], 1)
        saved = self.first_checkpoint("middle")
        status, text = resimulate(self.with_commands(alter), "--run", "0", "--from", str(saved))
        self.assertEqual(status, 1, text)
        self.assertIn(f'"channels":[1]}} at step {self.commands[0, index].step} in the checkpoint of step {saved}', text)

    def test_a_command_that_is_told_in_two_ways_is_found(self):
        def alter(commands):
            for command in commands:
                command.json = command.json.replace("31.4159", "31.4158")
            return commands
        status, text = resimulate(self.with_commands(alter, ["/chip/commands"]), "--run", "0")
        self.assertEqual(status, 1, text)
        self.assertRegex(text, r'altered: command \d+ is .*31\.4159.* and .*31\.4158')

    def test_an_altered_command_without_effect_is_found_by_the_chain(self):
        index = self.index_of(0, "set_hv")

        def alter(commands):
            for command in commands:  # the scene has no cutoff_frequency: angles do not know the frequency
                if (command.run, command.index) == (0, index):
                    command.json = command.json.replace("1000.0", "1001.0")
            return commands
        status, text = resimulate(self.with_commands(alter), "--run", "0")
        self.assertEqual(status, 1, text)
        self.assertRegex(text, r"(\d+) of \1 hashes equal, but the record was altered: the hash chain differs first at "
                               f"step {self.first_hash_after(0, index)}")

    def test_a_missing_command_is_found(self):
        index = self.index_of(0, "set_wettability")
        bag = self.with_commands(lambda commands: [c for c in commands if (c.run, c.index) != (0, index)])
        status, text = resimulate(bag, "--run", "0")
        self.assertEqual(status, 1, text)
        self.assertIn(f"commands {index} are missing", text)

    def test_an_altered_scene_is_found(self):
        def alter(topic, message):
            if topic == "/chip/scene":
                message.files[0].text = message.files[0].text.replace("radius: 3}", "radius: 3.2}")
            return message
        status, text = resimulate(self.rewritten(alter), "--run", "0")
        self.assertEqual(status, 1, text)
        self.assertIn("altered: the texts of the scene", text)
        self.assertIn("differs first at step 0", text)
        saved = self.first_checkpoint("middle")  # from where the alteration has no effect any more
        status, text = resimulate(self.rewritten(alter), "--run", "0", "--from", str(saved))
        self.assertEqual(status, 1, text)
        self.assertIn("altered: the texts of the scene", text)

    def test_an_altered_hash_is_found(self):
        def alter(topic, message):
            if topic == "/chip/run_record" and message.run == 1:
                for entry in message.hashes:
                    if entry.step == 100:
                        entry.hash = "0123456789abcdef"
            return message
        status, text = resimulate(self.rewritten(alter), "--run", "1")
        self.assertEqual(status, 1, text)
        self.assertRegex(text, r"differs first at step 100, equal up to step 50: [0-9a-f]{16} in place of 0123456789abcdef")

    def test_what_is_no_record_is_refused_with_the_reason(self):
        cut = os.path.join(self.folder, "cut.bag")
        with open(self.bag, "rb") as old, open(cut, "wb") as new:
            new.write(old.read(os.path.getsize(self.bag) * 2 // 3))
        empty = os.path.join(self.folder, "empty.bag")
        rosbag.Bag(empty, "w").close()
        text = os.path.join(self.folder, "text.bag")
        with open(text, "w") as file:
            file.write("no bag")
        no_scene = self.rewritten(lambda topic, message: None if topic == "/chip/scene" else message)
        for bag, reason in ((cut, "rosbag reindex"), (text, "text.bag"), (empty, "holds nothing on"),
                            ("/nonexistent.bag", "/nonexistent.bag"),
                            (no_scene, "lacks the scene")):
            status, said = resimulate(bag)
            self.assertEqual(status, 1, said)
            self.assertIn(reason, said)
            self.assertRegex(said, "(?m)^resimulate: ")
        status, said = resimulate(self.bag, "--chip", "/other")
        self.assertEqual((status, "holds nothing on /other/scene" in said), (1, True), said)

    def test_what_a_killed_recorder_has_written_is_a_record_too(self):
        bag = os.path.join(self.folder, "killed.bag")
        node = chip(f"{ROOT}/test/scenes/tiny_line.yaml", self.folder, "_max_steps_per_second:=600",
                    "_paused:=false")
        record = recorder(bag, "--chunksize", "32")
        client = Chip()
        wait_until_recorded(client)
        accept(client.set_hv(63, 1000, True))
        accept(client.set_electrodes([1]))
        until = time.monotonic() + 60 * PATIENCE
        flushed = os.path.getsize(bag + ".active")
        while os.path.getsize(bag + ".active") < flushed + 300_000:
            self.assertLess(time.monotonic(), until, "the recorder wrote nothing")
            time.sleep(0.1)
        record.stop(signal.SIGKILL)
        states = Listener("/chip/state", ChipState)
        seen = states.wait().step
        states.wait(lambda state: state.step > seen)  # the run goes on
        node.stop()
        status, text = resimulate(bag + ".active")
        self.assertEqual((status, "rosbag reindex" in text), (1, True), text)
        subprocess.run(["rosbag", "reindex", "-f", bag + ".active"], check=True, stdout=subprocess.DEVNULL, timeout=60)
        status, text = resimulate(bag + ".active", "--threads", "1")
        self.assertEqual(status, 0, text)
        self.assertRegex(text, r"run \d+: (\d+) of \1 hashes equal, the run is reproduced")


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "resimulate_test", ResimulateTest)
