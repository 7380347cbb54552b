# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets that supports hold without statical indeterminacy, or softly, are joined: forces are those of statics.
Argument: folder of the programs."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()


def run(program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def sheet(name, x, y, center, spring, p, **more):
    plate = {"format": "plate", "version": 1, "analysis": "plane stress", "p": p,
             "materials": {"al": {"E": 72000, "nu": 0.33}}, "geometry": {"grid": {"x": x, "y": y, "thickness": 2}},
             "holes": [{"id": "1", "center": center, "radius": 2, "spring": {"disk": {"E": 110000, "nu": 0.3}} | spring}],
             **more}
    Path(f"{name}.json").write_text(json.dumps(plate))
    run("stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
    run("stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")
    with h5py.File(f"{name}.h5") as file:
        return list(file["unsupported"].asstr()) if "unsupported" in file else None


def joined():
    """Force of the one bolt, and the summary."""
    Path("joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"lo": "lo.h5", "up": "up.h5"},
        "laws": {"l": {"type": "linear", "k": 40000}}, "loads": [{"external": "up:P", "force": 3000}],
        "fasteners": [{"id": "1", "between": ["up:1", "lo:1"], "law": "l"}]}))
    text = run("stage3_nonlinear", "joint.json", "-o", "result.h5")
    with h5py.File("result.h5") as file:
        return file["F_vector"][-1, 0], text


def main():
    pull = {"external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]}
    # The roller of the upper sheet is 28 from its bolt, which is 0.5 above the line of the load.
    clamped = sheet("lo", [-22, 0, 12], [0, 14], [3, 7.5], {}, [5, 6], supports=[{"on": "left", "fix": ["x", "y"]}])
    roller = sheet("up", [0, 12, 31], [0, 14], [3, 7.5], {}, [5, 6], supports=[{"on": "right", "fix": ["y"]}], **pull)
    F, text = joined()
    print("bolt and roller:", F)
    assert np.allclose(F, [3000, -1500 / 28], rtol=0, atol=1e-4), F
    assert "sheet along axes without supports by" in text, text
    assert (clamped, roller) == ([], ["x"]), (clamped, roller)
    with h5py.File("up.h5", "a") as file:  # as before version 1.7
        del file["unsupported"]
    F, text = joined()
    assert np.allclose(F, [3000, -1500 / 28], rtol=0, atol=1e-4) and "sheet along axes" not in text, text

    # A strip that bends under the smallest force beside the stiffness of the shortest of 32 waves.
    waves = {"compression_only": True, "harmonics": 32}
    sheet("lo", [-400, -10, 10], [0, 20], [0, 10], waves, [5, 6], supports=[{"on": "left", "fix": ["x", "y"]}])
    sheet("up", [-10, 10, 40], [0, 20], [0, 10], waves, [5, 6], supports=[{"on": "bottom", "fix": ["y"]}], **pull)
    F, _ = joined()
    print("slender strip:", F)
    assert abs(F[0] / 3000 - 1) < 1e-8, F


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
