#!/usr/bin/python3
"""Says what a recorded run did, and draws it.

usage: summarize_run.py BAG [--chip /chip] [--droplet ID] [--target CHANNEL] [--picture FILE.png | --no-picture]

Works on any bag that holds the chip's ~layout, ~droplets, ~electrodes and ~state; with ~particles the picture also
shows the chip with its beads, with ~microparticles the paths of these. Needs no ROS master. Exits with 1 and one line
when the bag can't be used.
"""
import argparse
import bisect
import math
import os
import sys

import numpy as np
import rosbag


class Unusable(Exception):
    """The bag lacks something; the text is for people."""


class Run:
    """What a bag holds of one chip. SI units; times are seconds of chip time."""

    def __init__(self, path, chip):
        try:
            bag = rosbag.Bag(path)
        except (OSError, rosbag.ROSBagException) as error:
            raise Unusable(f"{path} can't be read: {error}") from None
        self.layout = None
        self.states, self.droplets, self.electrodes, self.commands, self.events = [], [], [], [], []
        self._bag, self._particles_topic = bag, chip + "/particles"
        self.microparticles = []
        lists = {"state": self.states, "droplets": self.droplets, "electrodes": self.electrodes,
                 "commands": self.commands, "events": self.events, "microparticles": self.microparticles}
        topics = [f"{chip}/{name}" for name in (*lists, "layout")]
        for topic, message, _ in bag.read_messages(topics):
            name = topic.rsplit("/", 1)[1]
            if name == "layout":
                self.layout = message
            else:
                lists[name].append(message)
        for name, found in (("layout", self.layout), ("state", self.states), ("droplets", self.droplets),
                            ("electrodes", self.electrodes)):
            if not found:
                raise Unusable(f"{path} holds nothing on {chip}/{name}")
        # Only the last run: a reset starts the chip's time over.
        last = self.states[-1].run
        begin = next(state.header.stamp for state in self.states if state.run == last)
        for found in (self.states, self.droplets, self.events, self.microparticles):
            found[:] = [message for message in found if message.header.stamp >= begin]
        # ~electrodes speaks up only when something changes: what was said last before counts too.
        earlier = [message for message in self.electrodes if message.header.stamp < begin]
        self.electrodes[:len(earlier)] = earlier[-1:]
        # The recorder hears the history of commands when it joins, and some of them again.
        self.commands = list({(c.run, c.index): c for c in self.commands if c.run == last}.values())
        self._begin = begin
        self._stamps = [state.header.stamp for state in self.states]

    def chip_time(self, stamp):
        """Seconds of chip time at a ROS time."""
        nearest = self.states[min(bisect.bisect_left(self._stamps, stamp), len(self.states) - 1)]
        per_second = self.layout.time_unit / self.layout.ros_seconds_per_time_unit
        return nearest.time + (stamp - nearest.header.stamp).to_sec() * per_second

    def electrodes_at(self, time):
        """Channel -> state at a chip time."""
        now = self.electrodes[0] if self.electrodes else None
        for message in self.electrodes:
            if self.chip_time(message.header.stamp) > time:
                break
            now = message
        return {electrode.channel: electrode for electrode in now.electrodes} if now else {}

    def particles(self, times):
        """For each time the nearest frame of beads, as (time, droplet id of each, positions in m on the chip)."""
        frames = [(self.chip_time(m.header.stamp), m)
                  for _, m, _ in self._bag.read_messages([self._particles_topic]) if m.header.stamp >= self._begin]
        if not frames:
            return []
        chosen = []
        for time in times:
            at, cloud = min(frames, key=lambda frame: abs(frame[0] - time))
            offset = {field.name: field.offset for field in cloud.fields}
            records = np.frombuffer(cloud.data, dtype=np.dtype({
                "names": ["x", "y", "z", "droplet"], "formats": ["<f4", "<f4", "<f4", "<u4"],
                "offsets": [offset[name] for name in ("x", "y", "z", "droplet")], "itemsize": cloud.point_step}))
            positions = np.stack([records[name] for name in "xyz"], axis=1) / self.layout.display_scale
            chosen.append((at, records["droplet"], positions))
        return chosen


class Track:
    """One droplet's life as arrays over time."""

    def __init__(self, run, droplet):
        seen = [(message.time, d) for message in run.droplets for d in message.droplets
                if droplet is None or d.id == droplet]
        if not seen:
            raise Unusable("there is no droplet in the bag" if droplet is None else
                           f"droplet {droplet} is not in the bag")
        if droplet is None:
            # The one that is there longest.
            ids = [d.id for _, d in seen]
            droplet = max(set(ids), key=ids.count)
            seen = [(time, d) for time, d in seen if d.id == droplet]
        self.id = droplet
        self.observations = [d for _, d in seen]
        self.time = np.array([time for time, _ in seen])
        self.x = np.array([d.centroid.x for d in self.observations])
        self.y = np.array([d.centroid.y for d in self.observations])
        self.advancing = np.array([d.advancing_angle_deg for d in self.observations])
        self.receding = np.array([d.receding_angle_deg for d in self.observations])

    def visited(self):
        """Channels in the order in which the droplet first touched them."""
        return list(dict.fromkeys(channel for d in self.observations for channel in d.channels))


class ParticleTrack:
    """One microparticle's life as arrays over time."""

    def __init__(self, run, particle):
        seen = [(message.time, p) for message in run.microparticles for p in message.microparticles if p.id == particle]
        self.id = particle
        self.radius = seen[0][1].radius
        self.time = np.array([time for time, _ in seen])
        self.position = np.array([[p.pose.position.x, p.pose.position.y, p.pose.position.z] for _, p in seen])
        self.events = [event for event in run.events if event.microparticle == particle]

    def at(self, time):
        """Where it was nearest to a chip time, None when it was not there then."""
        if not self.time[0] <= time <= self.time[-1]:
            return None
        return self.position[np.argmin(abs(self.time - time))]

    def told(self, run, target):
        """A sentence for people."""
        lies = self.position[-1]
        text = f"x {self.position[0, 0] * 1e3:+.3f} to {lies[0] * 1e3:+.3f} mm"
        words = {"picked_up": "taken up by", "dropped_off": "left by"}
        for event in self.events:
            if event.kind in words:
                droplet = (event.after or event.before or [0])[0]
                text += f", {words[event.kind]} droplet {droplet} at {event.time * 1e3:.3f} ms"
        electrodes = [e for e in run.layout.electrodes if target is None or e.channel == target]
        if not electrodes:
            return text
        nearest = min(electrodes, key=lambda e: math.hypot(e.centroid.x - lies[0], e.centroid.y - lies[1]))
        off = math.hypot(nearest.centroid.x - lies[0], nearest.centroid.y - lies[1])
        name = f"channel {nearest.channel}" if target is None else f"target channel {nearest.channel}"
        return f"{text}; lies {off * 1e3:.3f} mm from the centre of {name}"


def particle_tracks(run):
    ids = sorted({p.id for message in run.microparticles for p in message.microparticles})
    return [ParticleTrack(run, particle) for particle in ids]


def driven_span(run, track):
    """First and last index of the track while some pad has a voltage; the whole track when none ever had."""
    changes = [(run.chip_time(m.header.stamp), any(e.voltage > 0 for e in m.electrodes)) for m in run.electrodes]
    driven = [time for time, on in changes if on]
    if not driven:
        return 0, len(track.time) - 1
    begin = driven[0]
    end = next((time for time, on in changes if time > driven[-1] and not on), track.time[-1])
    first = min(int(np.searchsorted(track.time, begin)), len(track.time) - 2)
    last = min(int(np.searchsorted(track.time, end)), len(track.time) - 1)
    return max(first, 0), max(last, first + 1)


def median_text(values):
    values = values[~np.isnan(values)]
    if not len(values):
        return "not measured"
    low, middle, high = np.percentile(values, [25, 50, 75])
    return f"{middle:.1f} deg (middle half {low:.1f} to {high:.1f})"


def summarize(run, track, particles, target, path):
    if len(track.time) < 2:
        raise Unusable("the droplet was seen only once")
    layout = run.layout
    first, last = driven_span(run, track)
    seconds = track.time[last] - track.time[first]
    distance = math.hypot(track.x[last] - track.x[first], track.y[last] - track.y[first])
    speed = distance / seconds if seconds > 0 else math.nan
    unit_speed = layout.length_unit / layout.time_unit
    rates = [state.steps_per_second for state in run.states if state.steps_per_second > 0]
    temperature = np.median([state.temperature_mdpd for state in run.states])
    driven = slice(first, last + 1)
    lines = [
        ("scene", f"{layout.scene}, seed {run.states[-1].seed}, {run.states[-1].moving_beads} moving beads"),
        ("commands", f"{len(run.commands)} accepted: " + ", ".join(command.name for command in run.commands)),
        ("path", f"droplet {track.id} over channels {' '.join(map(str, track.visited()))}, "
                 f"x {track.x[first] * 1e3:+.3f} to {track.x[last] * 1e3:+.3f} mm"),
        ("time", f"{seconds * 1e3:.3f} ms of chip time, {seconds / layout.time_unit:.0f} tau"),
        ("mean velocity", f"{speed * 1e3:.2f} mm/s, {speed / unit_speed:.4f} r_c/tau"),
        ("advancing angle", median_text(track.advancing[driven])),
        ("receding angle", median_text(track.receding[driven])),
        ("temperature", f"{temperature:.3f} k_BT, thermostat at {run.states[-1].target_temperature_mdpd:g}"),
        ("engine", f"{np.median(rates):.0f} steps/s with {run.states[-1].threads} threads, kernel "
                   f"{run.states[-1].kernel}" if rates else "never ran"),
        ("bag", f"{os.path.abspath(path)}, {os.path.getsize(path) / 1e6:.1f} MB"),
    ]
    lines[3:3] = [(f"microparticle {particle.id}", particle.told(run, target)) for particle in particles]
    faults = [event.message for event in run.events if event.kind == "fault"]
    if faults:
        lines.append(("fault", faults[-1]))
    for name, text in lines:
        print(f"{name + ':':17} {text}")


def draw_trajectory(axes, run, track, particles):
    """x over time, over the electrodes as bands: orange while they have a voltage."""
    from matplotlib.patches import Rectangle
    end = track.time[-1] * 1e3
    row = [e for e in run.layout.electrodes
           if min(c.y for c in e.outline) <= track.y[0] <= max(c.y for c in e.outline)] or run.layout.electrodes
    changes = [(run.chip_time(m.header.stamp) * 1e3, {e.channel: e.voltage for e in m.electrodes})
               for m in run.electrodes]
    for electrode in row:
        xs = [corner.x * 1e3 for corner in electrode.outline]
        low, high = min(xs), max(xs)
        axes.axhspan(low, high, color="0.9", zorder=0)
        axes.text(0.01, 0.5 * (low + high), str(electrode.channel), transform=axes.get_yaxis_transform(),
                  va="center", color="0.4")
        for (begin, voltages), until in zip(changes, [time for time, _ in changes[1:]] + [end]):
            strength = voltages.get(electrode.channel, 0) / run.layout.max_voltage
            if strength > 0:
                axes.add_patch(Rectangle((begin, low), until - begin, high - low, color=voltage_color(strength),
                                         alpha=0.6, zorder=1))
    axes.plot(track.time * 1e3, track.x * 1e3, color="C0", zorder=2, label=f"droplet {track.id}")
    for particle in particles:
        axes.plot(particle.time * 1e3, particle.position[:, 0] * 1e3, color="C3", zorder=3,
                  label=f"microparticle {particle.id}")
        for event in particle.events:
            place = particle.at(event.time)
            if place is not None:
                axes.plot(event.time * 1e3, place[0] * 1e3, "^" if event.kind == "picked_up" else "v", color="C3",
                          zorder=4)
    if particles:
        axes.legend(fontsize="small", loc="lower right")
    xs = [corner.x * 1e3 for electrode in row for corner in electrode.outline]
    marks = ", microparticles taken up (▲) and left (▼)" if particles else ""
    axes.set(xlabel="chip time (ms)", ylabel="x (mm)", title=f"droplet {track.id} over the electrodes{marks}",
             xlim=(track.time[0] * 1e3, end), ylim=(min(xs), max(xs)))


def draw_angles(axes, run, track):
    axes.plot(track.time * 1e3, track.advancing, color="C1", label="advancing")
    axes.plot(track.time * 1e3, track.receding, color="C0", label="receding")
    axes.axhline(run.layout.rest_angle_deg, color="0.6", linestyle=":", label="commanded without voltage")
    axes.set(xlabel="chip time (ms)", ylabel="contact angle (deg)", title="contact angles",
             xlim=(track.time[0] * 1e3, track.time[-1] * 1e3))
    axes.legend(fontsize="small")


def voltage_color(fraction):
    """As in RViz: grey without voltage, orange at the board's limit."""
    f = min(max(fraction, 0.0), 1.0)
    return (0.75 + 0.25 * f, 0.75 - 0.20 * f, 0.75 - 0.70 * f)


def draw_chip(axes, run, particles, frame, side):
    """The chip from above, or from the side, with the beads of one frame."""
    from matplotlib.patches import Circle, Polygon
    layout, (time, droplets, positions) = run.layout, frame
    states = run.electrodes_at(time)
    plate = layout.lower.z * 1e3
    for electrode in layout.electrodes:
        voltage = states[electrode.channel].voltage if electrode.channel in states else 0
        corners = np.array([(corner.x, corner.y) for corner in electrode.outline]) * 1e3
        color = voltage_color(voltage / layout.max_voltage)
        if side:
            axes.plot([corners[:, 0].min(), corners[:, 0].max()], [plate, plate], color=color, linewidth=5,
                      solid_capstyle="butt", zorder=0)
            continue
        axes.add_patch(Polygon(corners, facecolor=color, edgecolor="0.4", linewidth=0.5))
        axes.text(electrode.centroid.x * 1e3, electrode.centroid.y * 1e3, str(electrode.channel), ha="center",
                  va="center", color="0.2", fontsize="small")
    # Painted from back to front, lighter towards the viewer: enough to see a body.
    depth = -positions[:, 1] if side else positions[:, 2]
    order = np.argsort(depth)
    span = np.ptp(depth) or 1.0
    shade = 0.45 + 0.55 * (depth[order] - depth.min()) / span
    base = np.array([[0.25, 0.55, 0.95] if d else [0.6, 0.6, 0.6] for d in droplets[order]])
    height = positions[order, 2] if side else positions[order, 1]
    axes.scatter(positions[order, 0] * 1e3, height * 1e3, s=2, c=base * shade[:, None], linewidths=0)
    for particle in particles:
        place = particle.at(time)
        if place is not None:
            axes.add_patch(Circle((place[0] * 1e3, place[2 if side else 1] * 1e3), particle.radius * 1e3,
                                  facecolor="C3", edgecolor="black", linewidth=0.5, zorder=3))
    axes.set_aspect("equal")
    axes.set_title(f"{'from the side' if side else 'from above'}, {time * 1e3:.2f} ms", fontsize="small")


def draw(run, track, particles, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    first, last = driven_span(run, track)
    times = np.linspace(track.time[first], track.time[last], 4)
    frames = run.particles(times)
    figure = plt.figure(figsize=(15, 8), layout="constrained")
    columns = figure.add_gridspec(1, 2 if frames else 1)
    left = columns[0].subgridspec(2, 1, height_ratios=(3, 2))
    draw_trajectory(figure.add_subplot(left[0]), run, track, particles)
    draw_angles(figure.add_subplot(left[1]), run, track)
    if frames:
        corners = [corner for electrode in run.layout.electrodes for corner in electrode.outline]
        radius = max(d.upper.z - d.lower.z for d in track.observations)
        margin = 0.2 * radius
        xs = [min(min(c.x for c in corners) - margin, track.x.min() - radius) * 1e3,
              max(max(c.x for c in corners) + margin, track.x.max() + radius) * 1e3]
        ys = [(track.y.min() - radius) * 1e3, (track.y.max() + radius) * 1e3]
        top = max(d.upper.z for d in track.observations)
        right = columns[1].subgridspec(len(frames) + 1, 1)
        for i, frame in enumerate(frames):
            axes = figure.add_subplot(right[i])
            draw_chip(axes, run, particles, frame, side=False)
            axes.set(xlim=xs, ylim=ys, ylabel="y (mm)")
        axes = figure.add_subplot(right[-1])
        draw_chip(axes, run, particles, frames[len(frames) // 2], side=True)
        plate = run.layout.lower.z
        axes.set(xlim=xs, ylim=[(plate - 0.2 * radius) * 1e3, (top + 0.2 * radius) * 1e3], xlabel="x (mm)",
                 ylabel="z (mm)")
    figure.suptitle(f"{run.layout.scene}: {os.path.basename(run._bag.filename)}")
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description="Says what a recorded run did, and draws it.")
    parser.add_argument("bag")
    parser.add_argument("--chip", default="/chip", help="name of the chip node")
    parser.add_argument("--droplet", type=int, help="id; default: the one that is there longest")
    parser.add_argument("--target", type=int, help="channel where microparticles were to be left; default: the nearest")
    parser.add_argument("--picture", help="default: BAG with .png")
    parser.add_argument("--no-picture", action="store_true")
    arguments = parser.parse_args()
    picture = arguments.picture or os.path.splitext(arguments.bag)[0] + ".png"
    try:
        run = Run(arguments.bag, arguments.chip)
        track = Track(run, arguments.droplet)
        particles = particle_tracks(run)
        summarize(run, track, particles, arguments.target, arguments.bag)
        if not arguments.no_picture:
            draw(run, track, particles, picture)
            print(f"{'picture:':17} {os.path.abspath(picture)}")
    except (Unusable, OSError) as error:
        print(f"summarize_run: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
