# SPDX-License-Identifier: GPL-3.0-or-later
"""Collects one study into a CSV and draws it as the paper's Figure 24, 25 or 26: figures.py STUDY FOLDER OUTPUT."""
import csv
import json
import sys
from pathlib import Path

import h5py
import matplotlib

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
    rows = []
    for joint, factors, loads in results(folder):
        gap = joint["fasteners"][0]["clearance"]
        force = joint["loads"][0]["force"]
        rows += [[gap, force * factor, load[0]] for factor, load in zip(factors, loads)]
        bound = gap == 0 or gap > 1
        plt.plot([0, *force * factors], [0, *loads[:, 0]], "--" if bound else "o-",
                 label="infinite" if gap > 1 else f"{gap:g} in")
    plt.xlabel("external load, lb")
    plt.ylabel("load transferred by fastener 1, lb")
    plt.title("Clearance at the first fastener (Figure 25)")
    return ["clearance", "external load", "fastener 1"], rows


def friction(folder):
    cases = [(joint["fasteners"][0]["friction"], loads[-1]) for joint, _, loads in results(folder)]
    base = cases[0][1]
    rows = [[mu, *(100 * (loads / base - 1))] for mu, loads in cases]
    for i in (1, 2, 3):
        plt.plot([r[0] for r in rows], [r[i] for r in rows], "o-", label=f"fastener {i}")
    plt.xlabel("friction coefficient")
    plt.ylabel("rise of the transferred load, %")
    plt.title("Effect of friction (Figure 26)")
    return ["mu", "fastener 1", "fastener 2", "fastener 3"], rows


def main(study, folder, output):
    plt.figure(figsize=(6, 4))
    header, rows = {"stiffness": stiffness, "clearance": clearance, "friction": friction}[study](folder)
    write_csv(output + ".csv", header, rows)
    plt.legend()
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(output + ".png", dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
