#!/usr/bin/python3
"""Figure of one of `dmf_study`'s studies, from the CSV files that it leaves.

    scripts/plot_study.py pickup_size FOLDER            # writes FOLDER/pickup_size.png
    scripts/plot_study.py inner_flow FOLDER flow.png

Runs of microparticles are drawn as far as they have come. What has no figure of its own shows its findings: a panel a
quantity, with the paper's numbers and theory where they are known.
"""
import csv
import glob
import math
import os
import re
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

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


def columns_of(path):
    """A CSV file of numbers as {column: array}."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in (rows[0] if rows else [])}


def as_file_name(value):
    """What saved_run.cpp makes of a run's key."""
    return value.replace("=", "").replace(" ", "_").replace("/", "_")


def runs_of(folder, name, prefix):
    """{value as in file names: [records by seed]}, finished and unfinished runs, by number where values are numbers."""
    found = {}
    for path in glob.glob(os.path.join(folder, "runs", name + "_*.csv")):
        match = re.fullmatch(name + "_(" + prefix + r".*)_seed(\d+)(\.part)?\.csv", os.path.basename(path))
        if match:
            found.setdefault(match.group(1), {})[int(match.group(2))] = columns_of(path)
    numbers = lambda value: [float(number) for number in re.findall(r"-?\d+\.?\d*", value)]
    return {value: [found[value][seed] for seed in sorted(found[value])]
            for value in sorted(found, key=lambda value: (re.sub(r"[-\d.]+", "", value), numbers(value)))}


def number(text):
    """Of a reference: NaN where it is none."""
    try:
        return float(text.removeprefix("about "))
    except ValueError:
        return math.nan


def findings_of(folder, name):
    """What NAME.csv holds: a list of {case, quantity, mean, standard_deviation, paper, theory, title}, numbers as such."""
    path = os.path.join(folder, name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        return [{**row, **{key: number(row[key]) for key in ("mean", "standard_deviation", "paper", "theory")}}
                for row in csv.DictReader(file)]


def summary_of(folder, name):
    """{(value as in file names, quantity): (mean, deviation, the paper's number or NaN)}, in the file's order."""
    return {(as_file_name(row["case"] or "scene"), row["quantity"]):
            (row["mean"], row["standard_deviation"], row["paper"]) for row in findings_of(folder, name)}


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
        friction, x = re.fullmatch(r"f=([^/]*)/\S+ x=(\S+).*", row["case"]).groups()
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
            if title.startswith("with"):
                axis.add_patch(plt.Circle((0, 1), 1, color="tab:green", alpha=0.4))
            axis.axhline(0, color="tab:red", linewidth=3)
            axis.set_aspect("equal")
            axis.set_xlabel("%s from the %s ($r_c$)" % (plane[0], "microparticle" if title.startswith("with") else "droplet"))
            axis.set_ylabel("height ($r_c$)")
            axis.set_title("%s, %s plane, over the wall" % (title, plane), fontsize=10)
    return figure


def plot_poiseuille(folder):
    """Velocity across the channel with the parabola through its middle, density and temperature, of every kind of wall."""
    figure, (flow, density, temperature) = plt.subplots(1, 3, figsize=(12, 4.2), constrained_layout=True)
    for number, path in enumerate(sorted(glob.glob(os.path.join(folder, "poiseuille_*_seed1.csv")))):
        label = re.fullmatch(r"poiseuille_(.*)_seed1\.csv", os.path.basename(path)).group(1).replace("_", " ")
        table, color = columns_of(path), "C%d" % number
        flow.plot(table["z"], table["velocity"], ".", color=color, markersize=4, label=label)
        flow.plot(table["z"], table["parabola"], color=color, linewidth=0.8)
        density.plot(table["z"], table["density"], color=color, linewidth=0.8, label=label)
        temperature.plot(table["z"], table["temperature"], color=color, linewidth=0.8, label=label)
    flow.axhline(8.60, color="black", linewidth=0.8, linestyle="--", label="Lan, u_max 3D")
    flow.axhline(9.18, color="black", linewidth=0.8, linestyle=":", label="Lan, u_max 2D")
    flow.set_ylabel(r"velocity ($r_c/\tau$)")
    density.set_ylabel(r"density ($r_c^{-3}$, 2D $r_c^{-2}$)")
    temperature.set_ylabel(r"$k_BT$")
    for axis in (flow, density, temperature):
        axis.set_xlabel(r"z ($r_c$)")
    flow.legend(fontsize=7)
    return figure


def plot_square_channel(folder):
    """Velocity across the channel at three heights, beside the series."""
    paths = sorted(glob.glob(os.path.join(folder, "square_channel_a*_seed1.csv")))
    if not paths:
        sys.exit("%s: no profile of square_channel" % folder)
    figure, axes = plt.subplots(1, len(paths), figsize=(6.4 * len(paths), 4.2), constrained_layout=True, squeeze=False)
    for axis, path in zip(axes[0], paths):
        table = columns_of(path)
        levels = np.unique(table["z"])
        for share, color in ((0.5, "tab:blue"), (0.2, "tab:orange"), (0.05, "tab:green")):
            z = levels[int(share * len(levels))]
            row = table["z"] == z
            axis.plot(table["y"][row], table["velocity"][row], "o", markersize=3, color=color, label="z = %g" % z)
            axis.plot(table["y"][row], table["theory"][row], color=color)
        axis.set_title(os.path.basename(path)[len("square_channel_"):-len("_seed1.csv")] + ", lines: series", fontsize=10)
        axis.set_xlabel("y ($r_c$)")
        axis.set_ylabel(r"velocity ($r_c/\tau$)")
        axis.legend()
    return figure


def plot_equation_of_state(folder):
    """Pressure over density: of liquids with a theory, and of Liu's, whose loops a van der Waals curve is laid through."""
    liquids, fits = {}, {}
    for row in findings_of(folder, "equation_of_state"):
        liquid, _, density = row["case"].partition(" rho=")
        if not math.isfinite(row["mean"]):
            continue
        if density:
            liquids.setdefault(liquid, []).append((float(density), row["mean"], row["theory"], row["paper"]))
        else:
            fits.setdefault(liquid, {})[row["quantity"]] = row["mean"]
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.4), constrained_layout=True)
    for liquid, points in liquids.items():
        place, pressure, theory, paper = np.array(points).T
        axis = axes[2 if np.isfinite(paper).any() else 1 if liquid.startswith("spline") else 0]
        line, = axis.plot(place, pressure, "o", markersize=4, label=liquid)
        axis.plot(place, theory, linewidth=0.8, color=line.get_color())
        axis.plot(place, paper, "--", linewidth=0.8, color=line.get_color())
        if liquid.startswith("spline"):
            a, b = fits[liquid]["van_der_waals_a"], fits[liquid]["van_der_waals_b"]
            fine = np.linspace(place.min(), place.max(), 100)
            axis.plot(fine, fine * float(liquid.rpartition("k_BT=")[2]) / (1 - b * fine) - a * fine ** 2,
                      linewidth=0.8, color=line.get_color())
    for axis, title in zip(axes, ("lines: Groot and Warren, Warren", "Liu's potential, lines: van der Waals fits",
                                  "the same, weak; dashed: Liu's curve")):
        axis.set_title(title, fontsize=9)
        axis.set_xlabel("density ($r_c^{-3}$)")
        axis.set_ylabel("pressure ($k_BT/r_c^3$)")
        axis.legend(fontsize=7)
        axis.grid(alpha=0.3)
    return figure


def plot_sloping_channel(folder):
    """Velocity and stretching of chains along the channel, with its height."""
    paths = sorted(glob.glob(os.path.join(folder, "sloping_channel_*_seed1.csv")))
    if not paths:
        sys.exit("%s: no run of sloping_channel" % folder)
    figure, axes = plt.subplots(3, 1, figsize=(8, 8), constrained_layout=True, sharex=True)
    for path in paths:
        table = columns_of(path)
        label = os.path.basename(path)[len("sloping_channel_"):-len("_seed1.csv")].replace("_", " ")
        line, = axes[0].plot(table["x"], table["height"], label=label)
        axes[1].plot(table["x"], table["velocity"], ".", markersize=4, color=line.get_color())
        axes[1].plot(table["x"], table["theory"], linewidth=0.8, color=line.get_color())
        axes[2].plot(table["x"], table["stretch_square"], linewidth=1, color=line.get_color())
    axes[0].set_ylabel("height ($r_c$)")
    axes[0].legend(fontsize=7)
    axes[1].set_ylabel(r"velocity ($r_c/\tau$), lines: even density")
    axes[2].set_ylabel(r"$\langle R_x^2\rangle$ of chains here ($r_c^2$)")
    axes[2].set_xlabel("x ($r_c$), the flow goes to the right")
    return figure


def plot_structured_wall(folder):
    """Front and advancing angle over time of every driven run."""
    paths = sorted(path for path in glob.glob(os.path.join(folder, "structured_wall_*_seed*.csv")))
    if not paths:
        sys.exit("%s: no driven run of structured_wall" % folder)
    figure, (front, angle) = plt.subplots(2, 1, figsize=(8, 7), constrained_layout=True, sharex=True)
    for path in paths:
        table = columns_of(path)
        label = os.path.basename(path)[len("structured_wall_"):-len(".csv")].replace("_", " ")
        front.plot(table["time"], table["front"], linewidth=1, label=label)
        angle.plot(table["time"], table["angle"], linewidth=1)
    front.set_ylabel("front ($r_c$)")
    front.legend(fontsize=7)
    angle.set_ylabel("advancing angle (degrees)")
    angle.set_xlabel(r"time ($\tau$)")
    return figure


def plot_constriction(folder):
    """How long the cell is, how fast, and what it keeps of its area and volume, on its way through the throat; a line a seed."""
    paths = sorted(glob.glob(os.path.join(folder, "constriction_*_seed*.csv")))
    if not paths:
        sys.exit("%s: no run of constriction" % folder)
    figure, (shape, speed, kept) = plt.subplots(3, 1, figsize=(7, 7.5), constrained_layout=True, sharex=True)
    for index, path in enumerate(paths):
        table = columns_of(path)
        color = "C%d" % index
        shape.plot(table["x"], table["length"], color=color, label="length" if index == 0 else None)
        shape.plot(table["x"], table["width"], "--", color=color, label="width" if index == 0 else None)
        speed.plot(table["x"], np.gradient(table["x"], table["time"]), color=color)
        kept.plot(table["x"], table["area"], color=color, label="area" if index == 0 else None)
        kept.plot(table["x"], table["volume"], "--", color=color, label="volume" if index == 0 else None)
    for axis in (shape, speed, kept):
        axis.axvspan(-4, 4, color="0.9")
    shape.set_ylabel("extent ($r_c$)")
    speed.set_ylabel(r"speed of its centre ($r_c/\tau$)")
    kept.set_ylabel("of that when placed")
    kept.set_xlabel("its centre, x ($r_c$); grey: the throat")
    shape.legend(fontsize=8)
    kept.legend(fontsize=8)
    return figure


def plot_infiltration(folder):
    """Share of the pore space that is filled, over time; a colour a case, a line a seed."""
    paths = sorted(glob.glob(os.path.join(folder, "infiltration_*_seed*.csv")))
    if not paths:
        sys.exit("%s: no run of infiltration" % folder)
    figure, axis = plt.subplots(figsize=(8, 4.5), constrained_layout=True)
    colors = {}
    for path in paths:
        table = columns_of(path)
        case = os.path.basename(path)[len("infiltration_"):].rpartition("_seed")[0].replace("_", " ")
        label = case if case not in colors else None
        color = colors.setdefault(case, "C%d" % len(colors))
        axis.plot(table["time"], table["filled"], color=color, label=label)
    axis.set_xlabel(r"time ($\tau$)")
    axis.set_ylabel("filled share of the pore space")
    axis.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def place_of(case):
    """A case as a series and a place in it: "gap=4 angle=70" is 70 of "gap=4", by "angle"."""
    words = case.split()
    name, _, value = words[-1].partition("=") if words else ("", "", "")
    return (" ".join(words[:-1]), name, number(value)) if value and math.isfinite(number(value)) else (case, "", math.nan)


def series_of(found):
    """The findings of a panel by series: points along one value that the cases differ by, or every case by its name."""
    series = {}
    for row in found:
        label, axis_name, place = place_of(row["case"])
        series.setdefault((label, axis_name), []).append((place, row))
    one_axis = len({axis_name for _, axis_name in series}) == 1
    if one_axis and any(len({place for place, _ in points}) > 1 for points in series.values()):
        return series
    return {(row["case"], ""): [(math.nan, row)] for row in found}


def plot_findings(folder, name):
    """A panel a quantity: ours with spread over what is varied, the paper's numbers as stars, theory as lines."""
    panels = {}
    for row in findings_of(folder, name):
        if math.isfinite(row["mean"]):
            panels.setdefault((row["quantity"], row["title"]), []).append(row)
    # One number on its own says nothing in a figure.
    panels = {key: rows for key, rows in panels.items() if len(rows) > 1}
    if not panels:
        sys.exit("%s: %s.csv holds nothing to draw" % (folder, name))
    columns = min(3, len(panels))
    rows = -(-len(panels) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(4.6 * columns, 3.4 * rows), constrained_layout=True, squeeze=False)
    for axis in axes.flat[len(panels):]:
        axis.remove()
    for axis, ((_, title), found) in zip(axes.flat, panels.items()):
        names = []
        series = series_of(found)
        for index, ((label, axis_name), points) in enumerate(series.items()):
            if not all(math.isfinite(place) for place, _ in points):
                points = [(len(names), row) for _, row in points]
                names.append(label)
                axis.set_xticks(range(len(names)), names, rotation=30, ha="right", fontsize=7)
                label = None
            else:
                points.sort(key=lambda point: point[0])
                axis.set_xlabel(axis_name)
                label = label or axis_name
            colour = "C%d" % (index % 10)
            place = [point[0] for point in points]
            values = {key: np.array([row[key] for _, row in points])
                      for key in ("mean", "standard_deviation", "paper", "theory")}
            axis.errorbar(place, values["mean"], yerr=values["standard_deviation"], fmt="o", markersize=4, capsize=3,
                          color=colour, label=label)
            axis.plot(place, values["paper"], "*", color=colour, markeredgecolor="black", markersize=10)
            axis.plot(place, values["theory"], "_" if len(place) == 1 else "-", color=colour, linewidth=0.8)
        axis.set_title(title, fontsize=9)
        axis.grid(alpha=0.3)
        if not names and len(series) > 1:
            axis.legend(fontsize=7)
    figure.suptitle("%s: dots ours, stars the paper's, lines theory" % name, fontsize=10)
    return figure


FIGURES = {
    "equation_of_state": plot_equation_of_state,
    "forces": plot_forces,
    "inner_flow": plot_inner_flow,
    "poiseuille": plot_poiseuille,
    "square_channel": plot_square_channel,
    "sloping_channel": plot_sloping_channel,
    "structured_wall": plot_structured_wall,
    "infiltration": plot_infiltration,
    "constriction": plot_constriction,
}


def main(name, folder, target=None):
    if name in TRANSPORT:
        figure = plot_transport(folder, name)
    elif name in FIGURES:
        figure = FIGURES[name](folder)
    else:
        figure = plot_findings(folder, name)
    figure.savefig(target or os.path.join(folder, name + ".png"), dpi=110)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
