# SPDX-License-Identifier: GPL-3.0-or-later
"""Loads on part of a rim, or on one of several thicknesses, have a resultant across their direction: sheets that only
fasteners hold balance along both axes. Arguments: folder of the programs."""
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()
MU, FORCE = 0.3, 1000.0


def sheet(external):
    """A square of 6 x 6 in a fan of eight elements around a hole of radius 1, thinner towards -x and -y."""
    corners = [(3, 0), (3, 3), (0, 3), (-3, 3), (-3, 0), (-3, -3), (0, -3), (3, -3)]
    nodes = [(math.cos(k * math.pi / 4), math.sin(k * math.pi / 4)) for k in range(8)] + corners
    quads = [[k, 8 + k, 8 + (k + 1) % 8, (k + 1) % 8] for k in range(8)]
    middles = [[sum(nodes[n][axis] for n in quad) / 4 for axis in (0, 1)] for quad in quads]
    return {"format": "plate", "version": 1, "analysis": "plane stress", "p": [3, 4],
            "materials": {"a": {"E": 70000, "nu": 0.3}},
            "geometry": {"mesh": {"nodes": nodes, "quads": quads,
                                  "arcs": [{"edge": [k, (k + 1) % 8], "center": [0, 0]} for k in range(8)],
                                  "thickness": [1 + 0.05 * x + 0.02 * y for x, y in middles],
                                  "edges": {"right": [[15, 8], [8, 9]], "top": [[9, 10], [10, 11]]}}},
            "holes": [{"id": "h", "center": [0, 0], "radius": 1, "spring": {"disk": {"E": 70000, "nu": 0.3}}}],
            "external": external}


def notched():
    """A sheet with an open half hole in its top edge, which a cosine pressure loads along x and pushes down."""
    spring = {"disk": {"E": 70000, "nu": 0.3}}
    return {"format": "plate", "version": 1, "analysis": "plane stress", "p": [3, 4],
            "materials": {"a": {"E": 70000, "nu": 0.3}},
            "geometry": {"grid": {"x": [0, 15, 25, 40], "y": [0, 20], "thickness": 1}},
            "holes": [{"id": "a", "center": [7, 10], "radius": 2, "spring": spring},
                      {"id": "open", "center": [20, 20], "radius": 3},
                      {"id": "b", "center": [32, 10], "radius": 2, "spring": spring}],
            "external": [{"id": "P", "on": "open", "direction": "x", "kind": "bearing"}]}


def run(folder, program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments, "--quiet"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def solve(folder, plate, holes, loads, friction):
    """Datasets of MATRICES.h5, by name, forces F and their resultants on the discs, of a sheet that the ground holds."""
    (folder / "s.json").write_text(json.dumps(plate))
    run(folder, "stage1_plate", "s.json", "-o", "s.plate.h5")
    run(folder, "stage2_extract", "s.plate.h5", "-o", "s.h5")
    (folder / "joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"s": "s.h5"}, "laws": {"l": {"type": "linear", "k": 1e5}},
        "fasteners": [{"id": id, "between": [f"s:{id}", "ground"], "law": "l", "friction": friction} for id in holes],
        "loads": [{"external": f"s:{id}", "force": force} for id, force in loads.items()], "increments": 1}))
    run(folder, "stage3_nonlinear", "joint.json", "-o", "joint.h5")
    with h5py.File(folder / "s.h5") as f:
        matrices = {name: f[name][:] for name in ("friction/unit_force", "friction/resultant",
                                                  "friction/resultant_across", "traction/resultant_across")}
        matrices["side"] = list(f["friction/bearing"].asstr())
    with h5py.File(folder / "joint.h5") as f:
        return (matrices, f["F_vector"][-1],
                *(f[f"plates/s/disc/{kind}"][-1].reshape(-1, 2) for kind in ("bearing", "friction")))


def main():
    external = [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                {"id": "Q", "on": "top", "direction": "y", "kind": "traction"}]
    with tempfile.TemporaryDirectory() as name:
        its, F, bearing, friction = solve(Path(name), sheet(external), ["h"], {"P": FORCE, "Q": FORCE / 4}, MU)
    print(f"several thicknesses: F {F}, on the rim: bearing {bearing}, friction {friction}")
    assert np.abs(bearing + friction + [FORCE, FORCE / 4]).max() < 1e-9 * FORCE
    along, across = (MU * its[name] / its["friction/unit_force"]
                     for name in ("friction/resultant", "friction/resultant_across"))
    of_x, of_y = (its["side"].index(name) for name in ("-x", "-y"))  # where both components bear on the sheet
    expected = [F[0, 0] * along[of_x] + F[0, 1] * across[of_y], F[0, 1] * along[of_y] + F[0, 0] * across[of_x]]
    assert np.abs(friction[0] - expected).max() < 1e-9 * FORCE, (friction, expected)
    assert min(abs(across[of_x]), abs(across[of_y])) > 1e-3, across

    with tempfile.TemporaryDirectory() as name:
        its, F, bearing, friction = solve(Path(name), notched(), ["a", "b"], {"P": FORCE}, 0)
    down = -2 / math.pi  # int cos sin / int cos^2 over the quarter that bears
    print(f"half of a rim: F {F}, of the load {its['traction/resultant_across']}")
    assert abs(its["traction/resultant_across"][0] - down) < 1e-12
    assert np.abs(bearing.sum(axis=0) + [FORCE, FORCE * down]).max() < 1e-9 * FORCE, bearing


main()
