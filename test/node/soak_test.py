#!/usr/bin/python3
"""The node's memory stays flat under random commands for as long as ~seconds says.

A run keeps its history of commands, so that it can be simulated again: what it takes grows with every command until a
reset. The chip is therefore reset now and then, and memory is compared at the same place of every run, just after
the reset: what malloc says is in use, which grows when something is kept that nobody needs, and what is resident, which
also grows when freed memory lies in pieces. Neither may grow by more than malloc's caches explain. In half an hour and more a
line is fitted to each by least squares, and its slope has to be zero within what it scatters, or so small that a year would not
fill a machine.
"""
import math
import random
import sys
import os
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Vector3

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from chip_client import Chip, Listener, memory_of, pid_of  # noqa: E402

COMMANDS_A_RUN = 300
FLAT_IN_USE, FLAT_RESIDENT = 0.1, 1.0  # MB an hour
# MB that count as in use and are not: malloc keeps up to 7 blocks of each of 64 sizes, 0.23 MB, at hand for every thread, and
# threads come across the rarer sizes in the first quarter of an hour. Of some twenty threads two allocate much.
CACHES = 0.46


def slope_of(points):
    """Of a line through (x, y) by least squares, and its standard error."""
    n = len(points)
    mean_x, mean_y = sum(x for x, _ in points) / n, sum(y for _, y in points) / n
    spread = sum((x - mean_x) ** 2 for x, _ in points)
    slope = sum((x - mean_x) * (y - mean_y) for x, y in points) / spread
    residual = sum((y - mean_y - slope * (x - mean_x)) ** 2 for x, y in points)
    return slope, math.sqrt(residual / (n - 2) / spread)


def in_use():
    """What the node says it has in use of its heap right now, MB."""
    diagnostics = Listener("/diagnostics", DiagnosticArray)
    try:
        message = diagnostics.wait()
    finally:
        diagnostics.stop()
    memory, = [status for status in message.status if status.name == "chip: memory"]
    return float(next(value.value for value in memory.values if value.key == "in use (MB)"))


def report(what, points):
    """@returns slope and its error."""
    slope, error = slope_of(points)
    on_the_way = " ".join(f"{memory:.2f}" for _, memory in points[::max(1, len(points) // 20)])
    print(f"{what}: {points[0][1]:.2f} MB to {points[-1][1]:.2f} MB, slope {slope:.3f} +- {error:.3f} MB an hour; on the way {on_the_way}")
    return slope, error


class SoakTest(unittest.TestCase):
    def one_run(self, chip, rng):
        """Random commands of all kinds. @returns how many were taken."""
        taken = 0
        for _ in range(COMMANDS_A_RUN):
            command = rng.choice([
                lambda: chip.set_electrodes(rng.sample(range(4), rng.randrange(5))),
                lambda: chip.set_hv(rng.uniform(0, 80), rng.choice([0.0, 1e3]), rng.random() < 0.8),
                lambda: chip.set_electrode_voltages([rng.randrange(4)], [rng.uniform(0, 80)]),
                lambda: chip.set_wettability([0.0], [rng.uniform(60, 120)]),
                lambda: chip.load_pattern("blink"),
                lambda: chip.dispense_droplet(rng.uniform(-1e-4, 1e-4), rng.uniform(-5e-5, 5e-5), 3e-14, 0.0, ""),
                lambda: chip.add_microparticle(x=rng.uniform(-1e-4, 1e-4), y=rng.uniform(-5e-5, 5e-5), radius=1e-5),
                lambda: chip.remove(rng.randrange(1, 9), 0),
                lambda: chip.remove(0, rng.randrange(1, 9)),
                lambda: chip.set_body_forces(Vector3(rng.uniform(-1, 1), 0, -9.81), Vector3()),
                lambda: chip.inject_fault(rng.choice(["weak", "stuck_on", "stuck_off", "clear"]), rng.randrange(4), 0.5, False),
                lambda: chip.set_disabled_channels(rng.sample(range(4), rng.randrange(2))),
                lambda: chip.halt(), lambda: chip.detect_shorts(), lambda: chip.explain_droplet(1),
                lambda: chip.get_state(True)])
            taken += command().success
            rospy.rostime.wallsleep(0.01)
        return taken

    def test_memory_is_flat_under_random_commands(self):
        rospy.init_node("soak_test")
        seconds = rospy.get_param("~seconds", 60)
        chip, pid, rng = Chip(), pid_of("/chip"), random.Random(1)
        chip.unpause_physics()
        self.one_run(chip, rng)  # heaps, caches and queues have grown to what they need
        chip.reset()
        self.one_run(chip, rng)
        used, resident, within, taken = [], [], [], 0
        start = time.monotonic()
        while time.monotonic() - start < seconds or len(used) < 5:
            state = chip.get_state(False).state
            self.assertEqual(state.fault, "")
            before = memory_of(pid)
            taken += self.one_run(chip, rng)
            within.append(memory_of(pid) - before)
            self.assertTrue(chip.reset().success)
            hours = (time.monotonic() - start) / 3600
            used.append((hours, in_use()))
            resident.append((hours, memory_of(pid)))
        print(f"{seconds} s, {len(used)} runs, {taken} commands taken, peak {memory_of(pid, 'VmHWM'):.1f} MB; within a run "
              f"{sum(within) / taken * 1e3:.2f} kB a command")
        report("in use", used)
        used_slope, used_error = report("in use, second half", used[len(used) // 2:])
        resident_slope, resident_error = report("resident", resident)
        self.assertLess(used[-1][1] - used[0][1], CACHES)
        self.assertLess(resident[-1][1] - resident[0][1], 2)
        if seconds >= 1800:  # caches are full by then
            self.assertLess(used_slope, FLAT_IN_USE + 3 * used_error)
            self.assertLess(resident_slope, FLAT_RESIDENT + 3 * resident_error)


if __name__ == "__main__":
    rostest.rosrun("dmf_sim", "soak_test", SoakTest)
