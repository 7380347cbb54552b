# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers that no joint has are warned of: plausible_test.py BIN_FOLDER. That those of the examples are not is in schemas/agreement_test.py.

Each kind of warning is shown by the lap joint with one number spoiled, so that its code and what it names are those looked for.
"""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LAP = ROOT / "tests/pipeline/scenes/lap_joint"


def run(*words, statuses=(0, 4)):
    """What a program says on stderr; of a joint also if it does not converge."""
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert result.returncode in statuses, result.stderr
    return result.stderr


def solved(folder, sheets, joints, p, **statuses):
    """All that is said of sheets and joints, each a scene by its name."""
    said = ""
    for name, sheet in sheets.items():
        (folder / f"{name}.json").write_text(json.dumps(sheet))
        low, high = sheet.get("p", [1, 8])
        said += run("stage1_plate", folder / f"{name}.json", "-o", folder / f"{name}.h5", "--p", max(low, min(p, high)), "--quiet")
        run("stage2_extract", folder / f"{name}.h5", "-o", folder / f"{name}.matrices.h5", "--quiet")
    for name, joint in joints.items():
        (folder / f"{name}.json").write_text(json.dumps(joint))
        said += run("stage3_nonlinear", folder / f"{name}.json", "-o", folder / "result.h5", "--quiet", **statuses)
    return said


def scene(path):
    text = re.sub(r"^\s*//.*$", "", path.read_text(), flags=re.M)
    return json.loads(text)


def spoiled(change, **statuses):
    sheets = {name: scene(LAP / f"{name}.json") for name in ("upper", "lower")}
    joint = scene(LAP / "joint.json")
    change(sheets, joint)
    with tempfile.TemporaryDirectory() as name:
        return solved(Path(name), sheets, {"joint": joint}, 2, **statuses)


def swap(sheets, joint):
    first, second = (fastener["between"] for fastener in joint["fasteners"][:2])
    first[1], second[1] = second[1], first[1]


def formula(sheets, joint):
    joint["laws"]["rivet"] = {"type": "formula", "formula": "huth rivet", "mode": "fastener only", "shear": "single",
                              "t": [0.16, 0.16], "E": [72400, 72400], "d": 4.8, "E_f": 71000}


def double_shear(sheets, joint):
    formula(sheets, joint)
    joint["laws"]["rivet"].update(shear="double", t=[1.6, 1.6])


def wide_holes(sheets, joint):
    joint["fasteners"][0].update(diameter=5.4, hole_diameter=5.4)


def contact(sheets, joint):
    """All holes of the upper sheet only push; of the lower one those act on an arc."""
    for hole in sheets["upper"]["holes"]:
        hole["spring"]["compression_only"] = True
    for hole in sheets["lower"]["holes"]:
        hole["spring"]["arc"] = [-90, 90]


def disk(sheets, joint):
    sheets["upper"]["materials"]["2024-T3"]["E"] = 72.4


def gigapascals(sheets, joint):
    for sheet in sheets.values():
        sheet["materials"]["2024-T3"]["E"] = 72.4
        for hole in sheet["holes"]:
            hole["spring"]["disk"]["E"] = 71


KINDS = {  # code and place or number: how it comes about
    ("holes-apart", "/fasteners/0/between: "): swap,
    ("gap-unlikely", "/fasteners/1/clearance: the gap"): lambda sheets, joint: joint["fasteners"][1].update(clearance=20),
    ("holes-apart", "more than a tenth of the radius 2.4"): lambda sheets, joint: sheets["upper"]["holes"][0]["center"].__setitem__(1, 0.3 + sheets["upper"]["holes"][0]["center"][1]),
    ("expansion-missing", '"fastener_temperature" does nothing at '): lambda sheets, joint: joint.update(fastener_temperature=50),
    ("friction-unlikely", "/fasteners/0/friction: 15 "): lambda sheets, joint: joint["fasteners"][0].update(friction=15),
    ("formula-sheets-unlike", "t = 0.16, 0.16 instead of 1.6"): formula,
    ("formula-shear-unlike", '/laws/rivet/shear: "double", but the fastener goes through 2 sheets'): double_shear,
    ("hole-diameter-unlike", "/fasteners/0/hole_diameter: 5.4 "): wide_holes,
    ("units-mixed", "is above the radius 2.4 "): lambda sheets, joint: joint["loads"][0].update(force=4e8),
    ("thickness-unlikely", "is above the width 40 "): lambda sheets, joint: sheets["upper"]["geometry"]["grid"].update(thickness=1600),
    ("thickness-unlikely", "of the radius 2.4 "): lambda sheets, joint: sheets["upper"]["geometry"]["grid"].update(thickness=1.6e-6),
    ("units-mixed", "is above d t E = "): gigapascals,
    ("disc-modulus-unlikely", "/holes/0/spring/disk/E: 71000 is 981 times the modulus 72.4 of the sheet (the worst of 4)"): disk,
}


def check_kinds():
    for (code, words), change in KINDS.items():
        said = spoiled(change)
        assert any(f"warning [{code}]: " in line and words in line for line in said.splitlines()), (code, words, said)


def check_sheets_of_a_formula():
    """A rivet through three sheets is in double shear if the middle one pulls against the others, and in a pack each plane is in single shear."""
    strip = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": {"E": 72400, "nu": 0.33}},
             "geometry": {"grid": {"x": [-40, 40], "y": [-10, 10], "thickness": 2}}, "holes": [{"id": "1", "center": [0, 0], "radius": 2.4, "spring": {"disk": {"E": 71000, "nu": 0.33}}}]}
    held, pulled = {"supports": [{"on": "left", "fix": ["x", "y"]}]}, {"supports": [{"on": "bottom", "fix": ["y"]}], "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}
    free = {"supports": pulled["supports"]}
    for shear, ends, said in (("single", (held, pulled, held), True), ("single", (held, free, pulled), False),
                              ("double", (held, pulled, held), False), ("double", (held, free, pulled), True)):
        law = {"type": "formula", "formula": "huth rivet", "mode": "fastener only", "shear": shear, "t": [2, 2], "E": [72400, 72400], "d": 4.8, "E_f": 71000}
        joint = {"format": "joint", "version": 1, "plates": {name: f"{name}.matrices.h5" for name in "abc"}, "laws": {"rivet": law},
                 "fasteners": [{"id": "1", "between": ["a:1", "b:1", "c:1"], "law": "rivet"}],
                 "loads": [{"external": f"{name}:P", "force": 100} for name, end in zip("abc", ends) if "external" in end]}
        with tempfile.TemporaryDirectory() as folder:
            told = solved(Path(folder), {name: strip | end for name, end in zip("abc", ends)}, {"joint": joint}, 2)
        assert ("[formula-shear-unlike]" in told) == said, (shear, ends, told)


def check_bearing_externals():
    """Two externals that press one hole along x and y at once are said; each is one line of the summary, with its force."""
    sheet = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": {"E": 71000, "nu": 0.33}},
             "geometry": {"grid": {"x": [-60, -15, 15], "y": [-15, 15], "thickness": 3}}, "supports": [{"on": "left", "fix": ["x", "y"]}],
             "holes": [{"id": "d", "center": [-40, 0], "radius": 2, "spring": {"disk": {"E": 71000, "nu": 0.33}}}, {"id": "h", "center": [0, 0], "radius": 3}],
             "external": [{"id": f"b{axis}", "on": "h", "direction": axis, "kind": "bearing"} for axis in "xy"]}
    with tempfile.TemporaryDirectory() as folder:
        for forces, said in (((3000, 0), False), ((-3000, 0), False), ((2100, -2100), True)):
            joint = {"format": "joint", "version": 1, "plates": {"s": "s.matrices.h5"}, "laws": {"l": {"type": "linear", "k": 1e-3}},
                     "fasteners": [{"id": "d", "between": ["s:d", "ground"], "law": "l"}],
                     "loads": [{"external": f"s:b{axis}", "force": force} for axis, force in zip("xy", forces)]}
            told = solved(Path(folder), {"s": sheet}, {"joint": joint}, 2)
            assert ("[bearing-oblique]" in told) == said, (forces, told)
            printed = subprocess.run(["stage3_nonlinear", f"{folder}/joint.json", "-o", f"{folder}/result.h5"], capture_output=True, text=True).stdout
            lines = [line.split() for line in printed.splitlines() if line.startswith("  s:b") and " force " in line]
            assert [(line[0], float(line[2])) for line in lines] == [("s:bx", forces[0]), ("s:by", forces[1])], (forces, lines)


def check_clearance_in_contact():
    said = spoiled(contact, statuses=[2])
    assert "/fasteners/1/clearance: 0.02 is free play" in said and 'write "gap": [0.02, 0] instead' in said, said


if __name__ == "__main__":
    os.environ["PATH"] = os.path.abspath(sys.argv[1]) + os.pathsep + os.environ["PATH"]
    check_kinds()
    check_sheets_of_a_formula()
    check_bearing_externals()
    check_clearance_in_contact()
