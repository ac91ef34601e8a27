"""Chip, recorder and re-simulation as programs that a test starts and ends itself."""
import atexit
import os
import shutil
import signal
import subprocess
import time

from chip_client import PATIENCE

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", ".."))


class Process:
    """A program that ends with the test."""

    def __init__(self, *arguments):
        self._process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        atexit.register(self.stop)

    def stop(self, how=signal.SIGINT):
        if self._process.poll() is None:
            self._process.send_signal(how)
        return self.wait(40)

    def wait(self, timeout):
        """Its exit status."""
        return self._process.wait(timeout * PATIENCE)


def executable(package, name):
    """The program itself: signals for it must not end at rosrun."""
    path = subprocess.run(["catkin_find", "--first-only", "--libexec", package, name], capture_output=True, text=True,
                          check=True).stdout.strip()
    return path or shutil.which(name)


def chip(scene, folder, *arguments):
    return Process(executable("dmf_sim", "chip"), "__name:=chip", f"_scene:={scene}", "_threads:=1",
                   f"_checkpoint_dir:={folder}/checkpoints", *arguments)


def recorder(bag, *arguments):
    return Process(executable("rosbag", "record"), "--all", "--exclude", "/clock", "-O", bag, *arguments)


def wait_until_recorded(client):
    """The recorder listens to the chip."""
    until = time.monotonic() + 30 * PATIENCE
    while not client.record_checkpoint().success:
        if time.monotonic() > until:
            raise AssertionError("the recorder never listened")
        time.sleep(0.1)


def wait_until_written(bag, text):
    """The recorder has written a text into its bag: what is still on its way to a recorder that ends is lost."""
    until = time.monotonic() + 60 * PATIENCE
    while True:
        with open(bag + ".active", "rb") as file:
            if text.encode() in file.read():
                return
        if time.monotonic() > until:
            raise AssertionError(f"{text} was never recorded")
        time.sleep(0.1)


def resimulate(*arguments):
    """Exit status and text. There are no scenes, calibrations and boards for it but those of the bag."""
    done = subprocess.run(["rosrun", "dmf_sim", "resimulate", *arguments], capture_output=True, text=True, timeout=100,
                          check=False, env={**os.environ, "DMF_SIM_CONFIG": "/nonexistent"})
    return done.returncode, done.stdout + done.stderr
