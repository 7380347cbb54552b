# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a study as the paper's Figure 24, 25 or 26 and writes what is drawn as a CSV: figures.py stiffness|clearance|friction STUDY.h5 OUTPUT."""
import csv
import sys

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SHOWN = (0, 0.06, 0.12, 0.18)  # clearances of the paper's figure, in


def write_csv(path, header, rows):
    with open(path, "w", newline="") as f:
        csv.writer(f, lineterminator="\n").writerows([header, *rows])


def stiffness(variables, loads):
    """All 200 stiffnesses."""
    for i in range(3):
        plt.semilogx(variables[:, 0], loads[:, i], label=f"fastener {i + 1}")
    plt.xlabel("fastener stiffness, lb/in")
    plt.ylabel("transferred load, lb (of 1000)")
    plt.title("Load distribution between fasteners (Figure 24)")
    return ["k", "fastener 1", "fastener 2", "fastener 3"], np.column_stack([variables, loads])


def clearance(variables, loads):
    """All 51 clearances, those of the paper with colour and the load at which the fastener begins to bear: lines are straight on either side of it."""
    for gap in np.unique(variables[:, 0]):
        its = variables[:, 0] == gap
        force, load = variables[its, 1], loads[its, 0]
        bearing = load > 1e-9
        shown = next((each for each in SHOWN if abs(each - gap) < 1e-9), None)
        if shown is None:
            plt.plot(force, load, "-", color="0.85", linewidth=0.6, zorder=1)
            continue
        (curve,) = plt.plot(force, load, "-", label=f"{shown:g} in")
        if gap > 0:
            slope, start = np.polyfit(force[bearing], load[bearing], 1)
            contact = -start / slope
            plt.plot(contact, 0, "o", color=curve.get_color(), clip_on=False, zorder=3)
            plt.annotate(f"{contact:.0f} lb", (contact, 0), (0, 8), textcoords="offset points", ha="right", color=curve.get_color())
    plt.ylim(bottom=-8)
    plt.xlabel("external load, lb")
    plt.ylabel("load transferred by fastener 1, lb")
    plt.title("Clearance at the first fastener (Figure 25)")
    return ["clearance", "external load", "fastener 1"], np.column_stack([variables, loads[:, 0]])


def friction(variables, loads):
    """Both readings: of what passes from sheet to sheet, and of the bearing force of fastener 1."""
    mu, base = variables[:, 0], loads[0]
    change = 100 * (loads / base - 1)
    bearing = 100 * (loads[:, 0] / (1 + 2 * mu / np.pi) / base[0] - 1)
    for i, style in ((0, "o-"), (1, "s--"), (2, "^-")):
        plt.plot(mu, change[:, i], style, label=f"fastener {i + 1}: transferred load, F (1 + 2 mu / pi)")
    plt.plot(mu, bearing, "o:", label="fastener 1: bearing force F")
    plt.axhline(0, color="0.5", linewidth=0.8)
    plt.xlabel("friction coefficient mu")
    plt.ylabel("change by friction, %")
    plt.title("Effect of friction (Figure 26), both readings")
    return ["mu", "fastener 1", "fastener 2", "fastener 3", "F of fastener 1"], np.column_stack([mu, change, bearing])


def main(kind, study, output):
    with h5py.File(study) as f:
        variables, loads = f["samples/variable"][:], f["samples/force"][:]
    plt.figure(figsize=(6, 4))
    header, rows = {"stiffness": stiffness, "clearance": clearance, "friction": friction}[kind](variables, loads)
    write_csv(output + ".csv", header, rows.tolist())
    plt.legend(fontsize=9)
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(output + ".png", dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
