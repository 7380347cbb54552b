# SPDX-License-Identifier: GPL-3.0-or-later
"""A joint whose discs move along x and y does not know how it lies: turned_joint_test.py BIN_FOLDER.

Two sheets with three fasteners off the line of the load, as explicit meshes, turned by several angles. Without friction
forces turn along; with friction, which acts by its components along x and y, they differ by what docs/limits.md says."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

HOLES = {"a": (50, 10), "b": (50, 32), "c": (70, 14)}
ANGLES = (0, 15, 30, 45, 90)
FRICTION = 0.2


def call(*words):
    result = subprocess.run(words, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result


def scene(name, geometry, holes, **members):
    spring = {"disk": {"E": 71000, "nu": 0.33}}
    return {"format": "plate", "version": 1, "name": name, "units": {"length": "mm", "force": "N"},
            "analysis": "plane stress", "materials": {"2024-T3": {"E": 72400, "nu": 0.33}}, "geometry": geometry,
            "holes": [{"id": hole, "center": list(at), "radius": 2.4, "spring": spring} for hole, at in holes.items()],
            "disc_directions": ["x", "y"], "p": [7, 8], **members}


def grid_mesh(name, x):
    """The mesh that stage 1 makes of a grid: nodes, quads, arcs, and the edges at its ends."""
    grid = scene(name, {"grid": {"x": x, "y": [0, 20, 40], "thickness": 1.6}}, HOLES)
    Path("grid.json").write_text(json.dumps(grid))
    call("stage1_plate", "grid.json", "-o", "grid.h5", "--quiet")
    with h5py.File("grid.h5") as f:
        mesh = {key: f[f"mesh/{key}"][:] for key in ("nodes", "quads", "arc_nodes", "arc_center")}
    sides = np.concatenate([mesh["quads"][:, [i, (i + 1) % 4]] for i in range(4)])
    at = mesh["nodes"][sides, 0]
    mesh["edges"] = {side: sides[(np.abs(at - end) < 1e-9).all(axis=1)].tolist()
                     for side, end in (("left", x[0]), ("right", x[-1]))}
    assert len(mesh["edges"]["left"]) >= 2
    return mesh


def turn(angle):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array([[c, -s], [s, c]])


def write_matrices(name, mesh, Q, **members):
    arcs = [{"edge": edge, "center": list(center)} for edge, center in zip(mesh["arc_nodes"].tolist(), mesh["arc_center"] @ Q.T)]
    geometry = {"mesh": {"nodes": (mesh["nodes"] @ Q.T).tolist(), "quads": mesh["quads"].tolist(), "arcs": arcs,
                         "thickness": 1.6, "edges": mesh["edges"]}}
    Path(f"{name}.json").write_text(json.dumps(scene(name, geometry, {h: Q @ at for h, at in HOLES.items()}, **members)))
    call("stage1_plate", f"{name}.json", "-o", f"{name}.h5", "--quiet")
    call("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5", "--quiet")


def solve(load, friction):
    """F on the second sheet, (fasteners, 2), and what the holes of the upper sheet show."""
    fasteners = [{"id": hole, "between": [f"upper:{hole}", f"lower:{hole}"], "law": "rivet", "friction": friction,
                  "clearance": 0.02 if hole == "b" else 0} for hole in HOLES]
    joint = {"format": "joint", "version": 1, "plates": {"upper": "upper.matrices.h5", "lower": "lower.matrices.h5"},
             "laws": {"rivet": {"type": "power", "A": 9000, "n": 0.8}}, "fasteners": fasteners,
             "loads": [{"external": f"upper:{id}", "force": force} for id, force in zip(("T_x", "T_y"), load)],
             "solver": {"tolerance": 1e-12}}
    Path("joint.json").write_text(json.dumps(joint))
    warning = call("stage3_nonlinear", "joint.json", "-o", "joint.h5", "--quiet").stderr
    said = re.search(r'\[friction-off-axes\]: joint\.json: .* at hole "(upper|lower):[abc]" \(increment 1; 5 other holes too\)',
                     warning)
    assert (said is not None) == (friction > 0), warning
    with h5py.File("joint.h5") as f:
        rim = f["plates/upper/rim"]
        on_upper = np.column_stack([rim["bearing_load"][-1], rim["bearing_load_y"][-1]])
        result = {"F": f["F_vector"][-1], "amount": f["F"][-1], "peak": rim["peak_hoop"][-1],
                  "bearing": rim["bearing_stress"][-1]}
        # Both components of friction together: along F, (2 / pi) mu of it.
        assert np.allclose(f["transferred"][-1, :, 0], result["amount"] * (1 + 2 / np.pi * friction), rtol=2e-3)
        assert np.allclose(on_upper, -result["F"], atol=1e-9 * result["amount"].max())
    return result


def check_turned(angle, then, now, friction):
    """Of a joint at rest and turned; what docs/limits.md says of friction off the axes."""
    largest = then["amount"].max()
    difference = np.abs(now["F"] @ turn(angle) - then["F"]).max() / largest
    if friction == 0 or angle == 90:
        assert difference < 1e-9, (angle, difference)
        for name in ("amount", "bearing"):
            assert np.allclose(now[name], then[name], rtol=1e-9), (angle, name)
        # A peak is the top of a parabola through three of 1024 points, which do not turn along.
        assert np.allclose(now["peak"], then["peak"], rtol=1e-7 if angle % 45 else 1e-9), angle
    return difference


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        upper, lower = grid_mesh("upper", [40, 60, 80, 120]), grid_mesh("lower", [0, 40, 60, 80])
        externals = [{"id": f"T_{d}", "on": "right", "direction": d, "kind": "traction"} for d in "xy"]
        at_rest = {}
        for angle in ANGLES:
            write_matrices("upper", upper, turn(angle), external=externals)
            write_matrices("lower", lower, turn(angle), supports=[{"on": "left", "fix": ["x", "y"]}])
            now = {friction: solve(turn(angle) @ [4000, 0], friction) for friction in (0, FRICTION)}
            at_rest = at_rest or now
            off = {friction: check_turned(angle, at_rest[friction], now[friction], friction) for friction in now}
            added = at_rest[FRICTION]["peak"] - at_rest[0]["peak"]
            lost = (at_rest[FRICTION]["peak"] - now[FRICTION]["peak"]) / added
            print(f"turned by {angle} deg: F differs by {off[0]:.1e}, with friction by {off[FRICTION]:.1e} of the largest; "
                  f"of what friction adds to the peaks {', '.join(f'{100 * part:.0f} %' for part in lost)} is lost")
            assert off[FRICTION] < 2e-4 and lost.max() < 0.925, "what docs/limits.md says"
            assert angle != 45 or lost.min() > 0.4, "the warning is worth its words"
        effect = np.abs(at_rest[FRICTION]["F"] - at_rest[0]["F"]).max() / at_rest[0]["amount"].max()
        print(f"friction itself changes F by {effect:.1e}")
        assert effect > 0.1
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
