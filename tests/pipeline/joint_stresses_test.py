# SPDX-License-Identifier: GPL-3.0-or-later
"""Stresses around holes that stage3_nonlinear --rim-stresses writes are those of the joint's forces, of its peaks and of the
sheets' fields: joint_stresses_test.py BIN_FOLDER."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts/python"))
sys.dont_write_bytecode = True
from stress_field import Field  # noqa: E402

AROUND = ("start", "angle", "sigma_rr", "sigma_tt", "sigma_rt")
NEAR_JUMP = 7.5  # degrees from where friction jumps: no peak is looked for there


def done(*words):
    result = subprocess.run(words, capture_output=True, text=True)
    assert result.returncode == 0, result
    return result.stdout


def example(name):
    return json.loads((ROOT / f"{name}.json").read_text())


def make_sheets(scenes, degrees, *options):
    for name, scene in scenes.items():
        Path(f"{name}.json").write_text(json.dumps(scene))
        done("stage1_plate", f"{name}.json", "-o", f"{name}.h5", "--p", degrees)
        done("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5", *options)


def solve(joint, *options):
    """result.h5; what stage 3 prints."""
    Path("joint.json").write_text(json.dumps(joint))
    return done("stage3_nonlinear", "joint.json", "-o", "result.h5", "--rim-stresses", *options)


class Rim:
    """A hole of a sheet in a result."""

    def __init__(self, plate, hole):
        rim = plate["rim"]
        self.index = list(rim["hole"].asstr()).index(hole)
        points = slice(*rim["start"][self.index:self.index + 2])
        self.angle = rim["angle"][points]
        self.stress = {kind: rim[f"sigma_{kind}"][:, points] for kind in ("rr", "tt", "rt")}
        self.peak, self.peak_angle = (rim[name][:, self.index] for name in ("peak_hoop", "peak_angle"))
        disc = plate["disc"]
        self.in_contact = "pressure/hole" in plate and hole in plate["pressure/hole"].asstr()[:]
        self.forces = {name: np.zeros((len(self.peak), 2)) for name in ("bearing", "friction")}
        self.axes = []  # along which its disc moves; across them nothing in the joint gives a force
        for at, (of, direction) in enumerate(zip(disc["hole"].asstr(), disc["direction"].asstr())):
            if of == hole:
                self.axes.append("xy".index(direction))
                for name, force in self.forces.items():
                    force[:, self.axes[-1]] = disc[name][:, at]

    def jumps(self, step):
        """Where friction jumps: in contact in the direction of the force and, if there is pressure too, opposite to it; else
        in the directions of its components."""
        bearing, friction = (self.forces[name][step] for name in ("bearing", "friction"))
        if self.in_contact:
            there = np.degrees(np.arctan2(*bearing[::-1]))
            opposite = self.stress["rr"][step, round(there + 180) % 360] < 0
            return [there, there + 180][:1 + opposite] if friction.any() else []
        return [90 * axis + 180 * (friction[axis] < 0) for axis in (0, 1) if friction[axis] != 0]

    def away(self, step):
        """True at points away from where friction may jump."""
        return np.all([np.abs((self.angle - angle + 180) % 360 - 180) > NEAR_JUMP for angle in self.jumps(step)] or
                      [np.ones(len(self.angle), bool)], axis=0)


def rims(joint):
    with h5py.File("result.h5") as result:
        for name in joint["plates"]:
            plate = result[f"plates/{name}"]
            for hole in plate["rim/hole"].asstr():
                yield name, hole, Rim(plate, hole)


def check_forces(joint, scenes, sheets, in_contact):
    """Pressure and shear have the resultants of bearing and friction, as well as sums over 360 points have them of a shear that
    jumps between two; an open hole has neither, and only rims in contact have no tension."""
    for name, hole, rim in rims(joint):
        scene = scenes[sheets[name]]
        radius = next(each["radius"] for each in scene["holes"] if each["id"] == hole)
        area = 2 * np.pi * radius * scene["geometry"]["grid"]["thickness"]
        theta = np.radians(rim.angle)
        normal, tangent = np.array([np.cos(theta), np.sin(theta)]), np.array([-np.sin(theta), np.cos(theta)])
        pressure, shear = -rim.stress["rr"], -rim.stress["rt"]
        assert np.array_equal(rim.angle, np.arange(360))
        bearing, friction = ((values @ along.T) / 360 * area for values, along in ((pressure, normal), (shear, tangent)))
        largest = np.abs(pressure).mean(axis=1).max() * area
        if largest == 0:
            assert not pressure.any() and not shear.any() and rim.peak[-1] != 0, (name, hole)
            continue
        worst = max(np.abs(found - rim.forces[of])[:, rim.axes].max() for of, found in (("bearing", bearing), ("friction", friction)))
        worst /= largest
        assert worst < 4e-3, (name, hole, worst, bearing, rim.forces["bearing"], friction, rim.forces["friction"])
        assert rim.forces["friction"][-1].any() and (pressure.min() >= 0) == in_contact, (name, hole)


def check_peaks(joint):
    """The largest hoop stress away from jumps of friction is the peak, at its place; where friction jumps, the waves of
    tractions that are left out make stresses uncertain by 2e-4 between the points at which peaks are looked for."""
    for name, hole, rim in rims(joint):
        for step, peak in enumerate(rim.peak):
            hoop = np.where(rim.away(step), rim.stress["tt"][step], -np.inf)
            at = hoop.argmax()
            assert 0.99 * peak <= hoop[at] <= peak * (1 + 3e-4), (name, hole, step, hoop[at], peak)
            apart = np.abs((rim.angle[at] - rim.peak_angle[step] + 180) % 360 - 180)
            assert apart <= 2, (name, hole, step, apart)


def check_fields(joint, sheets, allowed):
    """The field of a sheet has these hoop stresses at the nodes of its rims, as well as fields have stresses there."""
    fields = {}
    for name, sheet in sheets.items():
        done("stage2_extract", f"{sheet}.h5", "--field", "result.h5", "--plate", name, "-o", "field.vtu")
        fields[name] = Field("field.vtu")
    worst = 0
    for name, hole, rim in rims(joint):
        field = fields[name]
        at = field.points["points"][..., :2].reshape(-1, 2) - field.holes()[hole]
        on_rim = np.isclose(np.hypot(*at.T), field.radii()[hole], rtol=1e-6)
        c, s = (at[on_rim] / field.radii()[hole]).T
        x, y, xy = (field.points[f"stress_{each}"].ravel()[on_rim] for each in ("xx", "yy", "xy"))
        angle = np.degrees(np.arctan2(s, c))
        of = {kind: np.interp(angle, rim.angle, values[-1], period=360) for kind, values in rim.stress.items()}
        away = np.interp(angle, rim.angle, rim.away(-1), period=360) == 1
        off = np.abs(s**2 * x + c**2 * y - 2 * c * s * xy - of["tt"])[away].max() / np.abs(rim.stress["tt"][-1]).max()
        worst = max(worst, off)
    print(f"hoop stresses of fields at rims differ by up to {worst:.1e} of the largest")
    assert worst < allowed, worst


def check_kept(*options):
    """Without the option all else is the same."""
    def datasets(file):
        found = {}
        file.visititems(lambda name, each: found.update({name: each[()]}) if isinstance(each, h5py.Dataset) else None)
        return found
    done("stage3_nonlinear", "joint.json", "-o", "without.h5", *options)
    with h5py.File("result.h5") as with_them, h5py.File("without.h5") as without:
        one, other = datasets(with_them), datasets(without)
        more = [f"plates/{name}/rim/{each}" for name in with_them["plate/name"].asstr() for each in AROUND]
    assert sorted(one) == sorted([*other, *more])
    for name in other:
        np.testing.assert_array_equal(one[name], other[name], name)


def lap_joint():
    """Discs along x, an open hole, a traction, unlike friction of a fastener's holes."""
    scenes = {name: example(f"tests/pipeline/scenes/lap_joint/{name}") for name in ("upper", "lower")}
    scenes["upper"]["holes"].append({"id": "open", "center": [100, 10], "radius": 3})
    scenes["upper"]["external"].append({"id": "T", "on": "left", "direction": "x", "kind": "traction"})
    joint = example("tests/pipeline/scenes/lap_joint/joint")
    for fastener in joint["fasteners"]:
        fastener["friction"] = 0.2
    joint["fasteners"][2]["friction"] = {"upper": 0.1, "lower": 0.3}
    joint["loads"].append({"external": "upper:T", "force": -700})
    return scenes, joint


def bolt_group(in_contact):
    """Discs along x and y, sheets that float, three to a fastener; all bolts bear."""
    joint = example("examples/bolt_group/tight")
    for fastener in joint["fasteners"]:
        fastener["friction"] = 0.2
    scenes = {name: example(f"examples/bolt_group/{name}") for name in ("bracket", "web")}
    for scene in scenes.values():
        for hole in scene["holes"]:
            hole["spring"]["compression_only"] = in_contact
            if in_contact:
                hole["waves"] = 16  # of which a field's pressure is made
    return scenes, joint


def check_disc_forces():
    """Along one direction bearing and friction of a hole are what its shear plane transfers, with the sign of the side."""
    with h5py.File("result.h5") as result:
        for side, sign in (0, -1), (1, 1):
            for plane, name in enumerate(result[("fastener/first", "fastener/second")[side]].asstr()):
                sheet, hole = name.split(":")
                disc = result[f"plates/{sheet}/disc"]
                at = list(disc["hole"].asstr()).index(hole)
                np.testing.assert_allclose(disc["bearing"][:, at] + disc["friction"][:, at],
                                           sign * result["transferred"][:, plane, side], rtol=1e-12)
                assert disc["friction"][-1, at] != 0


def check_degrees(joint):
    """At the lower degree of stresses nothing tells their error; at degrees below, and of matrices with loads only, there are
    none."""
    printed = solve(joint, "--p", "7")
    with h5py.File("result.h5") as result:
        rim = result["plates/upper/rim"]
        assert np.isinf(rim["peak_error"][:]).all() and rim["sigma_tt"][:].any() and len(rim["start"]) == 6
    assert "holds no stresses" not in printed, printed
    assert_none(solve(joint, "--p", "6"), joint, 6)


def assert_none(printed, joint, p):
    with h5py.File("result.h5") as result:
        for name, matrices in joint["plates"].items():
            assert (f"{matrices} holds no stresses of {name} at p = {p}; stage2_extract without --loads-only writes those of the "
                    "two highest degrees of PLATE.h5\n") in printed, printed
            rim = result[f"plates/{name}/rim"]
            assert len(rim["hole"]) == 0 and not set(AROUND) & set(rim), list(rim)


def check_unwanted(scenes, joint):
    """A hole that wants no stresses has no points, no peak and an infinite error; others are as before, but for what its fewer
    rings of elements change."""
    solve(joint)
    with h5py.File("result.h5") as result:
        before = result["plates/lower/rim/sigma_tt"][:]
    scenes["upper"]["holes"][1]["stresses"] = False
    make_sheets({"upper": scenes["upper"]}, "7..8")
    solve(joint)
    with h5py.File("result.h5") as result:
        rim = result["plates/upper/rim"]
        assert np.array_equal(np.diff(rim["start"]), [360, 0, 360, 360, 360]), rim["start"][:]
        assert np.isnan(rim["peak_hoop"][:, 1]).all() and np.isinf(rim["peak_error"][:, 1]).all()
        assert rim["bearing_load"][-1, 1] != 0 and (rim["peak_hoop"][-1, [0, 2, 3, 4]] != 0).all()
        np.testing.assert_allclose(result["plates/lower/rim/sigma_tt"], before, atol=1e-6 * np.abs(before).max())


def main(folder):
    os.environ["PATH"] = str(Path(folder).resolve()) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        scenes, joint = lap_joint()
        sheets = {name: name for name in scenes}
        make_sheets(scenes, "6..8")
        for change in ({}, {"solver": {"method": "damped newton"}, "increments": 7},
                       {"laws": {"rivet": {"type": "linear", "k": 9000}}, "increments": "events"}):
            solve(joint | change)
            check_forces(joint, scenes, sheets, in_contact=False)
            check_peaks(joint)
        check_fields(joint, sheets, 0.02)
        check_disc_forces()
        check_kept()
        check_degrees(joint)
        check_unwanted(scenes, joint)
        make_sheets(scenes, "8", "--loads-only")
        assert_none(solve(joint), joint, 8)
        for in_contact in (False, True):
            scenes, joint = bolt_group(in_contact)
            sheets = {name: Path(matrices).name.split(".")[0] for name, matrices in joint["plates"].items()}
            make_sheets(scenes, "7..8")
            solve(joint)
            check_forces(joint, scenes, sheets, in_contact)
            check_peaks(joint)
            check_fields(joint, sheets, 0.1 if in_contact else 0.02)
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
