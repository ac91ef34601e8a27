"""What `dmf_study` leaves in a folder: records of runs, findings."""
import csv
import glob
import math
import os
import re

import numpy as np


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


def runs_with(folder, name, column):
    """Lines of NAME_runs.csv in which that has happened: a list of ({column: text}, its number)."""
    path = os.path.join(folder, name + "_runs.csv")
    if not os.path.exists(path):
        return []
    with open(path, newline="") as file:
        rows = [(row, float(row[column])) for row in csv.DictReader(file)]
    return [(row, value) for row, value in rows if math.isfinite(value)]


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
