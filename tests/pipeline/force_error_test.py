# SPDX-License-Identifier: GPL-3.0-or-later
"""F_error against the true errors of F, by joints of the same sheets on a finer mesh: force_error_test.py BIN_FOLDER."""
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
DEGREES = range(3, 9)
MOST = 1             # true error over the error bar, of any fastener
LEAST_MEDIAN = 0.03  # of all fasteners of all joints: nothing cancels in the bar, in the error between plates much does


def run(*words):
    subprocess.run([str(word) for word in words], check=True, capture_output=True)


def sheet(nx, ny, thickness, directions, pulled):
    """A panel as scripts/measure/make_panel prints it, with other names and loads; held at the left if it is not pulled."""
    scene = json.loads(subprocess.run([ROOT / "scripts/measure/make_panel", str(nx), str(ny)], check=True, capture_output=True,
                                      text=True).stdout)
    scene["geometry"]["grid"]["thickness"] = thickness
    scene["disc_directions"] = directions
    scene["supports"] = [{"on": "bottom", "fix": ["y"]}] + ([] if pulled else [{"on": "left", "fix": ["x"]}])
    scene["external"] = [{"id": "P", "on": "right", "direction": "x", "kind": pulled}] if pulled else []
    return scene


def matrices(name, scene, rings, *words):
    for hole in scene["holes"]:
        hole["rings"] = rings
    Path(f"{name}.json").write_text(json.dumps(scene))
    run("stage1_plate", f"{name}.json", "-o", f"{name}.h5", *words)
    run("stage2_extract", f"{name}.h5", "-o", f"{name}.m.h5", "--loads-only")


def make(plates):
    for name, scene in plates.items():
        matrices(f"{name}.coarse", scene, 0)
        matrices(f"{name}.fine", scene | {"space": "product"}, 3, "--p", "8")


def solve(scene, mesh, *words):
    """F and F_error, which is not there where it is not known."""
    scene = scene | {"plates": {name: f"{name}.{mesh}.m.h5" for name in scene["plates"]}}
    Path("joint.json").write_text(json.dumps(scene))
    run("stage3_nonlinear", "joint.json", "-o", "joint.h5", "--csv", "joint.csv", *words)
    with h5py.File("joint.h5") as f:
        return f["F"][:], f["F_error"][:] if "F_error" in f else None


def joint(plates, holes, dice):
    laws = [{"type": "linear", "k": 10 ** dice.uniform(4, 7)},
            {"type": "power", "A": 10 ** dice.uniform(4, 6), "n": dice.uniform(0.5, 1)}]
    first, second = plates
    load = {"force": 1000} if dice.random() < 0.5 or plates[first]["external"][0]["kind"] != "rigid" \
        else {"displacement": 1e-2}
    return {"format": "joint", "version": 1, "plates": list(plates), "laws": {"law": dice.choice(laws)},
            "fasteners": [{"id": hole, "between": [f"{first}:{hole}", f"{second}:{hole}"], "law": "law",
                           "clearance": dice.choice([0, 0, 1e-5, 1e-4]), "friction": dice.choice([0, 0, 0.2])}
                          for hole in holes],
            "loads": [{"external": f"{first}:P"} | load], "increments": 2}


def ratios(scene):
    fine, unknown = solve(scene, "fine")
    assert unknown is None, "one degree alone shows no error"
    assert ",F_error [" in Path("joint.csv").read_text().splitlines()[0]
    found = []
    for p in DEGREES:
        F, bar = solve(scene, "coarse", "--p", p)
        bears = (np.abs(fine) > 1e-3 * np.abs(fine).max()) & (np.abs(F) > 0)
        ratio = (np.abs(F - fine) / bar)[bears]
        assert ratio.max() < MOST, (p, ratio, scene)
        found += list(ratio)
    return found


def three_fasteners():
    folder = ROOT / "examples/three_fasteners"
    plates = {name: json.loads((folder / f"{name}.json").read_text()) for name in ("center", "doubler")}
    scene = json.loads((folder / "joint.json").read_text())
    make(plates)
    return ratios(scene | {"plates": list(plates)})


def random_joints():
    dice = random.Random(1)
    found = []
    for nx, ny, directions, kind in ((3, 1, ["x"], "rigid"), (2, 2, ["x"], "traction"), (2, 2, ["x", "y"], "rigid")):
        plates = {"upper": sheet(nx, ny, 0.1, directions, kind), "lower": sheet(nx, ny, 0.06, directions, None)}
        make(plates)
        for _ in range(4):
            found += ratios(joint(plates, [hole["id"] for hole in plates["upper"]["holes"]], dice))
    return found


def main(folder):
    os.environ["PATH"] = folder + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        for found in (three_fasteners(), random_joints()):
            print(f"true error / bar: {min(found):.2g} ... {np.median(found):.2g} ... {max(found):.2g}")
            assert np.median(found) > LEAST_MEDIAN, np.median(found)
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
