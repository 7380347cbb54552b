# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads of the bolts and K of the crack by its length: figure_crack.py RESULT.h5... -o PICTURE.png"""
import argparse

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+")
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    rows = []
    for path in arguments.results:
        with h5py.File(path) as file:
            crack = file["plates/upper/crack"]
            rows.append([crack["length"][0], crack["K_I"][-1, 0], crack["K_I_error"][-1, 0], *np.abs(file["transferred"][-1, :, 0])])
            bolts = list(file["fastener/id"].asstr())
    c, K, error, *loads = np.array(sorted(rows)).T
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    for bolt, load in zip(bolts, loads):
        left.plot(c, load, "o-", markersize=4, label=f"bolt {bolt}{', at the crack' if bolt == bolts[-1] else ''}")
    left.set(xlabel="length of the crack, mm", ylabel="load of the bolt, N", ylim=(0, None))
    left.legend(frameon=False, fontsize=8)
    right.errorbar(c, K, yerr=error, fmt="ko-", markersize=4, capsize=2)
    right.set(xlabel="length of the crack, mm", ylabel="K_I, N/mm^1.5", ylim=(0, None))
    for axis in (left, right):
        axis.spines[["top", "right"]].set_visible(False)
    figure.savefig(arguments.output, dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    main()
