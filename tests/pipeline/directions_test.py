#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Margins and what they take do not depend on the direction of the load: x and y exchanged, and tractions at 30 and 45 degrees against hand calculations.

Usage: directions_test.py FOLDER_OF_PROGRAMS"""
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

POLYGON = [[400, 0], [250, 700], [0, 700], [-250, 600], [-300, 0], [-250, -700], [0, -700], [250, -700]]
CHECKS = [{"check": "tension", "F_tu": 427}, {"check": "bearing", "F_br": [[1.5, 669], [2.0, 834]]}, {"check": "shear-out", "F_su": 270},
          {"check": "bearing-bypass", "polygon": POLYGON}]


def solve(folder, joint):
    """Margins by check and hole, and the quantities of all holes at the last increment."""
    (folder / "joint.json").write_text(json.dumps(joint | {"margins": {"checks": CHECKS}}))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "joint.h5", "--margins", "margins.csv"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    with h5py.File(folder / "joint.h5") as f:
        rims = {f"{name}:{hole}": {key: values[-1, i] for key, values in plate["rim"].items() if values.ndim == 2 and len(values) == len(f["load_factor"])}
                for name, plate in f["plates"].items() for i, hole in enumerate(plate["rim/hole"].asstr())}
    with open(folder / "margins.csv", encoding="utf-8") as table:
        return {(row["check"], row["of"]): row for row in csv.DictReader(table)}, rims


def exchanged(scene):
    """The sheet with x and y exchanged."""
    side = {"left": "bottom", "bottom": "left", "right": "top", "top": "right"}
    other = {"x": "y", "y": "x"}
    text = json.loads(json.dumps(scene))
    grid = text["geometry"]["grid"]
    grid["x"], grid["y"] = grid["y"], grid["x"]
    for hole in text["holes"]:
        hole["center"].reverse()
    for each in text.get("supports", []) + text.get("external", []):
        each["on"] = side[each["on"]]
        if "fix" in each:
            each["fix"] = [other[axis] for axis in each["fix"]]
        if "direction" in each:
            each["direction"] = other[each["direction"]]
    return text


def two_bolts(folder):
    example = ROOT / "examples/two_bolts"
    sheets = {name: {key: value for key, value in json.loads((example / f"{name}.json").read_text()).items() if key != "$schema"} for name in ("upper", "lower")}
    joint = {key: value for key, value in json.loads((example / "joint.json").read_text()).items() if key != "$schema"}
    found = []
    for change in (lambda sheet: sheet, exchanged):
        for name, sheet in sheets.items():
            matrices(folder, change(sheet), f"{name}.matrices")
        found.append(solve(folder, joint))
    (here, rims), (there, turned) = found
    assert here.keys() == there.keys() and len(here) == 16
    for key, row in here.items():
        x, y = (float(each["margin"]) for each in (row, there[key]))
        if min(x, y) < 1000:
            near(f"two bolts, x and y exchanged: margin of {key}", y, x, 1e-6)
        if row["direction"] and min(x, y) < 1000:
            near("  direction", np.cos(np.radians(2 * (90 - float(row["direction"]) - float(there[key]["direction"])))), 1, 1e-6)
    for hole, values in rims.items():
        for key in ("bypass_load", "bypass_stress", "net_stress", "peak_hoop", "bearing_stress", "gross_concentration", "net_concentration"):
            largest = max(abs(each[key]) for each in rims.values())
            near(f"two bolts, x and y exchanged: {key} of {hole}", abs(turned[hole][key] - values[key]) / largest, 0, 1e-6, absolute=True)
    near("two bolts: tension margin of lower:1", float(there["tension", "lower:1"]["margin"]), float(here["tension", "lower:1"]["margin"]), 1e-6)


def reach(x, y):
    """Distance from the origin to the polygon along (x, y)."""
    along, found = np.array([x, y]) / np.hypot(x, y), []
    for a, b in zip(POLYGON, [*POLYGON[1:], POLYGON[0]]):
        r, s = np.linalg.solve(np.column_stack([along, np.subtract(a, b)]), a) if abs(np.linalg.det(np.column_stack([along, np.subtract(a, b)]))) > 0 else (np.inf, 2)
        if r > 0 and -1e-12 <= s <= 1 + 1e-12:
            found.append(r)
    return min(found)


def tractions(folder):
    """A sheet of one cell under tractions of a tension in a direction on all edges, and a load Q in that direction, half on the right and half on the left,
    which a pin takes: all section forces are known."""
    a, t, r, sigma, Q = 20.0, 2.0, 3.0, 60.0, 900.0
    area, net = 2 * a * t, 2 * (a - r) * t
    edges = ["right", "left", "top", "bottom"]
    matrices(folder, {"format": "plate", "version": 1, "analysis": "plane stress", "p": [7, 8], "materials": {"m": {"E": 72400, "nu": 0.33}},
                      "geometry": {"grid": {"x": [-a, a], "y": [-a, a], "thickness": t}}, "disc_directions": ["x", "y"],
                      "holes": [{"id": "h", "center": [0, 0], "radius": r, "spring": {"disk": {"E": 2e5, "nu": 0.3}}}],
                      "points": [{"id": "k", "at": [a, a], "stiffness": 1}],
                      "external": [{"id": f"{edge} {axis}", "on": edge, "direction": axis, "kind": "traction"} for edge in edges for axis in "xy"]}, "s")
    for angle, across in ((0, 0), (30, 0), (45, 0), (90, 0), (120, 0), (30, -0.95), (45, -2)):
        n = np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
        S = sigma * (np.outer(n, n) + across * (np.eye(2) - np.outer(n, n)))  # with a tension or compression across n
        loads = []
        for edge, normal, part in (("right", (1, 0), 0.5), ("left", (-1, 0), 0.5), ("top", (0, 1), 0), ("bottom", (0, -1), 0)):
            force = S @ normal * area + part * Q * n
            loads += [{"external": f"s:{edge} {axis}", "force": float(f)} for axis, f in zip("xy", force)]
        joint = {"format": "joint", "version": 1, "plates": {"s": "s.h5"}, "laws": {"pin": {"type": "linear", "k": 1e5}, "hold": {"type": "linear", "k": 1e-3}},
                 "fasteners": [{"id": "pin", "between": ["s:h", "ground"], "law": "pin"}, {"id": "hold", "between": ["s:k", "ground"], "law": "hold"}], "loads": loads}
        margins, rims = solve(folder, joint)
        # The pin's force on the sheet is -Q n. It adds Q_x to the tension on the right, where bypass leaves it out.
        passing = S.copy()
        passing[0, 0] -= Q * abs(n[0]) / 2 / area
        values, vectors = np.linalg.eigh(passing)
        i = np.abs(values).argmax()
        rim = rims["s:h"]
        bar = rim["bypass_error"] / abs(rim["bypass_load"])  # forces over sections converge as slowly as stresses
        assert bar < 0.02, bar
        near(f"tractions at {angle} degrees: bypass stress", rim["bypass_stress"], values[i], bar)
        near("  its direction", abs(vectors[:, i] @ [np.cos(np.radians(rim["bypass_direction"])), np.sin(np.radians(rim["bypass_direction"]))]), 1, 1e-6)
        bearing = Q / (2 * r * t)
        near("  bearing stress", rim["bearing_stress"], bearing, 1e-6)
        near("  principal stress across it", rim["bypass_across"], values[1 - i], bar * abs(values[i] / values[1 - i]) if across else bar * abs(values[i]), absolute=not across)
        least = min(reach(value, bearing) / np.hypot(value, bearing) for value in values)
        near("  margin of bearing-bypass", float(margins["bearing-bypass", "s:h"]["margin"]), least - 1, 2 * bar)
        ligament = S * area / net
        ligament[0, 0] += Q * abs(n[0]) / 2 / net
        near("  net stress", rim["net_stress"], np.linalg.eigvalsh(ligament)[1], bar)
        near("  margin of tension", float(margins["tension", "s:h"]["margin"]), 427 / np.linalg.eigvalsh(ligament)[1] - 1, 2 * bar)


def doubler(folder):
    """A skin under tractions along x and y with a doubler on four rivets: by symmetry the sections beside a rivet carry half of each traction,
    less the rivet's force on the inner side; so do those of the doubler, by the rivet's force alone."""
    spring = {"disk": {"E": 71700, "nu": 0.33}}
    size, t = {"skin": (60, 40), "doubler": (45, 30)}, {"skin": 2.0, "doubler": 1.6}
    r, X, Y = 2.4, 48000.0, 36000.0
    for name, (a, b) in size.items():
        matrices(folder, {"format": "plate", "version": 1, "name": name, "analysis": "plane stress", "p": [6, 7], "materials": {"m": {"E": 72400, "nu": 0.33}},
                          "geometry": {"grid": {"x": [-a, 0, a], "y": [-b, 0, b], "thickness": t[name]}}, "disc_directions": ["x", "y"],
                          "holes": [{"id": f"{i}{j}", "center": [30 * i, 20 * j], "radius": r, "spring": spring} for i in (-1, 1) for j in (-1, 1)],
                          "points": [{"id": side, "at": [x, 0], "stiffness": 1} for side, x in (("left", -a), ("right", a))],
                          "external": [{"id": edge, "on": edge, "direction": axis, "kind": "traction"} for edge, axis in
                                       zip(("right", "left", "top", "bottom"), "xxyy")]}, name)
    rivets = [{"id": f"{i}{j}", "between": [f"skin:{i}{j}", f"doubler:{i}{j}"], "law": "rivet"} for i in (-1, 1) for j in (-1, 1)]
    loads = [{"external": f"skin:{edge}", "force": force} for edge, force in (("right", X), ("left", -X), ("top", Y), ("bottom", -Y))]
    margins, rims = solve(folder, {"format": "joint", "version": 1, "plates": {name: f"{name}.h5" for name in size},
                                   "laws": {"rivet": {"type": "linear", "k": 80e3}, "hold": {"type": "linear", "k": 1e-3}},
                                   "fasteners": rivets + [{"id": side, "between": [f"skin:{side}", "ground"], "law": "hold"} for side in ("left", "right")], "loads": loads})
    for name, (a, b) in size.items():
        rim, thickness = rims[f"{name}:11"], t[name]
        T = abs(np.array([rim["bearing_load"], rim["bearing_load_y"]]))
        applied = np.array([X, Y]) / 2 if name == "skin" else T
        widths = np.array([b, a])
        passing = np.sort((applied - T) / (widths * thickness))
        net = (applied / ((widths - 2 * r) * thickness)).max()
        bearing = np.hypot(*T) / (2 * r * thickness)
        assert T.min() > 500, T
        near(f"doubler, {name}: bearing stress", rim["bearing_stress"], bearing, 1e-9)
        near("  net stress", rim["net_stress"], net, 5e-3)
        near("  margin of tension", float(margins["tension", f"{name}:11"]["margin"]) + 1, 427 / net, 5e-3)
        near("  bypass stress", rim["bypass_stress"], passing[1], 5e-3 * X / (b * thickness) / 2, absolute=True)
        near("  margin of bearing-bypass", float(margins["bearing-bypass", f"{name}:11"]["margin"]) + 1,
             min(reach(value, bearing) / np.hypot(value, bearing) for value in passing), 5e-3)


def main():
    with tempfile.TemporaryDirectory() as name:
        for each in (two_bolts, tractions, doubler):
            each(Path(name))
    end_if_missed()


if __name__ == "__main__":
    main()
