"""Figures of Lan's studies of microparticles, as far as their runs have come."""
import csv
import glob
import math
import os
import re
import sys

import matplotlib.pyplot as plt
import numpy as np

from study_figures.records import findings_of, runs_of, runs_with, summary_of

# Study: how names of its values begin in file names, and what its second panel shows: heights over time, or a quantity of
# NAME.csv against the value.
TRANSPORT = {
    "pickup": ("scene", "height"),
    "pickup_size": ("R", "passes_0"),
    "pickup_wetting": ("A_ls", "height"),
    "friction": ("f", "passes_0"),
    "dropoff_size": ("R", "critical_velocity"),
    "dropoff_wetting": ("A_ls", "height"),
    "passive_delivery": ("scene", "height"),
    "active_delivery": ("scene", "height"),
    "thermal": ("k_BT", "passes_0"),
    "multi_particle": ("scene", "height"),
}
WITH_DROPLET = {"dropoff_size", "dropoff_wetting", "passive_delivery", "active_delivery", "multi_particle"}
TITLES = {
    "passes_0": r"passes x = 0 at ($\tau$)",
    "critical_velocity": r"critical velocity ($r_c/\tau$)",
}


def from_zero(axis, values):
    """An axis that shows 0 and all values, negative ones too, with room above."""
    values = values[np.isfinite(values)]
    if values.size:
        axis.set_ylim(min(0, 1.1 * values.min()), max(1.1 * values.max(), 1e-9))


def plot_transport(folder, name):
    prefix, second = TRANSPORT[name]
    runs, summary = runs_of(folder, name, prefix), summary_of(folder, name)
    if not runs:
        sys.exit("%s: no runs of %s" % (folder, name))
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5), constrained_layout=True)
    colours = plt.cm.viridis(np.linspace(0, 0.9, len(runs)))
    for (value, seeds), colour in zip(runs.items(), colours):
        for index, records in enumerate(seeds):
            label = value if index == 0 else None
            for body in np.unique(records["microparticle"]):
                own = records["microparticle"] == body
                time = records["time"][own]
                style = {"color": colour, "linewidth": 1, "label": label}
                if name == "multi_particle":
                    style["color"] = "tab:red" if body % 2 else "tab:blue"
                    style["label"] = {1: "hydrophobic", 2: "hydrophilic"}.get(int(body)) if index == 0 else None
                left.plot(time, records["x"][own], **style)
                if second == "height":
                    right.plot(time, records["height"][own], **style)
                label = None
            if name in WITH_DROPLET:
                own = records["microparticle"] == records["microparticle"][0]
                left.plot(records["time"][own], records["droplet_x"][own], color=colour, linewidth=0.7, linestyle=":")
            lost = records["dropped_off"] * (records["carrier"] != records["droplet"]) > 0
            left.plot(records["time"][lost], records["x"][lost], "v", color=colour, markersize=5)
        for quantity, x in (("passes_0", 0), ("passes_40", 40)):
            lan = summary.get((value, quantity), (0, 0, math.nan))[2]
            if math.isfinite(lan):
                left.plot(lan, x, "*", color=colour, markeredgecolor="black", markersize=13)
        lan = summary.get((value, "dropped_off_x"), (0, 0, math.nan))[2]
        if math.isfinite(lan):
            left.axhline(lan, color=colour, linestyle="--", linewidth=0.8)
        lan = summary.get((value, "lifted"), (0, 0, math.nan))[2]
        if math.isfinite(lan) and second == "height":
            right.axvline(lan, color=colour, linestyle="--", linewidth=0.8)
    left.set_ylabel("x ($r_c$)" + ("; dotted: droplet" if name in WITH_DROPLET else ""))
    left.set_title("%s: microparticles; triangles: dropped off; stars, dashes: Lan" % name, fontsize=10)
    left.legend(fontsize=8)
    if second == "height":
        right.set_ylabel("height of the centre over the wall ($r_c$)")
        right.set_title("dashes: lifted off, Lan" if name == "pickup_wetting" else "", fontsize=10)
    else:
        values = [value for value in runs if (value, second) in summary]
        mean, deviation, lan = (np.array([summary[value, second][k] for value in values]) for k in range(3))
        places = np.arange(len(values))
        right.errorbar(places, mean, yerr=deviation, marker="o", linestyle="none", capsize=4, label="here")
        if np.isfinite(lan).any():
            right.plot(places, lan, "k*", markersize=11, label="Lan")
        right.set_xticks(places, values)
        right.set_ylabel(TITLES[second])
        from_zero(right, np.concatenate([mean + deviation, lan]))
        right.legend()
    for axis in (left, right):
        axis.grid(alpha=0.3)
    left.set_xlabel(r"t ($\tau$)")
    if second == "height":
        right.set_xlabel(r"t ($\tau$)")
    return figure


def plot_forces(folder):
    rows = {}
    for row in findings_of(folder, "forces"):
        place = re.fullmatch(r"f=([^/]*)/\S+ x=(\S+).*", row["case"])
        if not place:  # of several places
            continue
        friction, x = place.groups()
        rows.setdefault(friction, {}).setdefault(row["quantity"], []).append(
            (float(x), row["mean"], row["standard_deviation"]))
    figure, axes = plt.subplots(1, len(rows), figsize=(4 * len(rows), 4), constrained_layout=True, squeeze=False)
    for axis, (static_friction, quantities) in zip(axes.flat, rows.items()):
        velocity = axis.twinx()
        shown = {axis: [], velocity: []}
        for quantity, sign, target, style in (("drive_x", 1, axis, "o-r"), ("friction_x", -1, axis, "s-b"),
                                              ("velocity", 1, velocity, "^--k")):
            x, mean, spread = (np.array(column) for column in zip(*quantities[quantity]))
            target.errorbar(x, sign * mean, yerr=spread, fmt=style, capsize=3,
                            label={"drive_x": "drive", "friction_x": "- friction"}.get(quantity, quantity))
            shown[target].extend(sign * mean + spread)
        for target, values in shown.items():
            from_zero(target, np.array(values))
        axis.set_title("$f_s$ = " + static_friction)
        axis.set_xlabel("x of the gradient ($r_c$)")
        axis.grid(alpha=0.3)
    axes.flat[0].set_ylabel("force ($k_BT/r_c$)")
    velocity.set_ylabel(r"velocity ($r_c/\tau$), dashed")
    axes.flat[0].legend(loc="lower right")
    return figure


# Contact angle over x of the scenes in which droplets lose their microparticle: set_wettability of their schedules.
PLATES = {"dropoff_size": ([-40, 40], [150, 40]), "passive_delivery": ([-40, -20, 25.1], [150, 102, 40])}


def plot_holding_force(folder):
    figure, axis = plt.subplots(figsize=(7, 5), constrained_layout=True)
    for (name, (places, plate)), style in zip(PLATES.items(), ("s", "^")):
        for contact, fill in (("", "full"), (", contact: coulomb", "none")):
            lost = [(np.interp(float(run["dropped_off_x"]), places, plate), force)
                    for run, force in runs_with(folder, name, "held_with") if ("coulomb" in run["run"]) == bool(contact)]
            if lost:
                axis.plot(*zip(*lost), style, fillstyle=fill, label="lost on its way (%s%s)" % (name, contact))
    with open(os.path.join(folder, "holding_force_runs.csv"), newline="") as file:
        for row in csv.DictReader(file):
            angle = float(re.search(r"theta=([\d.]+)", row["run"]).group(1))
            kept = math.isnan(float(row["dropped_off"]))
            axis.plot(angle, 46, "o" if kept else "x", color="black", fillstyle="none", markersize=11 if kept else 8)
    axis.plot([], [], "x", color="black", label="R = 5 pulled with 46 (holding_force): lost")
    axis.plot([], [], "o", color="black", fillstyle="none", label=r"kept for 2,850 $\tau$")
    theta = np.radians(np.linspace(50, 130, 81))
    thread = (theta - np.sin(theta) * np.cos(theta)) / (1 - np.cos(theta))
    axis.plot(np.degrees(theta), 2 * 7.54 * 2 * thread, "k--", linewidth=0.8, label="a thread 2 $r_c$ high")
    axis.set_xlabel("contact angle of the plate there (degrees)")
    axis.set_ylabel("force until it let go ($k_BT/r_c$)")
    axis.set_ylim(bottom=0)
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    return figure


def mean_cells(paths, plane):
    """One plane over all runs in cells of 1 r_c, four of the files', weighted with how much liquid was there: arrays s, z,
    density, v_s, v_z."""
    sums = {}
    for path in paths:
        with open(path, newline="") as file:
            for row in csv.DictReader(file):
                if row["plane"] == plane:
                    # Middles of cells at whole numbers: one of them is over the centre.
                    cell = math.floor(float(row["s"]) + 0.5), math.floor(float(row["z"])) + 0.5
                    sums[cell] = sums.get(cell, 0) + float(row["density"]) * np.array(
                        [1, float(row["v_s"]), float(row["v_z"])])
    cells = [(s, z, total[0] / (4 * len(paths)), total[1] / total[0], total[2] / total[0])
             for (s, z), total in sums.items()]
    # Half of the bulk's density and more is inside the surface.
    return np.array([cell for cell in cells if cell[2] > 3]).T


def plot_inner_flow(folder):
    cases = [("particle", "with a microparticle"), ("alone", "droplet alone")]
    found = [(title, paths) for case, title in cases
             if (paths := glob.glob(os.path.join(folder, "runs", "inner_flow_%s*_cells.csv" % case)))]
    if not found:
        sys.exit("%s: no cells of inner_flow" % folder)
    figure, axes = plt.subplots(len(found), 2, figsize=(13, 4.5 * len(found)), constrained_layout=True, squeeze=False)
    for row, (title, paths) in zip(axes, found):
        for axis, plane in zip(row, ("xz", "yz")):
            cells = mean_cells(paths, plane)
            if cells.size:
                s, z, _, v_s, v_z = cells
                arrows = axis.quiver(s, z, v_s, v_z, np.hypot(v_s, v_z), cmap="viridis", angles="xy", width=0.003)
                figure.colorbar(arrows, ax=axis, label=r"$|v|$ ($r_c/\tau$)")
                # Room for the arrows that point out of the droplet.
                axis.set_xlim(s.min() - 2, s.max() + 2)
                axis.set_ylim(-1, z.max() + 1)
            if title.startswith("with"):
                axis.add_patch(plt.Circle((0, 1), 1, color="tab:green", alpha=0.4))
            axis.axhline(0, color="tab:red", linewidth=3)
            axis.set_aspect("equal")
            axis.set_xlabel("%s from the %s ($r_c$)" % (plane[0], "microparticle" if title.startswith("with") else "droplet"))
            axis.set_ylabel("height ($r_c$)")
            axis.set_title("%s, %s plane, over the wall" % (title, plane), fontsize=10)
    return figure
