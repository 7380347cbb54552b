#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the joint's convexity asks of a sheet's rims in contact (docs/theory.md, 6.2 to 6.4), over random sheets with soft and stiff pins.

Usage: rim_compliance_test.py FOLDER_OF_PROGRAMS [sweep]

The compliance C of unit pressures and what it leaves of that of the springs, A/K - C, have no negative eigenvalue. Prints the smallest ones,
and what thinning C would do to them: couplings of orders j and k of which one is above 2 are left out where (a/d)^(j + k - 2) is below a
tolerance, d the distance of the holes. The sweep takes 60 sheets instead of 12."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS, SWEEP = Path(sys.argv[1]).resolve(), "sweep" in sys.argv[2:]
ROUNDING = 1e-10  # of the springs' compliance
TOLERANCES = (1e-10, 1e-8, 1e-6, 1e-4)


def random_sheet(random, stiffness):
    """PLATE.json of a panel of up to 3 x 3 pins, whose springs are `stiffness` times E / a."""
    nx, ny = random.integers(1, 4, 2)
    E, cells = 70e3, [np.concatenate(([0], np.cumsum(random.uniform(3, 9, n)))) for n in (nx, ny)]
    metal = {"E": E, "nu": random.uniform(0, 0.4)}
    laminate = {"E1": 2 * E, "E2": 2 * E / random.uniform(1, 14), "nu12": 0.3, "G12": 5e3, "angle": random.uniform(0, 90)}
    spring = {"modulus": stiffness * E, "compression_only": True}
    holes = [{"id": f"{i},{j}", "center": [cells[0][i:i + 2].mean(), cells[1][j:j + 2].mean()], "radius": 1, "spring": spring}
             for i in range(nx) for j in range(ny)]
    return {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": laminate if random.random() < 0.4 else metal},
            "geometry": {"grid": {"x": list(cells[0]), "y": list(cells[1]), "thickness": 1}}, "holes": holes, "p": [7, 8],
            "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}


def compliance(folder, sheet):
    """C over A, (n, n) means, of the springs K C / A of order 1 and less; order and place of each row."""
    (folder / "plate.json").write_text(json.dumps(sheet))
    for program, source, target in (("stage1_plate", "plate.json", "plate.h5"), ("stage2_extract", "plate.h5", "matrices.h5")):
        subprocess.run([PROGRAMS / program, source, "-o", target, "--quiet"], cwd=folder, check=True, capture_output=True)
    place = {hole["id"]: hole["center"] for hole in sheet["holes"]}
    with h5py.File(folder / "matrices.h5") as file:
        W, area, K = file["W"][-1], file["wave/area"][:], file["wave/modulus"][:]
        column = len(file["disc/hole"]) + len(file["external/id"])
        rows, order, at = [], [], []
        first = 0
        for hole, highest in zip(file["wave/hole"].asstr()[:], file["wave/order"][:]):
            n = 2 * highest + 1
            rows += range(first, first + n)
            order += [(k + 1) // 2 for k in range(n)]
            at += [place[hole]] * n
            first += 2 * n
    C = -W[rows][:, [column + row for row in rows]] * K[0] / area[0]
    return (C + C.T) / 2, np.array(order), np.array(at)


def thinned(C, order, at, tolerance):
    distance = np.hypot(*(at[:, None] - at[None]).transpose(2, 0, 1))
    with np.errstate(divide="ignore"):
        fall = np.where(distance > 0, (1 / np.maximum(distance, 1))**(order[:, None] + order[None] - 2.0), 1)
    left = (fall < tolerance) & ((order[:, None] > 2) | (order[None] > 2))
    return np.where(left, 0, C), left.mean()


def least(C):
    """Smallest eigenvalues of K C / A and of 1 - K C / A."""
    values = np.linalg.eigvalsh(C)
    return values[0], 1 - values[-1]


def main():
    random, worst, cut = np.random.default_rng(6), {}, {}
    with tempfile.TemporaryDirectory() as name:
        for i in range(60 if SWEEP else 12):
            stiffness = 10**random.uniform(-2, 4)
            C, order, at = compliance(Path(name), random_sheet(random, stiffness))
            for tolerance in (0, *TOLERANCES):
                changed, share = thinned(C, order, at, tolerance) if tolerance else (C, 0)
                values = least(changed)
                worst[tolerance] = np.minimum(worst.get(tolerance, values), values)
                cut[tolerance] = max(cut.get(tolerance, 0), share)
            assert min(least(C)) > -ROUNDING, f"sheet {i}, K a / E = {stiffness:.3g}: {least(C)}"
    print("thinned at | most of C left out | least eigenvalue of K C / A | of 1 - K C / A")
    for tolerance, (low, rest) in worst.items():
        print(f"{tolerance:g} | {cut[tolerance]:.0%} | {low:.2e} | {rest:.2e}")


main()
