#!/usr/bin/python3
"""Drives the first droplet of a chip over a row of electrodes, as a controller of a real board would. Where there is a
microparticle on the way, the droplet takes it up, carries it to a target electrode and leaves it there.

Only services command the chip. Alone, the droplet is called by one channel after another, each when ~droplets shows
that it has arrived on the one before. With a particle at its rear, a weaker rail and the two channels ahead of the
particle pull so gently that it stays in the droplet. At the target the rail goes up and all channels ahead of the
droplet's middle pull at its front alone, while everything behind repels: the droplet comes off the particle, which
friction holds.

Parameters (private): chip (name of the chip node, default /chip), electrodes (how many to cross, or to carry a particle
over, 3), target (channel where a particle is to be left, -1: so many electrodes after it), voltage (V rms, to drive a
droplet alone or away, 0: the reference voltage of the layout), carry_voltage (V rms, 0: 0.86 of voltage), frequency
(Hz, 1000), timeout (s of wall time for the whole run, 1200).
Exits with 1 and one line when a service refuses, the droplet or the particle does not arrive or the chip falls silent.
"""
import math
import sys
import threading
import time

import rospy

from dmf_sim.msg import DropletArray, MicroparticleArray
from dmf_sim.srv import GetLayout, SetElectrodes, SetHv

SERVICE_TIMEOUT = 60  # s, the chip builds its beads first
SILENCE = 20          # s without a word from the chip
SETTLE = (20, 60)     # tau: a droplet settles for so long, and longer, up to so long, if its angle is not measured yet
ARRIVED = 0.25        # of a pad's width: how near to its centre the droplet has to come
# Of the distance between two electrodes:
CALL = 0.5            # so far ahead of a droplet on its way to the particle
CARRY = 1.0           # so far ahead of a particle that is carried
STOP = 0.4            # so far short of the target a droplet starts to leave, as it still drags the particle on
LEAVE = 0.33          # so far ahead of the droplet's middle it is called then
CLEAR = 1.0           # so far from the particle is the droplet's rear in the end


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
    """What a controller keeps: proxies of the chip's services and the last that it heard of droplets and particles."""

    def __init__(self):
        chip = rospy.get_param("~chip", "/chip")
        self._deadline = time.monotonic() + rospy.get_param("~timeout", 1200)
        self._changed = threading.Condition()
        self._droplets = None
        self._particles = None
        rospy.on_shutdown(self._wake)
        self._subscriber = rospy.Subscriber(chip + "/droplets", DropletArray, self._on_droplets, queue_size=1)
        self._particle_subscriber = rospy.Subscriber(chip + "/microparticles", MicroparticleArray, self._on_particles,
                                                     queue_size=1)
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

    def _on_particles(self, message):
        with self._changed:
            self._particles = message

    def particle(self):
        """The particle with the lowest id as it was last heard of, None where there is none."""
        with self._changed:
            found = self._particles.microparticles if self._particles else []
        return found[0] if found else None

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


def find(message, droplet):
    """The droplet of an id among those of a message."""
    here = next((d for d in message.droplets if d.id == droplet), None)
    if here is None:
        raise Failure(f"droplet {droplet} is gone")
    return here


def cross(controller, progress, layout, droplet):
    """Over a row of electrodes, one after another."""
    count = rospy.get_param("~electrodes", 3)
    voltage = rospy.get_param("~voltage", 0.0) or layout.reference_voltage
    path = route(layout, droplet.centroid, count)
    start_x, whole = droplet.centroid.x, path[-1].centroid.x - droplet.centroid.x
    controller.set_hv(voltage, rospy.get_param("~frequency", 1000.0), True)
    began = time.monotonic()

    for number, electrode in enumerate(path[1:], 1):
        controller.set_electrodes([electrode.channel])

        def arrived(message, electrode=electrode, number=number):
            here = find(message, droplet.id)
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


class Row:
    """A row of electrodes towards +x, and which of them are on: never again one that was left behind."""

    def __init__(self, controller, layout, y):
        self._controller = controller
        self.electrodes = sorted((e for e in layout.electrodes
                                  if min(c.y for c in e.outline) <= y <= max(c.y for c in e.outline)),
                                 key=lambda e: e.centroid.x)
        if len(self.electrodes) < 2:
            raise Failure("there is no row of electrodes under the particle")
        self.pitch = self.electrodes[1].centroid.x - self.electrodes[0].centroid.x
        self._first = 0
        self._on = []

    def pull(self, x, count):
        """Switches on so many electrodes from the first one whose centre lies ahead of x."""
        ahead = sum(e.centroid.x < x for e in self.electrodes)
        self._first = min(max(ahead, self._first), len(self.electrodes) - 1)
        channels = [e.channel for e in self.electrodes[self._first:self._first + count]]
        if channels != self._on:
            self._controller.set_electrodes(channels)
            self._on = channels


def deliver(controller, progress, layout, droplet, particle):
    """Takes the particle up, carries it to the target and leaves it there."""
    row = Row(controller, layout, particle.pose.position.y)
    channel = rospy.get_param("~target", -1)
    if channel < 0:
        ahead = [e.channel for e in row.electrodes if e.centroid.x > particle.pose.position.x]
        count = rospy.get_param("~electrodes", 3)
        channel = ahead[count - 1] if 1 <= count <= len(ahead) else -1
    target = next((e for e in row.electrodes if e.channel == channel), None)
    if target is None or not droplet.centroid.x < particle.pose.position.x < target.centroid.x:
        raise Failure(f"target {channel}, allowed: a channel ahead of the particle, towards +x, the droplet behind it")
    voltage = rospy.get_param("~voltage", 0.0) or layout.reference_voltage
    carry_voltage = rospy.get_param("~carry_voltage", 0.0) or 0.86 * voltage
    frequency = rospy.get_param("~frequency", 1000.0)
    began, start_x = time.monotonic(), particle.pose.position.x

    def seen():
        now = controller.particle()
        if now is None or now.id != particle.id:
            raise Failure(f"microparticle {particle.id} is gone")
        return now

    def told(doing, here, now):
        whole = target.centroid.x - start_x
        done = min(max((now.pose.position.x - start_x) / whole, 0.0), 1.0)
        elapsed = time.monotonic() - began
        left = f", {elapsed * (1 - done) / done:4.0f} s left" if done > 0.1 else ""
        progress.show(f"{doing}: droplet {here.id} at x = {here.centroid.x * 1e3:+.3f} mm, particle {now.id} at "
                      f"x = {now.pose.position.x * 1e3:+.3f} mm, {100 * done:3.0f} %{left}")

    def taken(message):
        here, now = find(message, droplet.id), seen()
        told("taking up", here, now)
        row.pull(here.centroid.x + CALL * row.pitch, 2)
        return now if now.droplet == here.id and here.centroid.x > now.pose.position.x else None

    def carried(message):
        here, now = find(message, droplet.id), seen()
        told("carrying", here, now)
        if now.droplet != here.id:
            raise Failure(f"the droplet lost the particle at x = {now.pose.position.x * 1e3:+.3f} mm")
        row.pull(now.pose.position.x + CARRY * row.pitch, 2)
        return here if now.pose.position.x > target.centroid.x - STOP * row.pitch else None

    def left(message):
        here, now = find(message, droplet.id), seen()
        told("leaving", here, now)
        gone = now.droplet != here.id and here.lower.x > now.pose.position.x + CLEAR * row.pitch
        if now.droplet == here.id and now.pose.position.x > target.centroid.x + row.pitch:
            raise Failure("the particle stayed in the droplet, past the target at "
                          f"x = {now.pose.position.x * 1e3:+.3f} mm")
        return now if gone else None

    controller.set_hv(carry_voltage, frequency, True)
    controller.watch(taken)
    here = controller.watch(carried)
    controller.set_hv(voltage, frequency, True)
    row.pull(here.centroid.x + LEAVE * row.pitch, len(row.electrodes))
    lies = controller.watch(left)
    off = lies.pose.position.x - target.centroid.x
    progress.show(f"particle {lies.id} left at x = {lies.pose.position.x * 1e3:+.3f} mm, {off * 1e3:+.3f} mm from the "
                  f"centre of target {channel}, in {time.monotonic() - began:.0f} s of wall time", force=True)


def drive(controller, progress):
    layout = controller.get_layout().layout
    progress.show("waiting for the droplet to settle", force=True)
    droplet = controller.watch(settled_droplet(layout))
    particle = controller.particle()
    if particle is None:
        cross(controller, progress, layout, droplet)
    else:
        deliver(controller, progress, layout, droplet, particle)
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
