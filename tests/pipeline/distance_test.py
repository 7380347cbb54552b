# SPDX-License-Identifier: GPL-3.0-or-later
"""Stresses at a distance from the rims (stage3_nonlinear --distance) against closed forms of wide sheets and against the
finite elements' own field of a joint in contact: distance_test.py BIN_FOLDER."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from scipy.interpolate import CubicSpline

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/python"))
from stress_field import Field  # noqa: E402

A = 3.0  # radius of the hole in a wide sheet
MATERIALS = {"isotropic": {"E": 70000, "nu": 0.3}, "ply": {"E1": 140000, "E2": 9000, "nu12": 0.3, "G12": 5000},
             "turned": {"E1": 140000, "E2": 9000, "nu12": 0.3, "G12": 5000, "angle": 30}}


def run(*words):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result


def around(path, plate, hole):
    """Angles, stresses (rr, tt, rt) on the rim and at the distance, and the distant peak with its error."""
    with h5py.File(path) as f:
        rim = f[f"plates/{plate}/rim"]
        i = list(rim["hole"].asstr()).index(hole)
        points = slice(*rim["start"][i:i + 2])
        both = [np.array([rim[f"{where}sigma_{name}"][-1, points] for name in ("rr", "tt", "rt")]) for where in ("", "near/")]
        return rim["angle"][points], *both, rim["near/peak_hoop"][-1, i], rim["near/peak_error"][-1, i]


def wide_sheet(material, width, distances):
    """Stresses around an open hole in a square sheet pulled along x by a mean stress of 1, at each distance. Two holes far
    away hold the sheet in its place, without forces."""
    far, name, lines = 0.4 * width, f"{material}_{width:g}", [-width / 2, -0.3 * width, -20, 20, 0.3 * width, width / 2]
    scene = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": MATERIALS[material]},
             "geometry": {"grid": {"x": lines, "y": lines, "thickness": 1}},
             "holes": [{"id": "1", "center": [0, 0], "radius": A}] +
                      [{"id": id, "center": [0, y], "radius": A, "spring": {"disk": {"E": 1000, "nu": 0.3}}} for id, y in (("g", far), ("h", -far))],
             "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"},
                          {"id": "Q", "on": "left", "direction": "x", "kind": "traction"}]}
    Path(f"{name}.json").write_text(json.dumps(scene))
    run("stage1_plate", f"{name}.json", "-o", f"{name}.h5")
    run("stage2_extract", f"{name}.h5", "-o", f"{name}.m.h5")
    joint = {"format": "joint", "version": 1, "plates": {"s": f"{name}.m.h5"}, "laws": {"l": {"type": "linear", "k": 1}},
             "fasteners": [{"id": id, "between": [f"s:{id}", "ground"], "law": "l"} for id in "gh"],
             "loads": [{"external": "s:P", "force": width}, {"external": "s:Q", "force": -width}]}
    Path("joint.json").write_text(json.dumps(joint))
    results = []
    for distance in distances:
        run("stage3_nonlinear", "joint.json", "-o", "r.h5", "--rim-stresses", "--distance", distance)
        results.append(around("r.h5", "s", "1"))
    return results


def kirsch(r, angle):
    """Stresses (rr, tt, rt) in an infinite isotropic sheet with a free hole under tension 1 along x."""
    q, c, s = (A / r)**2, np.cos(2 * angle), np.sin(2 * angle)
    return np.array([(1 - q) / 2 + (1 - 4 * q + 3 * q**2) / 2 * c, (1 + q) / 2 - (1 + 3 * q**2) / 2 * c, -(1 + 2 * q - 3 * q**2) / 2 * s])


def lekhnitskii(material, r, angle):
    """The same in an orthotropic sheet (Lekhnitskii, Anisotropic Plates, section 39): potentials in 1/zeta."""
    m, beta = MATERIALS[material], np.radians(MATERIALS[material].get("angle", 0))
    own = np.roots([1 / m["E1"], 0, 1 / m["G12"] - 2 * m["nu12"] / m["E1"], 0, 1 / m["E2"]])
    mu = [(root * np.cos(beta) + np.sin(beta)) / (np.cos(beta) - root * np.sin(beta)) for root in own]
    mu = [root for root in mu if root.imag > 0]  # of the axes x and y
    x, y = r * np.cos(angle), r * np.sin(angle)
    amounts = -0.5j * A / (mu[0] - mu[1]) * np.array([1, -1])
    xx, yy, xy = np.ones_like(angle), np.zeros_like(angle), np.zeros_like(angle)
    for root, amount in zip(mu, amounts):
        z = (x + root * y) / A
        square = np.sqrt(z * z - 1 - root**2)
        zeta = np.where(np.abs(z + square) > np.abs(z - square), z + square, z - square) / (1 - 1j * root)
        slope = -amount / zeta**2 / (A / 2 * ((1 - 1j * root) - (1 + 1j * root) / zeta**2))
        xx, yy, xy = xx + 2 * (root**2 * slope).real, yy + 2 * slope.real, xy - 2 * (root * slope).real
    c, s = np.cos(angle), np.sin(angle)
    return np.array([c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy, c * s * (yy - xx) + (c * c - s * s) * xy])


def check_closed_forms():
    """What is left in an isotropic sheet is the effect of its width, which falls with the square of it; in laminates peaks
    are as near as their error bars say. Next to the rim stresses are those of the rim."""
    differences = []
    for width in 300, 600:
        for distance, (angle, _, near, *_) in zip((0.3, 1.0), wide_sheet("isotropic", width, (0.3, 1.0))):
            truth = kirsch(A + distance, np.radians(angle))
            differences.append(np.abs(near - truth).max() / np.abs(truth).max())
    assert max(differences[2:]) < 1e-3, differences
    assert all(3.5 < near / wide < 4.5 for near, wide in zip(differences[:2], differences[2:])), differences
    for material in "ply", "turned":
        distances = 1e-6, 0.3, 1.0, 2.0
        for distance, (angle, on_rim, near, peak, error) in zip(distances, wide_sheet(material, 600, distances)):
            truth = lekhnitskii(material, A + distance, np.radians(np.linspace(0, 360, 3601)))[1].max()
            assert distance > 1e-5 or np.abs(near - on_rim).max() < 1e-4, (material, np.abs(near - on_rim).max())
            assert abs(peak - truth) < error + 5e-4 * truth and error < 0.02 * truth, (material, distance, peak, error, truth)


def set_up_lap_joint():
    """The lap joint of examples, and its upper sheet again with four rings of elements around the holes."""
    example = ROOT / "examples/lap_joint"
    upper = json.loads((example / "upper.json").read_text())
    for hole in upper["holes"]:
        hole["rings"] = 4
    Path("fine.json").write_text(json.dumps(upper))
    joint = json.loads((example / "joint.json").read_text())
    for name, scene in ("upper", example / "upper.json"), ("lower", example / "lower.json"), ("fine", "fine.json"):
        run("stage1_plate", scene, "-o", f"{name}.h5")
        run("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5")
    Path("coarse_joint.json").write_text(json.dumps(joint))
    Path("fine_joint.json").write_text(json.dumps(joint | {"plates": {"upper": "fine.matrices.h5", "lower": "lower.matrices.h5"}}))


def field_on_ring(hole, radius):
    """Angles of the nodes of the finite elements' field on a circle around a hole, and stresses (rr, tt, rt) there."""
    field = Field("fine.vtu")
    places = field.points["points"][..., :2].reshape(-1, 2) - field.holes()[hole]
    xx, yy, xy = (field.points[f"stress_{name}"].ravel() for name in ("xx", "yy", "xy"))
    on = np.abs(np.hypot(*places.T) - radius) < 1e-6
    angle = np.arctan2(places[on, 1], places[on, 0])
    c, s, xx, yy, xy = np.cos(angle), np.sin(angle), xx[on], yy[on], xy[on]
    return angle, np.array([c * c * xx + s * s * yy + 2 * c * s * xy, s * s * xx + c * c * yy - 2 * c * s * xy, c * s * (yy - xx) + (c * c - s * s) * xy])


def check_contact():
    """With rivets in contact, friction among it, stresses at the rings of a fine mesh are those of its elements, as near as
    the field of elements is smooth from one to the next; the coarse mesh of the defaults does not need the rings."""
    set_up_lap_joint()
    with h5py.File("fine.h5") as f:
        nodes = f["mesh/nodes"][()]
    for hole, center in ("a", (50, 10)), ("c", (68, 10)):
        from_center = np.hypot(*(nodes - center).T)
        radii = [r for r in sorted(set(np.round(from_center, 6))) if (np.abs(from_center - r) < 1e-4).sum() >= 8]
        for radius in radii[1:3]:
            for name in "fine", "coarse":
                run("stage3_nonlinear", f"{name}_joint.json", "-o", f"{name}.r.h5", "--rim-stresses", "--distance", repr(float(radius - 2.4)))
            run("stage2_extract", "fine.h5", "--field", "fine.r.h5", "-o", "fine.vtu")
            places, field = field_on_ring(hole, radius)
            for name in "fine", "coarse":
                angle, _, near, peak, error = around(f"{name}.r.h5", "upper", hole)
                own = CubicSpline(np.append(angle, angle[0] + 360), np.column_stack([near, near[:, :1]]).T, bc_type="periodic")
                off = np.abs(own(np.degrees(places) % 360).T - field).max() / field.max()
                assert off < 0.01, (hole, radius, name, off)
                assert abs(peak - field[1].max()) < error + 2e-3 * peak, (hole, radius, name, peak, error, field[1].max())


def check_room():
    """Where the sheet ends before the distance there is no peak, which the program says; other holes keep theirs."""
    scene = json.loads((ROOT / "examples/lap_joint/upper.json").read_text())
    scene["holes"][0]["center"] = [44, 10]  # 1.6 from rim to edge
    Path("edge.json").write_text(json.dumps(scene))
    run("stage1_plate", "edge.json", "-o", "edge.h5")
    run("stage2_extract", "edge.h5", "-o", "edge.matrices.h5")
    joint = json.loads(Path("coarse_joint.json").read_text()) | {"plates": {"upper": "edge.matrices.h5", "lower": "lower.matrices.h5"}}
    Path("edge_joint.json").write_text(json.dumps(joint))
    for distance, is_far in (1.59, False), (1.61, True):
        words = run("stage3_nonlinear", "edge_joint.json", "-o", "edge.r.h5", "--distance", distance)
        assert ("no stresses at this distance from upper:a, around" in words.stderr) == is_far, words.stderr
        assert f"{distance} mm from the rims the highest is" in words.stdout, words.stdout
        with h5py.File("edge.r.h5") as f:
            near = f["plates/upper/rim/near"]
            assert (np.isinf(near["peak_error"][-1, 0]) and np.isnan(near["peak_hoop"][-1, 0])) == is_far
            assert np.isfinite(near["peak_error"][-1, 1:]).all() and near["distance"][()] == distance
    refused = subprocess.run(["stage3_nonlinear", "edge_joint.json", "-o", "x.h5", "--distance", "0"], capture_output=True, text=True)
    assert refused.returncode == 2 and "--distance" in refused.stderr, refused.stderr


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        check_closed_forms()
        check_contact()
        check_room()
        os.chdir("/")


main()
