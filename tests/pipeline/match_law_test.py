#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/match_law: rigs as soft as formulas, numbers and tests, and what docs/choosing.md says of them.

Usage: match_law_test.py FOLDER_OF_PROGRAMS"""
import contextlib
import json
import os
import re
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from examples import copy_example  # noqa: E402
from one_hole import PROGRAMS, end_if_missed, near, run  # noqa: E402
from scripts import run_script  # noqa: E402

GEOMETRY = {"type": "formula", "mode": "fastener only", "shear": "single", "t": [1.6, 1.6], "E": [72400, 72400], "d": 4.8, "E_f": 71000}


def match(folder, *words, status=0):
    with contextlib.chdir(folder):
        done = run_script("match_law", *words)
    assert done.returncode == status, (done.stdout, done.stderr)
    return done.stderr if status else done.stdout


def numbers(text):
    """Flexibility of the holes, the target, how far the rig is off it, and the law."""
    target = re.search(r"the target is (\S+)", text)
    return (float(re.search(r"flexibility of (\S+)", text)[1]), target and float(target[1]), float(re.search(r"off the target by (\S+);", text)[1]),
            json.loads(re.search(r'"matched": (\{.*\})', text)[1]))


def joint_with(folder, law, change=lambda fastener: None):
    joint = json.loads((folder / "joint.json").read_text())
    joint["laws"] = {"law": law}
    for fastener in joint["fasteners"]:
        fastener["law"] = "law"
        fastener.pop("gap", None)
        change(fastener)
    (folder / "case.json").write_text(json.dumps(joint))


def formulas(folder):
    """Each formula by hand; the rig has it to rounding; an independent rig of other lengths with the law has it to 1e-6; the table of docs/choosing.md."""
    page = (ROOT / "docs/choosing.md").read_text()
    t, E, d, E_f = 1.6, 72400.0, 4.8, 71000.0
    sheet = {"huth bolt": (2 * t / (2 * d)) ** (2 / 3) * 3 * 2 / (t * E), "huth rivet": (2 * t / (2 * d)) ** 0.4 * 2.2 * 2 / (t * E), "swift": 1.6 / (t * E),
             "boeing": 2 * 2 ** ((t / d) ** 0.85) / t / E, "grumman": 7.4 / (t * E)}
    shank = {"huth bolt": (2 * t / (2 * d)) ** (2 / 3) * 3 / (t * E_f), "huth rivet": (2 * t / (2 * d)) ** 0.4 * 2.2 / (t * E_f), "swift": 5 / (d * E_f),
             "boeing": 2 * 2 ** ((t / d) ** 0.85) / t * 3 / 8 / E_f, "grumman": (2 * t) ** 2 / (E_f * d**3)}
    for name in sheet:
        joint_with(folder, GEOMETRY | {"formula": name})
        holes, target, off, law = numbers(match(folder, "case.json", "a", "--rig", "rig"))
        total = sheet[name] + shank[name]
        near(f"{name}: the formula", target, total, 1e-5)  # printed digits
        near(f"{name}: the rig", 1 + off, 1, 1e-12)
        near(f"{name}: k", 1 / law["k"], total - holes, 1e-4)
        percent = lambda value: f"{100 * value:+.1f} %" if abs(value) < 0.1 else f"{100 * value:+.0f} %"
        row = f"| {name} | {total:.2e} | {percent(holes / total)} | {percent((holes + shank[name]) / total - 1)} | {law['k']:.0f} |"
        assert row in page, row
        # Half strips that are longer by half, with other lines, in a joint made here.
        for i, ends in enumerate(({"external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}, {"supports": [{"on": "left", "fix": ["x"]}]})):
            scene = json.loads((folder / f"rig/sheet{i}.json").read_text())
            lines = [-20, -8, 11, 50, 120] if i == 0 else [-120, -50, -11, 8, 20]
            scene |= {"geometry": {"grid": {"x": lines, "y": [0, 10], "thickness": 1.6}}} | ends
            scene["supports"] = [*(ends.get("supports", [])), {"on": "bottom", "fix": ["y"]}]
            (folder / f"other{i}.json").write_text(json.dumps(scene))
            run(folder, "stage1_plate", f"other{i}.json", "-o", f"other{i}.plate.h5")
            run(folder, "stage2_extract", f"other{i}.plate.h5", "-o", f"other{i}.h5")
        joint = {"format": "joint", "version": 1, "plates": {"p": "other0.h5", "q": "other1.h5"}, "laws": {"law": law | {"k": law["k"] / 2}},
                 "fasteners": [{"id": "1", "between": ["p:a", "q:a"], "law": "law"}], "loads": [{"external": "p:P", "force": 500.0}]}
        (folder / "other.json").write_text(json.dumps(joint))
        run(folder, "stage3_nonlinear", "other.json", "-o", "other_joint.h5")
        with h5py.File(folder / "other_joint.h5") as f:
            moved = f["plates/p/De"][-1, 0] / 1000 - 2 * 120 / (E * t * 20)
        near(f"{name}: a rig of other length and lines", moved, total, 1e-6)


def others(folder):
    """Numbers, curves, double shear, and what is refused."""
    joint_with(folder, {"type": "linear", "k": 1})
    holes, target, off, law = numbers(match(folder, "case.json", "a", "--flexibility", 4e-5, "--pitch", 30))
    assert target == 4e-5 and off < 1e-12 and holes > 2.4e-5
    (folder / "test.csv").write_text("# a test\ndelta, F\n0.02, 500\n0.05, 1100\n0.09, 1600\n")
    holes, _, off, law = numbers(match(folder, "case.json", "a", "--curve", "test.csv"))
    assert off < 1e-9 and law["type"] == "table" and np.allclose(law["delta"], np.array([0.02, 0.05, 0.09]) - holes * np.array([500, 1100, 1600]), rtol=1e-4), law
    for words, message in ((["case.json", "a", "--flexibility", 1e-5], "the holes alone are softer than the target"), (["case.json", "z"], "no fastener z; allowed: a, b, c, d"),
                           (["case.json", "a"], 'is of the type "linear"'), (["case.json", "a", "--flexibility", -1], "numbers above 0"), (["case.json", "a", "--flexibility", "inf"], "numbers above 0 and below"),
                           (["case.json", "a", "--flexibility", 1, "--pitch", 5], "no more than the hole"), (["none.json", "a"], "none.json")):
        assert message in match(folder, *words, status=2), (words, message)
    (folder / "steep.csv").write_text("0.02,500\n0.03,1500\n")
    assert "the holes alone are softer than the curve" in match(folder, "case.json", "a", "--curve", "steep.csv", status=2)
    (folder / "bad.csv").write_text("0.02,500\n0.01,1500\n")
    assert "both rising" in match(folder, "case.json", "a", "--curve", "bad.csv", status=2)
    for text in ("{}", "[1]", '{"fasteners": [{"id": "a", "between": ["upper:a", "lower"], "law": "l"}]}', '{"fasteners": [{"id": "a"}]}'):
        (folder / "odd.json").write_text(text)
        assert "odd.json: is no joint that stage3_nonlinear reads" in match(folder, "odd.json", "a", "--flexibility", 1, status=2), text
    (folder / "zero.csv").write_text("0,100\n0.02,500\n")
    assert "besides 0, 0" in match(folder, "case.json", "a", "--curve", "zero.csv", status=2)
    # Double shear: the middle sheet carries what both planes do; Huth's formula for both planes together.
    joint = json.loads((folder / "case.json").read_text())
    joint["plates"]["back"] = joint["plates"]["lower"]
    joint["laws"]["law"] = GEOMETRY | {"formula": "huth composite", "shear": "double"}
    joint["fasteners"] = [{"id": "a", "between": ["lower:a", "upper:a", "back:a"], "law": "law"}]
    (folder / "double.json").write_text(json.dumps(joint))
    holes, target, off, law = numbers(match(folder, "double.json", "a"))
    factor = (3.2 / 9.6) ** (2 / 3) * 4.2 / 2
    near("huth composite in double shear", target, factor * (1 / (1.6 * 72400) * 1.5 + 1 / (3.2 * 71000) * 1.5), 1e-5)
    near("of one plane", 1 / law["k"], 2 * (target - holes), 1e-2)


def main():
    os.environ["PATH"] = f"{PROGRAMS}{os.pathsep}{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as name:
        folder = copy_example("lap_joint", Path(name))
        for sheet in ("upper", "lower"):
            run(folder, "stage1_plate", f"{sheet}.json", "-o", f"{sheet}.plate.h5")
            run(folder, "stage2_extract", f"{sheet}.plate.h5", "-o", f"{sheet}.matrices.h5")
        formulas(folder)
        others(folder)
    end_if_missed()


if __name__ == "__main__":
    main()
