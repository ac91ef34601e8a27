#!/usr/bin/python3
"""Figure of `dmf_study time_step`: every observable against the time step, and what a tau costs.

    scripts/plot_time_step.py docs/validation/time_step.csv docs/validation/time_step.png
"""
import csv
import math
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt

# Observable in the CSV file, title of its panel.
PANELS = [
    ("temperature", "temperature, bulk ($k_BT$)"),
    ("temperature_at_-22", "temperature, droplet at $A_{lw}$ = -22"),
    ("film_density", "density inside a film ($r_c^{-3}$)"),
    ("normal_pressure", "$P_{zz}$ of a film at rest ($k_BT/r_c^3$)"),
    ("tension", "surface tension ($k_BT/r_c^2$)"),
    ("pressure", r"bulk pressure at $\rho$ = 6.06 ($k_BT/r_c^3$)"),
    ("angle_at_90", "contact angle, commanded 90° (R = 7)"),
    ("from_-20_to_30", r"gradient_R5, x = -20 to 30 ($\tau$)"),
    ("tau_per_second_10000_beads", r"$\tau$ a second, $10^4$ beads, one thread"),
]
LABELS = {"groot_warren": ("Groot-Warren", "o", "tab:red"), "baoab": ("BAOAB", "s", "tab:blue")}


def read(path):
    rows = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            mean, spread = float(row["mean"]), float(row["standard_deviation"])
            if math.isfinite(mean):
                rows.setdefault((row["observable"], row["integrator"]), []).append(
                    (float(row["time_step"]), mean, spread))
    return rows


def main(source, target):
    rows = read(source)
    figure, axes = plt.subplots(3, 3, figsize=(12, 9.5), constrained_layout=True)
    for axis, (observable, title) in zip(axes.flat, PANELS):
        for integrator, (label, marker, colour) in LABELS.items():
            points = rows.get((observable, integrator))
            if points:
                step, mean, spread = zip(*points)
                axis.errorbar(step, mean, yerr=spread, marker=marker, color=colour, label=label, capsize=3)
        axis.set_title(title, fontsize=10)
        axis.set_xlabel(r"$\Delta t$ ($\tau$)")
        axis.set_xlim(0, 0.053)
        axis.grid(alpha=0.3)
    axes.flat[0].legend()
    figure.savefig(target, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
