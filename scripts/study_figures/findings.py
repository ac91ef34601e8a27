"""Figures of a study's findings, beside the paper's numbers and theory."""
import math
import sys

import matplotlib.pyplot as plt
import numpy as np

from study_figures.records import findings_of, number


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
