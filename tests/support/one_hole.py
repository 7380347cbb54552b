# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets with a hole at their origin through the three programs, whose folder is the first argument of the test."""
import json
import subprocess
import sys
from pathlib import Path

import h5py

PROGRAMS = Path(sys.argv[1]).resolve()
RIGID = {"law": {"type": "rigid"}}
WIDE = [-60, -30, -12, -5, 5, 12, 30, 60]  # lines of a sheet of 120 radii
WIDER = [-480, -240, -120, *WIDE, 120, 240, 480]  # where the ends do not show, which along stiff fibres is far off
LAMINATES = {"E1/E2 = 14": (140e3, 10e3, 5e3, 0.3), "woven": (80e3, 80e3, 6.4e3, 0.05), "64/28/27": (64e3, 28e3, 27e3, 0.3)}
missed = []


def run(folder, program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments, "--quiet"], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(done.stderr)


def matrices(folder, scene, name="sheet"):
    (folder / f"{name}.json").write_text(json.dumps(scene))
    run(folder, "stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
    run(folder, "stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")


def state(folder, fasteners, loads, laws=RIGID, names=("sheet",)):
    """What RESULT.h5 says of the last sheet's holes at the load: hoop stress, its error, pressure and half of the angle of contact."""
    text = {"format": "joint", "version": 1, "plates": {name: f"{name}.h5" for name in names}, "laws": laws, "fasteners": fasteners,
            "loads": loads}
    (folder / "joint.json").write_text(json.dumps(text))
    run(folder, "stage3_nonlinear", "joint.json", "-o", "result.h5")
    with h5py.File(folder / "result.h5") as result:
        sheet = result[f"plates/{names[-1]}"]
        return {"against": sheet["rim/against_slip"][-1], "hoop": sheet["rim/peak_hoop"][-1], "bar": sheet["rim/peak_error"][-1],
                "pressure": sheet["contact/peak_pressure"][-1], "half-angle": sheet["contact/touching"][-1] / 2}


def plate(material, x, y, hole, radius=1, analysis="plane stress", **more):
    """PLATE.json of a grid with one hole about the origin."""
    return {"format": "plate", "version": 1, "analysis": analysis, "materials": {"m": material},
            "geometry": {"grid": {"x": x, "y": y, "thickness": 1}}, "holes": [{"id": "h", "center": [0, 0], "radius": radius, **hole}], **more}


def laminate(E1, E2, G12, nu12, angle=0):
    return {"E1": E1, "E2": E2, "G12": G12, "nu12": nu12, "angle": angle}


def near(name, found, truth, allowed, bar=None, absolute=False):
    """Tells how far a number is off, of itself unless `absolute`, and takes note if that is more than allowed."""
    off = found - truth if absolute else found / truth - 1
    good = abs(off) <= allowed
    tail = "" if bar is None else f", bar {bar / abs(truth):.1e}"
    print(f"{'' if good else 'MISSED '}{name}: {found:.6g}, truth {truth:.6g}, off by {off:+.1e}{tail}, allowed {allowed:.0e}", flush=True)
    if not good:
        missed.append(name)


def end_if_missed():
    if missed:
        sys.exit("MISSED: " + "; ".join(missed))
