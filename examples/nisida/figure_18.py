# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Figure 18 of Bortman & Szabo: figure_18.py MATRICES.h5 RESULT.h5 ... -o PICTURE.png. Stresses around the pin of examples/nisida.

The sheet is `sheet` in each joint, made with --rim-stresses. It has one hole, half of it in the model, and is pulled along +x, so that the pin
bears at 180 degrees, the middle of the contact. The angle runs from there; stresses are over the bearing stress P / (d t). Prints the contact's
numbers as CSV. With friction the hoop stress is logarithmically singular where the friction jumps, in the middle of the contact: no point is drawn there.
"""
import argparse
import json

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read(sheet, path):
    """Angle from the middle of the contact, sigma_rr and sigma_tt over P / (d t), and the contact's numbers."""
    with h5py.File(path) as joint:
        plate = joint["plates/sheet"]
        bearing = plate["traction/force"][-1, 0] / sheet["rim/bearing_area"][0, 0]
        friction = json.loads(joint["input"].asstr()[()])["fasteners"][0].get("friction", 0)
        away = 180 - plate["rim/angle"][:]
        smooth = (away > 1) | (friction == 0)
        radial, hoop = (plate[f"rim/sigma_{kind}"][-1, smooth] / bearing for kind in ("rr", "tt"))
        pressure, largest = (plate[name][-1, 0] / bearing for name in ("contact/peak_pressure", "rim/peak_hoop"))
        return joint.attrs["name"], away[smooth], radial, hoop, (plate["contact/touching"][-1, 0], pressure, largest)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("sheet", metavar="MATRICES.h5")
    parser.add_argument("joints", nargs="+", metavar="RESULT.h5")
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    print("sheet,contact half-angle,peak pressure,largest hoop stress")
    with h5py.File(arguments.sheet) as sheet:
        for path in arguments.joints:
            name, away, radial, hoop, (half_angle, pressure, largest) = read(sheet, path)
            print(f"\"{name}\",{half_angle:.2f},{pressure:.4f},{largest:.4f}")
            axes[0].plot(away, radial, label=name)
            axes[1].plot(away, hoop, label=name)
    for axis, kind in zip(axes, ("radial", "hoop")):
        axis.set_xlabel("degrees from the middle of the contact")
        axis.set_ylabel(f"{kind} stress / (P / (d t))")
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    figure.suptitle("Pin-loaded sheet of Nisida (Figure 18)")
    figure.tight_layout()
    figure.savefig(arguments.output, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
