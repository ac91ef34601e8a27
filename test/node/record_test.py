#!/usr/bin/python3
"""What chip.launch records is what was published, and replay.launch plays it back unchanged and with its clock."""
import atexit
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

import rosbag
import rospy
import rostest
from dmf_sim.msg import ChipState, Command, DropletArray
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import PATIENCE, Chip, Listener  # noqa: E402

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))
KINDS = {"/chip/state": ChipState, "/chip/droplets": DropletArray, "/chip/commands": Command}


class Launch:
    """A roslaunch that ends with the test."""

    def __init__(self, *arguments):
        self._process = subprocess.Popen(["roslaunch", "dmf_sim", *arguments], stdout=subprocess.DEVNULL)
        atexit.register(self.stop)  # also when the test is interrupted

    def wait(self, timeout):
        self._process.wait(timeout)

    def stop(self):
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait(40)


def serialized(message):
    """All of a message but its sequence number, which each publisher counts for itself."""
    message.header.seq = 0
    return repr(message)


class RecordTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="dmf_sim_record_")
        self.addCleanup(shutil.rmtree, self.folder)

    def test_a_bag_replays_as_it_was_published(self):
        rospy.init_node("record_test")
        bag = os.path.join(self.folder, "with a space.bag")
        live = {topic: Listener(topic, kind) for topic, kind in KINDS.items()}
        chip_launch = Launch("chip.launch", f"scene:={ROOT}/test/scenes/tiny_line.yaml", "record:=true",
                             f"bag:={bag}", "threads:=1", "max_steps_per_second:=500")
        self.addCleanup(chip_launch.stop)
        chip = Chip()
        until = time.monotonic() + 20 * PATIENCE
        while not os.path.exists(bag + ".active"):
            self.assertLess(time.monotonic(), until, "the recorder never started")
            time.sleep(0.1)
        self.assertTrue(chip.set_hv(63, 1000, True).success)
        self.assertTrue(chip.set_electrodes([1]).success)
        time.sleep(3)
        chip_launch.stop()

        recorded = self.read(bag)
        self.assertEqual([c.name for c in recorded["/chip/commands"]], ["set_hv", "set_electrodes"])
        for topic, messages in recorded.items():
            heard = {serialized(message) for message in live[topic].messages}
            # The recorder may have joined before or after this test: it must have heard nothing else.
            self.assertGreater(len(messages), 20 if topic != "/chip/commands" else 1)
            for message in messages:
                self.assertIn(serialized(message), heard, topic)
            live[topic].stop()
        stamps = [message.header.stamp for message in recorded["/chip/state"]]
        self.assertEqual(stamps, sorted(stamps))

        self.check_summary(bag)

        replayed = {topic: Listener(topic, kind) for topic, kind in KINDS.items()}
        clock = Listener("/clock", Clock)
        replay = Launch("replay.launch", f"bag:={bag}", "rviz:=false", "options:=--delay=2")
        self.addCleanup(replay.stop)
        replay.wait(60)
        for topic, messages in recorded.items():
            self.assertEqual([serialized(m) for m in replayed[topic].messages], [serialized(m) for m in messages],
                             topic)
        times = [message.clock for message in clock.messages]
        self.assertEqual(times, sorted(times))
        self.assertLessEqual(times[0], stamps[0] + rospy.Duration(0.1))
        self.assertGreaterEqual(times[-1], stamps[-1] - rospy.Duration(0.1))

    def check_summary(self, bag):
        picture = os.path.join(self.folder, "picture.png")
        said = subprocess.run(["rosrun", "dmf_sim", "summarize_run.py", bag, "--picture", picture],
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(said.returncode, 0, said.stderr)
        self.assertRegex(said.stdout, r"mean velocity: +[0-9.]+ mm/s, [0-9.]+ r_c/tau")
        self.assertIn("2 accepted: set_hv, set_electrodes", said.stdout)
        self.assertGreater(os.path.getsize(picture), 10000)
        broken = os.path.join(self.folder, "broken.bag")
        with open(broken, "w") as file:
            file.write("no bag")
        said = subprocess.run(["rosrun", "dmf_sim", "summarize_run.py", broken], capture_output=True, text=True,
                              timeout=60, check=False)
        self.assertEqual(said.returncode, 1)
        self.assertEqual(len(said.stderr.splitlines()), 1, said.stderr)

    @staticmethod
    def read(path):
        with rosbag.Bag(path) as bag:
            recorded = {topic: [] for topic in KINDS}
            for topic, message, _ in bag.read_messages(list(KINDS)):
                recorded[topic].append(message)
            return recorded


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "record_test", RecordTest)
