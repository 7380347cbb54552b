# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the stresses around hole a5 of the lower sheet for three choices of spring and directions:
choices.py AS_IT_IS FILLED HELD -o PICTURE.png, each a folder with lower.matrices.h5 and joint.h5.
"""
import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HOLE = "a5"
LABELS = ("contact, discs move along x and y", "springs all around that also pull", "contact, discs move along x alone")


def rim(folder):
    """Angles in degrees, radial and hoop stress at the last increment around the hole, and its highest peak."""
    with h5py.File(Path(folder, "lower.matrices.h5")) as matrices, h5py.File(Path(folder, "joint.h5")) as joint:
        plate = joint["plates/lower"]
        amounts = ("De", "D", "pressure/added", "Lambda", "traction/force")
        state = np.concatenate([plate[name][-1] for name in amounts if name in plate])
        i = list(matrices["rim/hole"].asstr()).index(HOLE)
        points = slice(*matrices["rim/start"][i:i + 2])
        angle = (matrices["rim/angle"][points] + 180) % 360 - 180
        order = angle.argsort()
        return (angle[order], *((matrices[f"rim/{name}"][-1, points] @ state)[order] for name in ("sigma_rr", "sigma_tt")))


def main(*words):
    *folders, option, output = words
    assert option == "-o"
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for folder, label, style in zip(folders, LABELS, ("C0-", "C3--", "C2-.")):
        angle, radial, hoop = rim(folder)
        for axis, stress in zip(axes, (radial, hoop)):
            axis.plot(angle, stress, style, label=label)
    for axis, title in zip(axes, ("radial stress: a rivet can only push (below 0)", "hoop stress: its peak starts a crack")):
        axis.set_title(f"{title}\nhole lower:{HOLE}", fontsize=10)
        axis.set_xlabel("angle from x, degrees; the rivet pushes towards 0")
        axis.set_ylabel("N/mm²")
        axis.set_xticks(range(-180, 181, 45))
        axis.axhline(0, color="0.5", linewidth=0.8)
        axis.grid(alpha=0.3)
    axes[0].axhspan(0, axes[0].get_ylim()[1], color="C3", alpha=0.08)
    axes[0].text(0, 0.5 * axes[0].get_ylim()[1], "pulls", ha="center", va="center", color="C3")
    axes[1].set_ylim(top=1.3 * axes[1].get_ylim()[1])
    axes[1].legend(fontsize=8, loc="upper center")
    figure.savefig(output, dpi=120, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
