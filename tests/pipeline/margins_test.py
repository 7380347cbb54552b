#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Margins against hand calculations, over cases, edge distances read from outlines, and what is refused.

Usage: margins_test.py FOLDER_OF_PROGRAMS"""
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from one_hole import PROGRAMS, end_if_missed, matrices, near  # noqa: E402

D, T = 4.8, 1.6  # diameter and thickness
P = 1000.0
TABLE = [[1.5, 680], [2.0, 860]]


def sheet(x, y, **more):
    return {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"}, "analysis": "plane stress", "p": [5, 6],
            "materials": {"m": {"E": 72e3, "nu": 0.3}}, "geometry": {"grid": {"x": x, "y": y, "thickness": T}},
            "holes": [{"id": "1", "center": [0, 0], "radius": D / 2, "spring": {"compression_only": True, "disk": {"E": 2e5, "nu": 0.3}}}], **more}


def lap(folder, edge, side=12):
    """Two sheets with one rivet: one held on its left, the other pulled to the right and free to go along y only with the first."""
    matrices(folder, sheet([-40, -20, edge], [-side, side], supports=[{"on": "left", "fix": ["x", "y"]}]), "a")
    matrices(folder, sheet([-edge, 20, 40], [-side, side], external=[{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                                               {"id": "Q", "on": "right", "direction": "y", "kind": "rigid"}]), "b")


def solve(folder, checks, *words, cases=None, status=0, **factors):
    joint = {"format": "joint", "version": 1, "name": "lap, one rivet", "plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"rivet": {"type": "linear", "k": 3e4}},
             "fasteners": [{"id": "7", "between": ["a:1", "b:1"], "law": "rivet"}], "margins": {"checks": checks, **factors},
             "cases": cases or [{"name": "pull", "loads": [{"external": "b:P", "force": P}]}]}
    (folder / "joint.json").write_text(json.dumps(joint))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "out.h5", "--margins", "margins.csv", *words], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == status, (done.stdout, done.stderr)
    if status:
        return done
    with h5py.File(folder / "out.h5") as file, open(folder / "margins.csv") as table:
        rows = list(csv.DictReader(table))
        if not rows:
            assert not len(file.get("margin/margin", []))
            return done, {}, {}
        assert [float(row["margin"]) for row in rows] == list(file["margin/margin"][:])
        assert (np.diff(file["margin/margin"][:]) > -1e-8).all() or len(rows) == 1 or np.isinf(file["margin/margin"][:]).any()
        return done, {(row["check"], row["of"]): row for row in rows}, {name: item[:] for name, item in file["plates/a/rim"].items()}


def by_hand(folder):
    """P = 1000 N, FS 1.5, FF 1.15, d = 4.8, t = 1.6, e/D = 1.8, F_bru 680 at 1.5 and 860 at 2.0; F_su 262."""
    lap(folder, 1.8 * D)
    checks = [{"check": "bearing", "F_br": TABLE}, {"check": "fastener shear", "F_su": 262}, {"check": "tension", "F_tu": 420},
              {"check": "shear-out", "F_su": 260}, {"check": "peak", "of": ["a"], "limit": 900},
              {"check": "bearing-bypass", "of": ["a:1"], "polygon": [[-300, 0], [-100, 500], [100, 500], [300, 0], [0, -1]]},
              {"check": "fastener shear", "name": "by force, no factors", "P_su": 3000, "safety_factor": 1, "fitting_factor": 1}]
    done, found, rim = solve(folder, checks, safety_factor=1.5, fitting_factor=1.15)
    margin = {key: float(row["margin"]) for key, row in found.items()}
    near("bearing", margin["bearing", "a:1"], 2.508313, 1e-6)
    near("bearing of the other sheet", margin["bearing", "b:1"], 2.508313, 1e-6)
    near("fastener shear", margin["fastener shear", "7"], 1.748429, 1e-6)
    near("shear, by force", margin["by force, no factors", "7"], 2, 1e-9)
    near("shear-out", margin["shear-out", "a:1"], 2 * 260 * T * (1.8 * D - D / 2 * np.cos(np.radians(40))) / (1.725 * P) - 1, 1e-9)
    near("tension", margin["tension", "a:1"], 420 / (1.725 * P / (T * (24 - D))) - 1, 5e-3)
    near("net stress", rim["net_stress"][0, 0], P / (T * (24 - D)), 5e-3)  # forces of sections are resultants of stresses at p = 6
    near("peak", margin["peak", "a:1"], 900 / (1.725 * rim["peak_hoop"][0, 0]) - 1, 1e-12)
    near("bearing-bypass without bypass", margin["bearing-bypass", "a:1"], 500 / (1.725 * P / (D * T)) - 1, 1e-4)
    assert "F_br = 788, d t = 7.68, e/D = 1.8, FS = 1.5, FF = 1.15" in done.stdout and "edge-distance" not in done.stderr, done
    assert done.stdout.index("fastener shear") < done.stdout.index("  bearing  "), "the smallest come first"
    assert found["bearing", "a:1"]["joint"] == "lap, one rivet" and found["bearing", "a:1"]["case"] == "pull"


def cases(folder):
    """The load turns: towards the edge e = 1.2 D, away from it there is none, since the sheet goes on at its support; across it the side."""
    lap(folder, 1.2 * D)
    loads = [{"name": "pull", "loads": [{"external": "b:P", "force": P}], "increments": 2}, {"name": "push", "loads": [{"external": "b:P", "force": -1.2 * P}]},
             {"name": "up", "loads": [{"external": "b:Q", "force": 0.5 * P}]}, {"name": "rest", "loads": []}]
    done, found, _ = solve(folder, [{"check": "bearing", "F_br": TABLE}], cases=loads)
    row = found["bearing", "a:1"]
    near("e/D = 1.2: margin", float(row["margin"]), 680 * 0.7 * D * T / P - 1, 1e-6)
    assert (row["case"], row["increment"]) == ("pull", "2") and "e/D = 1.2" in row["inputs"], row
    assert "warning [edge-distance-small]: joint.json: " in done.stderr and \
        ":1 is 1.2 diameters from the edge along its load (the worst of 2 margins)" in done.stderr, done.stderr
    assert "of all cases alike" in done.stdout
    ultimate = {"check": "bearing", "name": "ultimate", "F_br": TABLE, "cases": ["push", "rest"]}
    done, found, _ = solve(folder, [ultimate, {"check": "bearing", "F_br": TABLE, "safety_factor": 1.5}], cases=loads)
    near("ultimate loads of one case: margin", float(found["ultimate", "a:1"]["margin"]), 860 * D * T / (1.2 * P) - 1, 1e-6)
    near("with a factor, of all cases", float(found["bearing", "a:1"]["margin"]), 680 * 0.7 * D * T / (1.5 * P) - 1, 1e-6)
    assert found["ultimate", "a:1"]["case"] == "push" and 'of all cases for checks without "cases"' in done.stdout
    done, found, _ = solve(folder, [ultimate], "--case", "pull", cases=loads)
    assert not found and 'check "ultimate" is not made for a:1, b:1: none of its cases was solved' in done.stderr, done.stderr
    done, found, _ = solve(folder, [{"check": "bearing", "F_br": TABLE}], "--case", "push", cases=loads)
    near("push: margin", float(found["bearing", "a:1"]["margin"]), 860 * D * T / (1.2 * P) - 1, 1e-6)
    done, found, _ = solve(folder, [{"check": "bearing", "F_br": TABLE}], "--case", "up", cases=loads)
    assert "e/D = 2.5" in found["bearing", "a:1"]["inputs"], found
    done, found, _ = solve(folder, [{"check": "bearing", "F_br": TABLE}], "--case", "rest", cases=loads)
    assert found["bearing", "a:1"]["margin"] == "inf" and "no load" in done.stdout


def strips(folder):
    """A cut-out that fills its strip between cell lines amid the sheet has no net section; one that fills as much of a strip as wide as the sheet has."""
    for name, x, y, known in (("wide", [-60, -12, 12, 60], [-60, -12, 12, 60], False), ("specimen", [-60, -12, 12, 60], [-12, 12], True), ("half", [-60, -12, 12, 60], [0, 12], True)):
        wide = sheet(x, y, supports=[{"on": "left", "fix": ["x", "y"]}, *([{"on": "bottom", "fix": ["y"]}] if y[0] == 0 else [])],
                     external=[{"id": "P", "on": "right", "direction": "x", "kind": "traction"}], points=[{"id": "k", "at": [x[-1], y[-1]], "stiffness": 1}])
        matrices(folder, wide | {"holes": [{"id": "cut", "center": [0, 0], "radius": 8}]}, name)
        joint = {"format": "joint", "version": 1, "plates": {"a": f"{name}.h5"}, "laws": {"hold": {"type": "linear", "k": 1e-3}},
                 "fasteners": [{"id": "k", "between": ["a:k", "ground"], "law": "hold"}], "loads": [{"external": "a:P", "force": P}],
                 "margins": {"checks": [{"check": "tension", "F_tu": 420}]}}
        (folder / "joint.json").write_text(json.dumps(joint))
        done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "out.h5"], cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0 and ("a:cut: it fills most of the strip between cell lines" in done.stderr) != known, done
        with h5py.File(folder / "out.h5") as file:
            net, concentration = (file[f"plates/a/rim/{key}"][0, 0] for key in ("net_stress", "net_concentration"))
            assert len(file.get("margin/margin", [])) == known and (concentration > 1) == known and np.isfinite(net) == known, (name, net, concentration)
        if known:
            near("net stress of a specimen", net, P / (T * (y[-1] - y[0]) / 3), 0.02)


def outlines(folder):
    """A mesh's outline with an arc and a crack: straight pieces are joined, faces of cracks and holes are left out."""
    lap(folder, 9.0)
    with h5py.File(folder / "a.h5") as file:
        ends, free = file["border/ends"][:], file["border/free"][:]
        assert len(ends) == 4 and free.sum() == 3 and np.ptp(ends[:, [0, 2]]) == 49 and (ends[free == 0][:, [0, 2]] == -40).all(), (ends, free)
    matrices(folder, sheet([-20, 9], [-12, 12], supports=[{"on": "left", "fix": ["x", "y"]}], cracks=[{"from": "hole:1", "angle": 90, "length": 2}]), "c")
    with h5py.File(folder / "c.h5") as file:
        assert len(file["border/free"]) == 4
    matrices(folder, json.loads((ROOT / "tests/schemas/good/plate_mesh.json").read_text()) | {"p": [2, 3]}, "mesh")
    with h5py.File(folder / "mesh.h5") as file:
        ends = file["border/ends"][:]
    points = ends.reshape(-1, 2)
    meeting = [np.sum(np.hypot(*(points - point).T) < 1e-6 * np.ptp(points)) for point in points]
    assert len(ends) == 4 and sorted(meeting) == [1, 1, 2, 2, 2, 2, 2, 2], ("closed but for the quarter of a hole", ends)


def refusals(folder):
    lap(folder, 9.0)
    for check, message in (({"check": "bearing", "F_br": 500, "of": ["c"]}, '/margins/checks/0: "c" is no plate and no hole with stresses; allowed: a, a:1, b, b:1'),
                           ({"check": "fastener shear", "F_su": 1, "of": ["9"]}, '/margins/checks/0: fastener "9" does not exist'),
                           ({"check": "bearing", "F_br": [[2, 500], [1.5, 400]]}, "an e/D that does not rise"),
                           ({"check": "tension", "F_tu": 500, "cases": ["lift"]}, '/margins/checks/0/cases/0: "lift"'),
                           ({"check": "tension", "F_tu": 500, "limit": 3}, "/margins/checks/0/limit: unknown key"),
                           ({"check": "fastener shear", "F_su": 1, "P_su": 1}, 'given together with "F_su"'),
                           ({"check": "bearing-bypass", "polygon": [[100, 100], [200, 100], [200, 200]]}, "does not go once around the origin"),
                           ({"check": "bearing-bypass", "polygon": [[300, 0], [20, 20], [0, 300], [-300, -300], [-200, 300], [300, -10]]}, "does not go once around"),
                           ({"check": "bearing", "F_br": [[0.4, 100], [2, 500]]}, "e/D = 0.4")):
        done = solve(folder, [check], status=2)
        assert message in done.stderr and not (folder / "margins.csv").exists(), (message, done.stderr)


def rows(folder, half):
    """Two sheets with two bolts one after another, long cells on narrow strips, whole or their upper half: margins by check and item."""
    y = [0, 10] if half else [-10, 10]
    symmetry = [{"on": "bottom", "fix": ["y"]}] if half else []
    holes = [{"id": str(i), "center": [20 + 60 * i, 0], "radius": 3, "spring": {"compression_only": True, "disk": {"E": 1.1e5, "nu": 0.3}}} for i in (0, 1)]
    for name, x, more in (("a", [0, 50, 110, 150], {"external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}], "supports": symmetry}),
                          ("b", [-40, 0, 50, 110], {"supports": [*symmetry, {"on": "left", "fix": ["x", "y"]}]})):
        scene = sheet(x, y) | {"holes": holes, "disc_directions": ["x", "y"]} | more
        matrices(folder, scene, name)
    checks = [{"check": "bearing", "F_br": TABLE}, {"check": "fastener shear", "F_su": 262}, {"check": "fastener shear", "name": "by force", "P_su": 3000},
              {"check": "tension", "F_tu": 420}, {"check": "shear-out", "F_su": 260}, {"check": "peak", "limit": 900},
              {"check": "bearing-bypass", "polygon": [[-300, -10], [350, -10], [350, 200], [100, 900], [-300, 500]]}]
    joint = {"format": "joint", "version": 1, "plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"bolt": {"type": "linear", "k": 4e4 if half else 8e4}},
             "fasteners": [{"id": i, "between": [f"a:{i}", f"b:{i}"], "law": "bolt"} for i in "01"],
             "loads": [{"external": "a:P", "force": 2000 if half else 4000}], "margins": {"checks": checks}}
    (folder / "joint.json").write_text(json.dumps(joint))
    subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "out.h5", "--margins", "margins.csv", "--quiet"], cwd=folder, check=True)
    with h5py.File(folder / "out.h5") as file, open(folder / "margins.csv") as table:
        rim = file["plates/a/rim"]
        return {(row["check"], row["of"]): row for row in csv.DictReader(table)}, rim["bypass_load"][0] / rim["gross_area"][0], rim["gross_area"][0]


def halves(folder):
    """The half of a joint has the margins of the whole; bypass stress is over the strip's own section, not over the length of its cell."""
    whole, bypass, gross = rows(folder, False)
    half, *_ = rows(folder, True)
    assert np.allclose(gross, 20 * T, rtol=1e-12), gross
    assert f"bypass {bypass[1]:g}, " in whole["bearing-bypass", "a:1"]["inputs"] and abs(bypass[1] - 2000 / (20 * T)) < 1, (bypass, whole["bearing-bypass", "a:1"])
    assert list(whole) and set(whole) == set(half) and len(whole) == 4 * 5 + 2 * 2
    for key, row in whole.items():
        near(f"half of the joint, {key}", float(half[key]["margin"]), float(row["margin"]), 1e-6)


def left_out(folder):
    """What a check cannot be made for is said; a side in tension counts where the other is compressed."""
    spring = {"compression_only": True, "disk": {"E": 2e5, "nu": 0.3}}
    scene = sheet([-20, 20, 60], [-20, 20], supports=[{"on": "left", "fix": ["x"]}, {"on": "right", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}])
    matrices(folder, scene | {"holes": [{"id": "1", "center": [0, 0], "radius": 3, "spring": spring}]}, "a")
    matrices(folder, sheet([-20, 20, 60], [-20, 20], external=[{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]) |
             {"holes": [{"id": "1", "center": [0, 0], "radius": 3, "spring": {"modulus": 1e5}, "stresses": False}]}, "b")
    done, found, rim = solve(folder, [{"check": "tension", "F_tu": 60, "of": ["a"]}, {"check": "peak", "limit": 900}])
    assert "[check-left-out]" in done.stderr and 'check "peak" is not made for b:1: its value is not known' in done.stderr, done.stderr
    force = P * 40 / 80  # of a bolt between two clamped edges about: the side behind it is pulled
    assert 0 < rim["net_stress"][0, 0] and float(found["tension", "a:1"]["applied"]) == rim["net_stress"][0, 0] < 2 * force / (34 * T)
    for name in ("a", "b"):
        scene = sheet([-40, -20, 20], [-12, 12]) | {"disc_directions": ["y"]}
        scene |= {"supports": [{"on": "bottom", "fix": ["x", "y"]}]} if name == "a" else {"external": [{"id": "P", "on": "top", "direction": "y", "kind": "rigid"}]}
        matrices(folder, scene, name)
    done, found, _ = solve(folder, [{"check": "tension", "F_tu": 1}])
    assert "check-left-out" not in done.stderr and sorted(found) == [("tension", "a:1"), ("tension", "b:1")], (done.stderr, found)
    assert all(abs(abs(float(row["direction"])) - 90) < 15 for row in found.values()), "a load along y"
    lap(folder, 1.8 * D)
    with h5py.File(folder / "b.h5", "a") as file:  # as before version 1.4; the margin was NaN
        del file["rim/thickness"]
    done, found, _ = solve(folder, [{"check": "shear-out", "F_su": 260}])
    assert 'check "shear-out" is not made for b:1: its thickness is not known' in done.stderr, done.stderr
    assert list(found) == [("shear-out", "a:1")], found


def main():
    with tempfile.TemporaryDirectory() as name:
        refusals(Path(name))
        by_hand(Path(name))
        cases(Path(name))
        strips(Path(name))
        outlines(Path(name))
        halves(Path(name))
        left_out(Path(name))
    end_if_missed()


if __name__ == "__main__":
    main()
