#!/usr/bin/python3
"""Drives the first droplet of a chip over a row of electrodes, as a controller of a real board would.

Only services command the chip: the rail is switched on, then one channel after another, each when ~droplets shows
that the droplet has arrived on the one before.

Parameters (private): chip (name of the chip node, default /chip), electrodes (how many to cross, 3), voltage (V rms,
0: the reference voltage of the layout), frequency (Hz, 1000), timeout (s of wall time for the whole run, 240).
Exits with 1 and one line when a service refuses, the droplet does not arrive or the chip falls silent.
"""
import math
import sys
import threading
import time

import rospy

from dmf_sim.msg import DropletArray
from dmf_sim.srv import GetLayout, SetElectrodes, SetHv

SERVICE_TIMEOUT = 60  # s, the chip builds its beads first
SILENCE = 20          # s without a word from the chip
SETTLE = (20, 60)     # tau: a droplet settles for so long, and longer, up to so long, if its angle is not measured yet
ARRIVED = 0.25        # of a pad's width: how near to its centre the droplet has to come


class Failure(Exception):
    """The run can't go on; the text is for people."""


class Progress:
    """One line that is written over on a terminal, and now and then a line elsewhere."""

    def __init__(self):
        self._terminal = sys.stdout.isatty()
        self._last = -math.inf

    def show(self, text, force=False):
        if force or time.monotonic() - self._last > (0.2 if self._terminal else 10):
            self._last = time.monotonic()
            print("\r\033[K" + text if self._terminal else text, end="" if self._terminal else "\n", flush=True)

    def end(self):
        if self._terminal:
            print(flush=True)


class Controller:
    """What a controller keeps: proxies of the chip's services and the last that it heard of the droplets."""

    def __init__(self):
        chip = rospy.get_param("~chip", "/chip")
        self._deadline = time.monotonic() + rospy.get_param("~timeout", 240)
        self._changed = threading.Condition()
        self._droplets = None
        rospy.on_shutdown(self._wake)
        self._subscriber = rospy.Subscriber(chip + "/droplets", DropletArray, self._on_droplets, queue_size=1)
        self.get_layout = self._proxy(chip + "/get_layout", GetLayout)
        self.set_hv = self._proxy(chip + "/set_hv", SetHv)
        self.set_electrodes = self._proxy(chip + "/set_electrodes", SetElectrodes)

    @staticmethod
    def _proxy(name, kind):
        until = time.monotonic() + SERVICE_TIMEOUT
        while not rospy.is_shutdown():
            try:
                rospy.wait_for_service(name, 1)
                break
            except rospy.ROSException:
                if time.monotonic() > until:
                    raise Failure(f"no service {name} after {SERVICE_TIMEOUT} s") from None
        else:
            raise Failure("stopped")
        proxy = rospy.ServiceProxy(name, kind)

        def call(*arguments):
            reply = proxy(*arguments)
            if not reply.success:
                raise Failure(f"{name} refused: {reply.message}")
            return reply

        return call

    def _wake(self):
        with self._changed:
            self._changed.notify_all()

    def _on_droplets(self, message):
        with self._changed:
            self._droplets = message
            self._changed.notify_all()

    def watch(self, goal):
        """Calls goal(droplets) on each new message of ~droplets until it returns something; returns that."""
        while True:
            with self._changed:
                self._droplets = None
                heard = self._changed.wait_for(lambda: self._droplets is not None or rospy.is_shutdown(),
                                               timeout=SILENCE)
                message = self._droplets
            if rospy.is_shutdown():
                raise Failure("stopped")
            if not heard:
                raise Failure(f"nothing on ~droplets for {SILENCE} s")
            result = goal(message)
            if result is not None:
                return result
            if time.monotonic() > self._deadline:
                raise Failure("out of time (parameter ~timeout)")


def width(electrode):
    """Extent of a pad along x, m."""
    xs = [corner.x for corner in electrode.outline]
    return max(xs) - min(xs)


def route(layout, start, count):
    """The electrode nearest to `start` and then `count` neighbours in a row, towards +x or, where there are too few,
    towards -x."""
    electrodes = {electrode.channel: electrode for electrode in layout.electrodes}
    first = min(electrodes.values(),
                key=lambda e: math.hypot(e.centroid.x - start.x, e.centroid.y - start.y))
    best = []
    for sign in (1, -1):
        path = [first]
        while len(path) <= count:
            here = path[-1]
            ahead = [electrodes[channel] for channel in here.neighbours]
            # In a row: straight on rather than diagonally.
            ahead = [e for e in ahead
                     if sign * (e.centroid.x - here.centroid.x) > 2 * abs(e.centroid.y - here.centroid.y)]
            if not ahead:
                break
            path.append(min(ahead, key=lambda e: abs(e.centroid.y - here.centroid.y)))
        if len(path) > len(best):
            best = path
    if len(best) <= count:
        raise Failure(f"there are only {len(best) - 1} electrodes in a row from channel {first.channel}, "
                      f"{count} are to be crossed")
    return best


def settled_droplet(layout):
    """Goal for watch(): the droplet with the lowest id once it wets the plate and has had time to settle."""
    begin = []

    def goal(message):
        begin[:] = begin or [message.time]
        waited = (message.time - begin[0]) / layout.time_unit
        for droplet in message.droplets:
            needed = SETTLE[1] if math.isnan(droplet.contact_angle_deg) else SETTLE[0]
            if droplet.footprint_area > 0 and waited >= needed:
                return droplet
        return None

    return goal


def drive(controller, progress):
    layout = controller.get_layout().layout
    count = rospy.get_param("~electrodes", 3)
    voltage = rospy.get_param("~voltage", 0.0) or layout.reference_voltage
    frequency = rospy.get_param("~frequency", 1000.0)

    progress.show("waiting for the droplet to settle", force=True)
    droplet = controller.watch(settled_droplet(layout))
    path = route(layout, droplet.centroid, count)
    goal = path[-1]
    start_x, whole = droplet.centroid.x, goal.centroid.x - droplet.centroid.x
    controller.set_hv(voltage, frequency, True)
    began = time.monotonic()

    for number, electrode in enumerate(path[1:], 1):
        controller.set_electrodes([electrode.channel])

        def arrived(message, electrode=electrode, number=number):
            here = next((d for d in message.droplets if d.id == droplet.id), None)
            if here is None:
                raise Failure(f"droplet {droplet.id} is gone")
            done = min(max((here.centroid.x - start_x) / whole, 0.0), 1.0)
            elapsed = time.monotonic() - began
            left = f"{elapsed * (1 - done) / done:4.0f} s left" if done > 0.02 else "     "
            progress.show(f"electrode {electrode.channel} ({number} of {count}) on, droplet {droplet.id} at "
                          f"x = {here.centroid.x * 1e3:+.3f} mm, {100 * done:3.0f} %, {left}")
            near = abs(here.centroid.x - electrode.centroid.x) < ARRIVED * width(electrode)
            return here if near else None

        controller.watch(arrived)
    elapsed = time.monotonic() - began
    progress.show(f"droplet {droplet.id} crossed {count} electrodes in {elapsed:.0f} s of wall time", force=True)
    controller.set_electrodes([])
    controller.set_hv(0, 0, False)


def main():
    rospy.init_node("demo_controller")
    progress = Progress()
    try:
        drive(Controller(), progress)
    except (Failure, rospy.ServiceException) as failure:
        progress.end()
        print(f"demo_controller: {failure}", file=sys.stderr)
        return 1
    progress.end()
    return 0


if __name__ == "__main__":
    sys.exit(main())
