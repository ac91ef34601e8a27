#!/usr/bin/python3
"""What goes on around the chip does not end its run: a master that is killed, a disk that is full, a second clock."""
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from dmf_sim.msg import ChipState, Event, RunRecord
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import PATIENCE, Chip, Listener  # noqa: E402
from processes import ROOT, Process, chip, executable, resimulate, wait_until_recorded  # noqa: E402

# A small disk that only the command in it sees; its files are handed over before it is gone.
ON_SMALL_DISK = """
mkdir -p "$1/disk" && mount -t tmpfs -o size=700k tmpfs "$1/disk" || exit 77
folder="$1"
shift
"$@"
status=$?
cp "$folder"/disk/* "$folder" 2>/dev/null
exit $status
"""


def own_mount_namespace(*command):
    return ["unshare", *([] if os.geteuid() == 0 else ["--map-root-user"]), "--mount", "sh", "-c", ON_SMALL_DISK, "sh",
            *command]


class Master:
    """A master of this test's own, at the same place after every start."""

    def __init__(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.start()

    def start(self):
        self._process = Process("rosmaster", "--core", "-p", str(self.port))
        until = time.monotonic() + 20 * PATIENCE
        while not rosgraph.is_master_online(f"http://127.0.0.1:{self.port}"):
            if time.monotonic() > until:
                raise AssertionError("the master did not start")
            time.sleep(0.1)

    def kill(self):
        self._process.stop(signal.SIGKILL)

    def publishers(self):
        return {topic: nodes for topic, nodes in rosgraph.Master("/outage_test").getSystemState()[0]}


class OutageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.master = Master()
        os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{cls.master.port}"
        rospy.init_node("outage_test")

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="dmf_sim_outage_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.node = self.start_chip()

    def start_chip(self):
        node = chip(f"{ROOT}/test/scenes/tiny_line.yaml", self.folder, "_max_steps_per_second:=500", "_hash_interval:=50")
        self.addCleanup(node.stop)
        return node

    def test_a_full_disk_ends_the_recording_and_not_the_run(self):
        if subprocess.run(own_mount_namespace(self.folder, "true"), stderr=subprocess.DEVNULL, check=False).returncode:
            print("NOT TESTED: a full disk. It takes a mount namespace, which this machine does not allow.",
                  file=sys.stderr, flush=True)
            self.skipTest("no mount namespace")
        bag = os.path.join(self.folder, "disk", "full.bag")
        # The recorder itself stops when less than --min-space is left, a gigabyte by default. Here it must not.
        record = Process(*own_mount_namespace(self.folder, executable("rosbag", "record"), "--all", "--exclude", "/clock",
                                              "--lz4", "--chunksize", "32", "--min-space", "1k", "-O", bag))
        client = Chip()
        wait_until_recorded(client)
        record.wait(60)
        states = Listener("/chip/state", ChipState)
        seen = states.wait()
        after = states.wait(lambda state: state.step > seen.step + 50)
        self.assertEqual(after.fault, "")
        left = os.path.join(self.folder, "full.bag.active")
        self.assertGreater(os.path.getsize(left), 600_000, "it was the disk that ended the recording")
        self.node.stop()
        subprocess.run(["rosbag", "reindex", "-f", left], check=True, stdout=subprocess.DEVNULL, timeout=60)
        status, text = resimulate(left, "--threads", "1")
        self.assertEqual(status, 0, text)
        self.assertRegex(text, r"run 0: (\d+) of \1 hashes equal, the run is reproduced")

    def test_a_second_clock_is_reported_while_it_runs(self):
        Chip()
        events = Listener("/chip/events", Event)
        diagnostics = Listener("/diagnostics", DiagnosticArray)

        def clock(report):
            return next(status for status in report.status if status.name == "chip: clock")
        diagnostics.wait(lambda report: clock(report).level == DiagnosticStatus.OK)
        other = rospy.Publisher("/clock", Clock, queue_size=1)  # as `rosbag play --clock` beside the chip
        over = threading.Event()

        def publish():
            while not over.wait(0.05):
                other.publish(Clock(rospy.Time(3)))
        publishing = threading.Thread(target=publish)
        publishing.start()
        try:
            told = events.wait(lambda event: event.kind == Event.CLOCK_CONFLICT)
            self.assertIn(rospy.get_name(), told.message)
            wrong = clock(diagnostics.wait(lambda report: clock(report).level == DiagnosticStatus.ERROR))
            self.assertIn(rospy.get_name(), wrong.message)
        finally:
            over.set()
            publishing.join()
            other.unregister()
        seen = len(diagnostics.messages)
        diagnostics.wait(lambda report: diagnostics.messages.index(report) >= seen
                         and clock(report).level == DiagnosticStatus.OK)
        self.assertEqual(len([e for e in events.messages if e.kind == Event.CLOCK_CONFLICT]), 1, "told once")

    def test_the_run_outlives_its_master_and_those_who_know_it_stay_connected(self):
        client = Chip()
        # Connections that last, once they are made.
        self.assertTrue(client.set_hv(10, 1000, True).success)
        self.assertTrue(client.save_checkpoint("early").success)
        client.get_state(False)
        states, records = Listener("/chip/state", ChipState), Listener("/chip/run_record", RunRecord)
        states.wait()
        records.wait()
        self.master.kill()
        seen = states.wait(lambda state: state.step > 0 and state is states.messages[-1])
        states.wait(lambda state: state.step > seen.step + 200)
        self.assertTrue(client.set_hv(63, 1000, True).success)
        given = client.get_state(True).state
        records.wait(lambda record: record.hashes[-1].step > given.step and record.hashes[-1].commands == 2)
        self.assertTrue(client.save_checkpoint("outage").success)

        # A new master is not told of what runs already: new subscribers and callers do not find the chip.
        self.master.start()
        seen = states.messages[-1]
        states.wait(lambda state: state.step > seen.step + 500)
        self.assertNotIn("/chip/state", self.master.publishers())
        # Started again, it is found, and goes on from the checkpoint.
        self.assertEqual(self.node.stop(), 0, "ended as it was asked to")
        self.start_chip()
        again = Chip()
        self.assertIn("/chip/state", self.master.publishers())
        again.pause_physics()
        self.assertTrue(again.load_checkpoint("outage").success)
        self.assertTrue(again.get_state(False).state.hv_enabled)


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "outage_test", OutageTest)
