"""Figures of profiles and of what changes with time, from files that single runs leave."""
import glob
import os
import re
import sys

import matplotlib.pyplot as plt
import numpy as np

from study_figures.records import columns_of


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
        if not table:  # it has only begun
            continue
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
