#!/usr/bin/python3
"""A chip whose process is killed, asked to end, or has no disk to write to: the run is where it was."""
import glob
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xmlrpc.client

import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from actionlib import GoalStatus
from dmf_sim.msg import Command, DropletArray, Event, MoveDropletAction, MoveDropletGoal, SensedDropletArray
from rosgraph_msgs.msg import Clock

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import PATIENCE, Chip, Listener  # noqa: E402
from controller_client import Client  # noqa: E402

SCENES = os.path.join(os.path.dirname(os.path.realpath(__file__)), "../scenes")
SCENE = os.path.join(SCENES, "tiny_line.yaml")


def pid_of(node="/chip", other_than=None, timeout=30):
    """Process of a node that answers."""
    master = rosgraph.Master(rospy.get_name())
    until = time.monotonic() + timeout * PATIENCE
    while time.monotonic() < until:
        try:
            pid = xmlrpc.client.ServerProxy(master.lookupNode(node)).getPid(rospy.get_name())[2]
            if pid != other_than:
                return pid
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            pass
        time.sleep(0.05)
    raise AssertionError(f"{node} did not come back in {timeout} s")


def saved_step(event):
    """What step an automatic checkpoint is of, -1 for other events: it is told when it is written, some steps later."""
    automatic = re.match(r"automatic: step (\d+) ", event.message)
    return int(automatic.group(1)) if automatic and event.kind == Event.CHECKPOINT_SAVED else -1


class RespawnTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("respawn_test", disable_rostime=True)

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="dmf_respawn_")
        self.started = []

    def tearDown(self):
        for process in self.started:
            self.end(process)
        shutil.rmtree(self.folder)

    def launch(self, *arguments):
        """chip.launch as people start it."""
        with open(os.path.join(self.folder, "told.log"), "a", encoding="utf-8") as told:
            process = subprocess.Popen(["roslaunch", "dmf_sim", "chip.launch", f"scene:={SCENE}", "threads:=1",
                                        "paused:=true", f"checkpoint_dir:={self.folder}", *arguments],
                                       stdout=told, stderr=told)
        self.started.append(process)
        return process

    def end(self, process):
        """As Ctrl-C does, and waits until it has ended."""
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
            process.wait(30 * PATIENCE)

    def chip(self, other_than=None):
        pid = pid_of(other_than=other_than)
        return Chip(), pid

    def command(self, chip):
        self.assertTrue(chip.set_hv(63, 1000, True).success)
        self.assertTrue(chip.set_electrodes([1]).success)

    def reference(self, chip, step):
        """Hash of the run that was never interrupted, at a step."""
        self.assertTrue(chip.reset().success)
        self.command(chip)
        self.assertTrue(chip.step(step).success)
        return chip.hash()

    def automatic(self):
        return sorted(glob.glob(os.path.join(self.folder, "auto.chip.tiny_line.*")))

    def told(self):
        """What the launches of this test printed."""
        with open(os.path.join(self.folder, "told.log"), encoding="utf-8") as told:
            return told.read()

    def test_a_killed_chip_comes_back_where_it_was(self):
        clock, events = Listener("/clock", Clock), Listener("/chip/events", Event)
        commands = Listener("/chip/commands", Command)
        self.launch("respawn:=true", "checkpoint_period:=0.2")
        chip, pid = self.chip()
        self.command(chip)
        self.assertTrue(chip.step(200).success)
        events.wait(lambda e: saved_step(e) == 200)
        before = chip.get_state(True).state

        os.kill(pid, signal.SIGKILL)
        chip, pid = self.chip(other_than=pid)
        after = chip.get_state(True).state
        self.assertEqual((after.step, after.state_hash, after.paused), (200, before.state_hash, True))
        self.assertEqual(after.run, before.run + 1)
        self.assertEqual(after.hv_voltage, 63)
        # What was commanded is told anew, under the new run number.
        told = [commands.wait(lambda m, i=i: m.run == after.run and m.index == i) for i in range(2)]
        self.assertEqual([c.name for c in told], ["set_hv", "set_electrodes"])
        self.assertTrue(chip.step(100).success)
        on = chip.hash()

        # Killed while it runs, it runs again.
        chip.unpause_physics()
        saved = events.wait(lambda e: e.run == after.run and saved_step(e) > 300)
        os.kill(pid, signal.SIGKILL)
        chip, pid = self.chip(other_than=pid)
        self.assertFalse(chip.get_state(False).state.paused)
        chip.pause_physics()
        last = chip.get_state(True).state
        self.assertGreaterEqual(last.step, saved_step(saved))
        self.assertEqual(last.run, before.run + 2)

        self.assertEqual(self.reference(chip, 300), on)
        self.assertTrue(chip.step(last.step - 300).success)
        self.assertEqual(chip.hash(), last.state_hash)
        times = [m.clock.to_nsec() for m in clock.messages]
        self.assertEqual(times, sorted(times), "/clock stepped back")
        # A fourth one stands there while it is written and until the oldest is removed.
        deadline = time.monotonic() + 10 * PATIENCE
        while len(self.automatic()) > 3 and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertLessEqual(len(self.automatic()), 3)

    def test_a_kill_undoes_no_reset_and_turns_no_clock_back(self):
        events = Listener("/chip/events", Event)
        self.launch("respawn:=true", "checkpoint_period:=1000")
        chip, pid = self.chip()
        self.assertTrue(chip.step(50).success)
        self.assertTrue(chip.reset().success)
        events.wait(lambda e: saved_step(e) == 0)
        # These steps are lost, but the time that was told meanwhile does not come back.
        self.assertTrue(chip.step(100).success)
        last = chip.get_state(False).state
        clock = Listener("/clock", Clock)
        clock.wait(lambda m: m.clock >= last.header.stamp)
        clock.stop()
        os.kill(pid, signal.SIGKILL)
        chip, pid = self.chip(other_than=pid)
        state = chip.get_state(False).state
        self.assertEqual((state.step, state.run), (0, last.run + 1))
        clock = Listener("/clock", Clock)
        self.assertGreater(clock.wait().clock, last.header.stamp)
        clock.stop()

    def test_asked_to_end_it_saves_and_a_later_launch_may_resume(self):
        launch = self.launch("respawn:=true", "checkpoint_period:=1000")
        chip, pid = self.chip()
        self.command(chip)
        self.assertTrue(chip.step(70).success)
        saved = chip.hash()
        os.kill(pid, signal.SIGTERM)
        chip, pid = self.chip(other_than=pid)
        self.assertEqual((chip.get_state(False).state.step, chip.hash()), (70, saved))
        self.assertTrue(chip.step(30).success)
        later = chip.hash()
        self.end(launch)
        self.assertEqual(len(self.automatic()), 2)

        # A new launch begins anew, unless it is told to resume.
        launch = self.launch()
        self.assertEqual(self.chip()[0].get_state(False).state.step, 0)
        self.end(launch)
        launch = self.launch("resume:=true")
        self.assertEqual(self.chip()[0].get_state(False).state.step, 100)
        self.assertEqual(Chip().hash(), later)
        self.end(launch)
        # What is damaged is passed over; another seed is another run.
        damaged = self.automatic()[1:]
        for path in damaged:
            os.truncate(path, 1000)
        launch = self.launch("resume:=true")
        self.assertEqual((self.chip()[0].get_state(False).state.step, Chip().hash()), (70, saved))
        for path in damaged:
            self.assertIn(f"{os.path.basename(path)}: passed over: ", self.told())
        self.end(launch)
        self.assertNotIn("starts from the scene", self.told())
        launch = self.launch("resume:=true", "seed:=8")
        self.assertEqual(self.chip()[0].get_state(False).state.step, 0)
        self.assertIn("starts from the scene", self.told())

    def test_a_name_of_the_automatic_ones_is_refused(self):
        self.launch()
        reply = self.chip()[0].save_checkpoint("auto.chip.tiny_line.000000000001")
        self.assertFalse(reply.success)
        self.assertIn("allowed", reply.message)

    def fails_and_recovers(self, full, free):
        """The run goes on while nothing can be written, says so once, and is saved again afterwards."""
        events, diagnostics = Listener("/chip/events", Event), Listener("/diagnostics", DiagnosticArray)

        def status(level):
            return lambda m: any(s.name == "chip: checkpoints" and s.level == level for s in m.status)

        full()
        chip, _ = self.chip()
        self.assertTrue(chip.step(20).success)
        failed = events.wait(lambda e: e.kind == Event.CHECKPOINT_FAILED)
        self.assertIn("the run goes on", failed.message)
        diagnostics.wait(status(DiagnosticStatus.ERROR))
        for _ in range(4):
            self.assertTrue(chip.step(20).success)
            time.sleep(0.3)  # not a condition: more attempts fail meanwhile
        self.assertEqual(sum(e.kind == Event.CHECKPOINT_FAILED for e in events.messages), 1)
        free()
        self.assertTrue(chip.step(20).success)
        events.wait(lambda e: saved_step(e) == 120)
        seen = len(diagnostics.messages)
        diagnostics.wait(lambda m: status(DiagnosticStatus.OK)(m) and m in diagnostics.messages[seen:])
        events.stop()
        diagnostics.stop()

    def test_a_move_of_the_controller_goes_on_when_its_chip_comes_back(self):
        clock = Listener("/clock", Clock)
        self.launch(f"scene:={SCENES}/controlled_line.yaml", "paused:=false", "respawn:=true", "checkpoint_period:=0.2")
        chip, pid = self.chip()
        rospy.set_param("/use_sim_time", True)
        self.started.append(subprocess.Popen(["rosrun", "dmf_sim", "chip_controller", "_step_timeout:=3"]))
        try:
            move = Client("move_droplet", MoveDropletAction)
            events = Listener("/chip/events", Event)
            sensed = Listener("/chip_controller/droplets", SensedDropletArray)
            sensed.wait(lambda m: 0 in [d.channel for d in m.droplets])
            handle = move.send(MoveDropletGoal(channel=0, target=3))
            half_way = time.monotonic() + 60 * PATIENCE
            while not any(f.progress > 0.4 for f in handle.feedback):
                self.assertLess(time.monotonic(), half_way, handle.feedback[-1:])
                time.sleep(0.01)
            # Half way it waits for its checkpoint: on a fast machine the move would be over first.
            chip.pause_physics()
            begun = chip.get_state(False).state
            events.wait(lambda e: saved_step(e) >= begun.step)
            killed_at = len(handle.feedback)
            chip.unpause_physics()
            os.kill(pid, signal.SIGKILL)
            chip, pid = self.chip(other_than=pid)
            chip.unpause_physics()
            move.wait(handle, 90)
            result = handle.get_result()
            self.assertEqual(handle.get_goal_status(), GoalStatus.SUCCEEDED, result.message)
            self.assertGreater(len(handle.feedback), killed_at, "it was over before the kill")
            # As the simulation sees it, after the kill.
            state = chip.get_state(False).state
            self.assertEqual(state.run, begun.run + 1)
            target = next(e for e in chip.get_layout().layout.electrodes if e.channel == 3)
            droplets = Listener("/chip/droplets", DropletArray)
            seen = droplets.wait(lambda m: m.droplets)
            droplets.stop()
            self.assertIn(3, [channel for d in seen.droplets for channel in d.channels])
            self.assertTrue(any(abs(d.centroid.x - target.centroid.x) < 3 * chip.get_layout().layout.length_unit
                                for d in seen.droplets))
            events.stop()
        finally:
            rospy.delete_param("/use_sim_time")
        times = [m.clock.to_nsec() for m in clock.messages]
        self.assertEqual(times, sorted(times), "/clock stepped back")

    def test_a_folder_that_cannot_be_written_stops_checkpoints_not_the_run(self):
        where = os.path.join(self.folder, "blocked")

        def full():
            with open(where, "w", encoding="utf-8") as file:
                file.write("no folder")
            self.launch("checkpoint_period:=0.1", f"checkpoint_dir:={where}/inside")

        def free():
            os.unlink(where)

        self.fails_and_recovers(full, free)
        self.assertTrue(glob.glob(where + "/inside/auto.chip.tiny_line.*"))

    def test_a_full_disk_stops_checkpoints_not_the_run(self):
        # A small file system that only the chip has; from here it is seen through the chip's process.
        where = os.path.join(self.folder, "small")
        os.mkdir(where)
        if subprocess.run(["unshare", "-rm", "mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", where],
                          capture_output=True, check=False).returncode != 0:
            self.skipTest("NO TMPFS CAN BE MOUNTED HERE: a full disk is not tested")
        inside = None

        def full():
            script = (f"mount -t tmpfs -o size=2m tmpfs {where} && head -c 2m /dev/zero > {where}/filler; "
                      f"exec rosrun dmf_sim chip _scene:={SCENE} _paused:=true _threads:=1 "
                      f"_checkpoint_period:=0.1 _checkpoint_dir:={where}")
            self.started.append(subprocess.Popen(["unshare", "-rm", "sh", "-c", script]))

        def free():
            nonlocal inside
            inside = f"/proc/{pid_of()}/root{where}"
            # Nothing half written is left of those that failed.
            self.assertEqual([name for name in os.listdir(inside) if name.endswith(".unfinished")], [])
            os.unlink(inside + "/filler")

        try:
            self.fails_and_recovers(full, free)
            self.assertTrue(glob.glob(inside + "/auto.chip.tiny_line.*"))
        finally:
            rospy.delete_param("/chip")


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "respawn_test", RespawnTest)
