#!/usr/bin/python3
"""Figure of one of `dmf_study`'s studies, from the CSV files that it leaves.

    scripts/plot_study.py pickup_size FOLDER            # writes FOLDER/pickup_size.png
    scripts/plot_study.py inner_flow FOLDER flow.png

Runs of microparticles are drawn as far as they have come. What has no figure of its own shows its findings: a panel a
quantity, with the paper's numbers and theory where they are known.
"""
import os
import sys

import matplotlib
matplotlib.use("Agg")

from study_figures import findings, microparticles, profiles

FIGURES = {
    "equation_of_state": findings.plot_equation_of_state,
    "forces": microparticles.plot_forces,
    "holding_force": microparticles.plot_holding_force,
    "inner_flow": microparticles.plot_inner_flow,
    "poiseuille": profiles.plot_poiseuille,
    "square_channel": profiles.plot_square_channel,
    "sloping_channel": profiles.plot_sloping_channel,
    "structured_wall": profiles.plot_structured_wall,
    "infiltration": profiles.plot_infiltration,
    "constriction": profiles.plot_constriction,
}


def main(name, folder, target=None):
    if name in microparticles.TRANSPORT:
        figure = microparticles.plot_transport(folder, name)
    elif name in FIGURES:
        figure = FIGURES[name](folder)
    else:
        figure = findings.plot_findings(folder, name)
    figure.savefig(target or os.path.join(folder, name + ".png"), dpi=110)


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    main(*sys.argv[1:])
