# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects one study into a CSV and draws it as the paper's Figure 24, 25 or 26: figures.py STUDY FOLDER OUTPUT."""
import csv
import json
import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def results(folder):
    """Joint, load factors (steps) and transferred loads (steps, fasteners) of every result of a study."""
    for path in sorted(Path(folder).glob("*.h5")):
        with h5py.File(path) as f:
            yield json.loads(f["input"].asstr()[()]), f["load_factor"][:], f["transferred"][:, :, 1]


def write_csv(path, header, rows):
    with open(path, "w", newline="") as f:
        csv.writer(f, lineterminator="\n").writerows([header, *rows])


def stiffness(folder):
    rows = [[joint["laws"]["bolt"]["k"], *loads[-1]] for joint, _, loads in results(folder)]
    for i in (1, 2, 3):
        plt.semilogx([r[0] for r in rows], [r[i] for r in rows], label=f"fastener {i}")
    plt.xlabel("fastener stiffness, lb/in")
    plt.ylabel("transferred load, lb (of 1000)")
    plt.title("Load distribution between fasteners (Figure 24)")
    return ["k", "fastener 1", "fastener 2", "fastener 3"], rows


def clearance(folder):
    """Increments are those at which something happens, so that lines between them are exact."""
    rows = []
    for joint, factors, loads in results(folder):
        gap = joint["fasteners"][0]["clearance"]
        force = joint["loads"][0]["force"]
        rows += [[gap, force * factor, load[0]] for factor, load in zip(factors, loads)]
        bound = gap == 0 or gap > 1
        (curve,) = plt.plot([0, *force * factors], [0, *loads[:, 0]], "--" if bound else "-",
                            label="infinite" if gap > 1 else f"{gap:g} in")
        if len(factors) > 1:
            contact = force * factors[0]
            plt.plot(contact, 0, "o", color=curve.get_color(), clip_on=False, zorder=3)
            plt.annotate(f"{contact:.0f} lb", (contact, 0), (0, 8), textcoords="offset points", ha="right", color=curve.get_color())
    plt.ylim(bottom=-8)  # the line of the infinite clearance is at 0
    plt.xlabel("external load, lb")
    plt.ylabel("load transferred by fastener 1, lb")
    plt.title("Clearance at the first fastener (Figure 25)")
    return ["clearance", "external load", "fastener 1"], rows


def friction(folder):
    """Both readings: of what passes from sheet to sheet, and of the bearing force of fastener 1."""
    cases = [(joint["fasteners"][0]["friction"], loads[-1]) for joint, _, loads in results(folder)]
    base = cases[0][1]
    rows = [[mu, *(100 * (loads / base - 1)), 100 * (loads[0] / (1 + 2 * mu / np.pi) / base[0] - 1)] for mu, loads in cases]
    for i, style in ((1, "o-"), (2, "s--"), (3, "^-")):
        plt.plot([r[0] for r in rows], [r[i] for r in rows], style, label=f"fastener {i}: transferred load, F (1 + 2 mu / pi)")
    plt.plot([r[0] for r in rows], [r[4] for r in rows], "o:", label="fastener 1: bearing force F")
    plt.axhline(0, color="0.5", linewidth=0.8)
    plt.xlabel("friction coefficient mu")
    plt.ylabel("change by friction, %")
    plt.title("Effect of friction (Figure 26), both readings")
    return ["mu", "fastener 1", "fastener 2", "fastener 3", "F of fastener 1"], rows


def main(study, folder, output):
    plt.figure(figsize=(6, 4))
    header, rows = {"stiffness": stiffness, "clearance": clearance, "friction": friction}[study](folder)
    write_csv(output + ".csv", header, rows)
    plt.legend(fontsize=9)
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(output + ".png", dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
