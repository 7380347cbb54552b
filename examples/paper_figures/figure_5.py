# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws Figure 5 of Bortman & Szabo: figure_5.py -o PICTURE.png. Line springs at mesh nodes do not converge.

A sheet of 8 x 4 (upper half modelled), held by two springs of one stiffness on its line of symmetry at x = 2 and x = 6 and pulled
at its right edge; the paper's meshes of 16 to 1600 four-node elements, graded towards the second spring by Q = size of the
element next to it / remote size. The paper's dimensions (its Figure 3) are missing: these are chosen. Beside it the same sheet
with holes and distributed springs. The programs are taken from PATH; the numbers are printed as CSV.
"""
import argparse

import matplotlib
import numpy as np

from sheet import Sheet

matplotlib.use("Agg")
import matplotlib.pyplot as plt

STIFFNESS = 1e6  # of each half spring; E t of the sheet
MATERIAL = {"sheet": {"E": 1e7, "nu": 0.3}}
THICKNESS = 0.1
SPRINGS = {"1": 2, "2": 6}  # x of each
MESHES = (1, 2.5, 5, 10)  # elements per unit of length: 8 x 2, 20 x 5, 40 x 10, 80 x 20
# Sizes next to the springs and next to the line of symmetry, over the remote size.
GRADINGS = {"Q = 1": (1, 1, 1), "Q = 0.5": (1, 0.5, 0.5), "Q = 0.1": (1, 0.1, 0.1), "Q1 = 0.01, Q2 = 10": (0.01, 10, 1)}


def graded(start, end, n, first, last):
    """n intervals from start to end whose sizes go from `first` to `last` in geometric progression."""
    sizes = np.geomspace(first, last, n)
    return start + (end - start) * np.concatenate([[0], np.cumsum(sizes)]) / sizes.sum()


def rectangle(density, q1, q2, qy):
    lines = [graded(0, 2, round(2 * density), 1, q1), graded(2, 6, round(4 * density), q1, q2)[1:],
             graded(6, 8, round(2 * density), q2, 1)[1:]]
    x, y = np.concatenate(lines), graded(0, 2, round(2 * density), qy, 1)
    nx = len(x)
    quads = [[j * nx + i, j * nx + i + 1, (j + 1) * nx + i + 1, (j + 1) * nx + i]
             for j in range(len(y) - 1) for i in range(nx - 1)]
    edges = {"bottom": [[i, i + 1] for i in range(nx - 1)],
             "right": [[j * nx + nx - 1, (j + 1) * nx + nx - 1] for j in range(len(y) - 1)]}
    return {"mesh": {"nodes": [[a, b] for b in y.tolist() for a in x.tolist()], "quads": quads, "thickness": THICKNESS,
                     "edges": edges}}


def scene(geometry, **more):
    return {"analysis": "plane stress", "disc_directions": ["x"], "materials": MATERIAL, "geometry": geometry,
            "supports": [{"on": "bottom", "fix": ["y"]}],
            "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}], **more}


def ratio(sheet, level=-1):
    """F2 / F1 while both springs are held at their other ends."""
    return sheet["T_d"][level, 1, 0] / sheet["T_d"][level, 0, 0]


def line_springs():
    """Grading, unknowns, F2/F1."""
    points = [{"id": name, "at": [x, 0], "stiffness": STIFFNESS} for name, x in SPRINGS.items()]
    for grading, (q1, q2, qy) in GRADINGS.items():
        for density in MESHES:
            sheet = Sheet(scene(rectangle(density, q1, q2, qy), points=points, p=[1, 1]))
            yield grading, sheet["ndof"][0], ratio(sheet)


def distributed_springs():
    """Holes of radius 0.25 whose distributed springs together have the same stiffness: k t r pi / 2 of the half hole."""
    radius = 0.25
    modulus = STIFFNESS / (THICKNESS * radius * np.pi / 2)
    holes = [{"id": name, "center": [x, 0], "radius": radius, "spring": {"modulus": modulus}, "rings": 1}
             for name, x in SPRINGS.items()]
    grid = {"grid": {"x": [0, 1, 3, 5, 7, 8], "y": [0, 1, 2], "thickness": THICKNESS}}
    sheet = Sheet(scene(grid, holes=holes, p=[1, 8]))
    for level, unknowns in enumerate(sheet["ndof"]):
        yield "distributed springs, p = 1 ... 8", unknowns, ratio(sheet, level)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", required=True)
    arguments = parser.parse_args()
    rows = [*line_springs(), *distributed_springs()]
    print("model,unknowns,F2/F1")
    for row in rows:
        print("\"{}\",{},{:.4f}".format(*row))
    plt.figure(figsize=(8.5, 4))
    for model in dict.fromkeys(row[0] for row in rows):
        style = "k^-" if "distributed" in model else "o--"
        plt.semilogx([r[1] for r in rows if r[0] == model], [r[2] for r in rows if r[0] == model], style, label=model)
    plt.xlabel("unknowns")
    plt.ylabel("F2 / F1")
    plt.title("Line springs at mesh nodes (Figure 5)")
    plt.legend(fontsize=8, loc="center left", bbox_to_anchor=(1, 0.5))
    plt.grid(alpha=0.3)
    plt.tight_layout()
    plt.savefig(arguments.output, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
