# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Figure 8 of Bortman & Szabo: figure_8.py -o PICTURE.png. Links at rim nodes converge slowly, the p-version fast.

A square sheet in plane strain of half width 4 with a hole of radius 1 (upper half modelled), pulled at its right edge and held
by a pin that bears on the left half of the rim. The p-version: eight elements, distributed springs, p = 1 ... 8. The h-version:
16 to 6400 four-node elements and one radial link at each rim node, of stiffness K with K n constant or K constant. The reference
is the p-version with 256 elements at p = 8. The paper's dimensions (its Figure 6) are missing: these are chosen. The programs
are taken from PATH; the numbers are printed as CSV.
"""
import argparse

import matplotlib
import numpy as np

from polar_mesh import polar_mesh
from sheet import Sheet

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HALF_WIDTH = 4
SHEET = {"E": 1.0, "nu": 0.3}
MODULUS = 2.0  # of the distributed springs, in units of E / radius
ARC = [90, 270]
STYLES = {"p": "k^-", "r": "kD"}  # by the first letter of the model
REFERENCE = "reference: p-version, 256 elements, p = 8"
LINKS_PER_QUARTER = (2, 5, 10, 20, 40)  # 16, 100, 400, 1600 elements as in the paper, and 6400


def scene(n_layers, n_sectors, spring, p):
    radii = HALF_WIDTH ** (np.arange(n_layers) / n_layers)
    return {"analysis": "plane strain", "disc_directions": ["x"], "materials": {"sheet": SHEET},
            "geometry": polar_mesh(radii, HALF_WIDTH, np.linspace(0, 180, 2 * n_sectors + 1)),
            "holes": [{"id": "pin", "center": [0, 0], "radius": 1, "spring": {**spring, "arc": ARC}}],
            "supports": [{"on": "bottom", "fix": ["y"]}],
            "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}], "p": p}


def largest_stress(scene_at_p):
    """Unknowns and the largest hoop stress at the rim over the bearing stress P / (d t), half model."""
    sheet = Sheet(scene_at_p, {"P": 1})
    return sheet["ndof"][-1], sheet.peak("pin")


def largest_between_links(scene_at_1):
    """The same of a hole with links, between which the rim is free: by the strain in the middle of its sides."""
    sheet = Sheet(scene_at_1, field="traction:P=1")
    at, u = (sheet.field.points[name][:, :, :2] for name in ("points", "displacement"))
    strains = []
    for i, j in ((0, 1), (1, 2), (2, 3), (3, 0)):
        on_rim = np.isclose(np.hypot(*np.moveaxis(at[:, [i, j]], 2, 0)), 1).all(axis=1)
        chord, stretch = at[on_rim, j] - at[on_rim, i], u[on_rim, j] - u[on_rim, i]
        length = np.hypot(*chord.T)
        strains += list((chord * stretch).sum(axis=1) / length / (2 * np.arcsin(length / 2)))
    return sheet["ndof"][-1], SHEET["E"] / (1 - SHEET["nu"] ** 2) * max(strains)


def p_version():
    for p in range(1, 9):
        yield "p-version, 8 elements, p = 1 ... 8", *largest_stress(scene(2, 2, {"modulus": MODULUS}, [p, p]))


def h_version(model, stiffness):
    for n in LINKS_PER_QUARTER:
        yield model, *largest_between_links(scene(2 * n, n, {"links": stiffness(n)}, [1, 1]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()

    def smeared(n):
        return MODULUS * np.pi / 2 / n

    rows = [*p_version(), *h_version("links, K n constant", smeared), *h_version("links, K constant", lambda n: smeared(5)),
            (REFERENCE, *largest_stress(scene(16, 8, {"modulus": MODULUS}, [8, 8])))]
    print("model,unknowns,largest stress")
    for row in rows:
        print("\"{}\",{},{:.4f}".format(*row))
    plt.figure(figsize=(9, 4.2))
    for model in dict.fromkeys(row[0] for row in rows):
        plt.semilogx([r[1] for r in rows if r[0] == model], [r[2] for r in rows if r[0] == model],
                     STYLES.get(model[0], "o--"), label=model)
    plt.hlines(rows[-1][2], rows[0][1], rows[-1][1], "0.4", lw=1)
    plt.xlabel("unknowns")
    plt.ylabel("largest hoop stress\nover P / (radius t) of the half sheet")
    plt.title("Links at rim nodes against distributed springs (Figure 8)")
    plt.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(arguments.output, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
