#!/usr/bin/python3
"""Figure of `dmf_study chain`: size and relaxation over the number of beads, extension over force, stretch in a channel.

    scripts/plot_chain.py docs/validation/chain_runs.csv docs/validation/chain.png
"""
import csv
import sys

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# As in src/tools/studies/chain.cpp.
HARMONIC_STIFFNESS, HARMONIC_LENGTH = 60, 0.6
WLC_LENGTH, WLC_PERSISTENCE, WLC_BONDS = 1.5, 0.075, 10


def read(path):
    """{kind: [(value, {column: mean over seeds}, {column: deviation}), ...]}, by rising value."""
    runs = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            kind, value = row.pop("run").split()[0].split("=")
            runs.setdefault((kind, float(value)), []).append({key: float(text) for key, text in row.items()})
    result = {}
    for (kind, value), seeds in sorted(runs.items()):
        mean = {key: np.mean([seed[key] for seed in seeds]) for key in seeds[0]}
        spread = {key: np.std([seed[key] for seed in seeds], ddof=1) if len(seeds) > 1 else 0 for key in seeds[0]}
        result.setdefault(kind, []).append((value, mean, spread))
    return result


def draw(axis, points, column, scale=lambda value: 1, **style):
    axis.errorbar([value for value, _, _ in points], [mean[column] * scale(value) for value, mean, _ in points],
                  yerr=[spread[column] * scale(value) for value, _, spread in points], capsize=3, linestyle="none",
                  **style)


def bond_square():
    r = np.linspace(1e-4, 3, 20000)
    weight = r**2 * np.exp(-HARMONIC_STIFFNESS / 2 * (r - HARMONIC_LENGTH)**2)
    return np.sum(r**2 * weight) / np.sum(weight)


def exact_extension(force):
    x = np.linspace(1e-5, 1 - 1e-5, 20000)
    r = WLC_LENGTH * x
    energy = WLC_LENGTH / (4 * WLC_PERSISTENCE) * (1 / (1 - x) - 1 - x + 2 * x**2)
    weight = r**2 * np.sinh(force * r) / (force * r) * np.exp(-energy)
    return np.sum(r * (1 / np.tanh(force * r) - 1 / (force * r)) * weight) / np.sum(weight) / WLC_LENGTH


def main(source, target):
    runs = read(source)
    figure, ((size, time), (pull, channel)) = plt.subplots(2, 2, figsize=(10, 8), constrained_layout=True)
    beads = np.geomspace(4, 40, 50)

    draw(size, runs.get("ideal", []), "end_to_end_square", marker="o", color="tab:blue", label="phantom chains in a melt")
    size.plot(beads, (beads - 1) * bond_square(), color="tab:blue", label=r"$(N-1)\langle b^2\rangle$")
    draw(size, runs.get("solvent", []), "end_to_end_square", marker="s", color="tab:red", label="good solvent")
    if "solvent" in runs:
        value, mean, _ = runs["solvent"][0]
        size.plot(beads, mean["end_to_end_square"] * ((beads - 1) / (value - 1))**1.176, "--", color="tab:red",
                  label=r"$(N-1)^{2 \cdot 0.588}$")
    size.set(xscale="log", yscale="log", xlabel="beads N", ylabel=r"$\langle R^2\rangle$ ($r_c^2$)")

    draw(time, runs.get("ideal", []), "relaxation", marker="o", color="tab:blue", label="phantom chains in a melt")
    friction = 4 * np.pi * 4.5 * 3 / 90
    time.plot(beads, friction * beads**2 * bond_square() / (3 * np.pi**2), color="tab:blue", label="Rouse")
    time.set(xscale="log", yscale="log", xlabel="beads N", ylabel=r"relaxation time of R ($\tau$)")

    draw(pull, runs.get("pulled", []), "extension", scale=lambda _: 1 / (WLC_BONDS * WLC_LENGTH), marker="o",
         color="tab:blue", label="ten worm-like bonds")
    forces = np.geomspace(0.5, 60, 80)
    pull.plot(forces, [exact_extension(force) for force in forces], color="tab:blue", label="exact for such bonds")
    z = np.linspace(0.01, 0.95, 200)
    pull.plot((1 / (4 * (1 - z)**2) - 0.25 + z) / WLC_PERSISTENCE, z, "--", color="tab:grey",
              label="one worm-like chain (Marko, Siggia)")
    pull.set(xscale="log", xlim=(0.5, 60), xlabel="force ($k_BT/r_c$)", ylabel="extension over contour length")

    draw(channel, runs.get("channel", []), "stretch_square", marker="o", color="tab:blue",
         label=r"$\langle R_x^2\rangle$ along the flow")
    channel.set(xlabel=r"body force ($r_c/\tau^2$)", ylabel=r"$r_c^2$")
    for axis in (size, time, pull, channel):
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    figure.savefig(target, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])
