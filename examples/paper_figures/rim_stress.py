# SPDX-License-Identifier: GPL-3.0-or-later
"""Charts four ways to the hoop stress around a hole against unknowns: rim_stress.py -o CHART.png, rim_stress_methods on PATH."""
import argparse
import csv
import subprocess

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

METHODS = {"plain": "o--", "known tractions": "s-", "patch recovery": "^:", "harmonics": "d-."}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    printed = subprocess.run(["rim_stress_methods"], check=True, capture_output=True, text=True).stdout
    rows = list(csv.DictReader(printed.splitlines()))
    panels = list(dict.fromkeys((row["material"], row["rings"]) for row in rows))
    figure, axes = plt.subplots(1, len(panels), sharey=True, figsize=(3.4 * len(panels), 3.8))
    for axis, panel in zip(axes, panels):
        these = [row for row in rows if (row["material"], row["rings"]) == panel]
        for method, style in METHODS.items():
            axis.loglog([int(r["unknowns"]) for r in these], [float(r[method]) for r in these], style, ms=4, label=method)
        axis.set_title("{}, rings: {}".format(*panel), fontsize=10)
        axis.set_xlabel("unknowns, p = 1 ... 8")
        axis.grid(alpha=0.3, which="both")
    axes[0].set_ylabel("largest error of the hoop stress / peak")
    axes[0].legend()
    figure.suptitle("Open hole in a strip, d/W = 0.5")
    figure.tight_layout()
    figure.savefig(arguments.output, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
