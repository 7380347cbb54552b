# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the stresses around hole a5 of the lower sheet for three choices of spring and directions:
choices.py AS_IT_IS.h5 FILLED.h5 HELD.h5 -o PICTURE.png, each a RESULT.h5 of stage3_nonlinear --rim-stresses.
"""
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HOLE = "a5"
LABELS = ("contact, discs move along x and y", "springs all around that also pull", "contact, discs move along x alone")


def rim(path):
    """Angles in degrees, radial and hoop stress at the last increment around the hole."""
    with h5py.File(path) as joint:
        around = joint["plates/lower/rim"]
        if "start" not in around:
            sys.exit(f"choices.py: error: {path}: has no stresses around holes; make it with stage3_nonlinear --rim-stresses")
        i = list(around["hole"].asstr()).index(HOLE)
        points = slice(*around["start"][i:i + 2])
        angle = (around["angle"][points] + 180) % 360 - 180
        order = angle.argsort()
        return angle[order], *(around[f"sigma_{kind}"][-1, points][order] for kind in ("rr", "tt"))


def main(*words):
    *results, option, output = words
    assert option == "-o"
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
    for path, label, style in zip(results, LABELS, ("C0-", "C3--", "C2-.")):
        angle, radial, hoop = rim(path)
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
