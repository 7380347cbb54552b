# SPDX-License-Identifier: GPL-3.0-or-later
"""Half of a joint with discs along x and y equals the whole one: half holes on the line of symmetry keep its direction,
whole holes beside it move along both. Arguments: folder of the programs."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()


def run(folder, program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments, "--quiet"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stderr


def sheet(x, holes, half, contact, **more):
    """PLATE.json of a sheet along x, from y = 0 on or on both sides of it."""
    y = [0, 10, 30] if half else [-30, -10, 10, 30]
    spring = {"disk": {"E": 72000, "nu": 0.3}} | ({"compression_only": True} if contact else {})
    supports = more.pop("supports", []) + ([{"on": "bottom", "fix": ["y"]}] if half else [])
    return {"format": "plate", "version": 1, "analysis": "plane stress", "p": [5, 6],
            "materials": {"al": {"E": 72000, "nu": 0.3}}, "geometry": {"grid": {"x": x, "y": y, "thickness": 2}},
            "holes": [{"id": id, "center": at, "radius": 3, "spring": spring} for id, at in holes.items()],
            "supports": supports, **more}


def solve(folder, half, contact, mu, gap):
    """RESULT.h5 of a lap joint of a row on the line of symmetry and one on either side of it."""
    rows = {"on": 0, "up": 20} | ({} if half else {"down": -20})
    holes = {f"{row}{i}": [20 + 20 * i, y] for row, y in rows.items() for i in (0, 1)}
    pull = [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]
    plates = {"lower": sheet([-20, 10, 30, 50], holes, half, contact, supports=[{"on": "left", "fix": ["x", "y"]}]),
              "upper": sheet([10, 30, 50, 80], holes, half, contact, external=pull,
                             supports=[{"on": "right", "fix": ["y"]}])}
    for name, plate in plates.items():
        (folder / f"{name}.json").write_text(json.dumps(plate))
        run(folder, "stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
        run(folder, "stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")
    laws = {"full": {"type": "linear", "k": 40000}, "half": {"type": "linear", "k": 20000}}
    fasteners = [{"id": id, "between": [f"upper:{id}", f"lower:{id}"], "law": "half" if half and id[:2] == "on" else "full",
                  "friction": mu} | ({"gap": gap} if contact and id in ("up0", "down0") else {}) for id in holes]
    (folder / "joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {name: f"{name}.h5" for name in plates}, "laws": laws,
        "fasteners": fasteners, "loads": [{"external": "upper:P", "force": 6000 if half else 12000}]}))
    run(folder, "stage3_nonlinear", "joint.json", "-o", "joint.h5")
    # The state of the half holes, whose discs the file has along x alone, goes back to stage 2.
    run(folder, "stage2_extract", "upper.plate.h5", "--stresses", "joint.h5", "--plate", "upper", "-o", "stresses.h5")
    with h5py.File(folder / "stresses.h5") as f:
        peaks = dict(zip(f["plates/upper/rim/hole"].asstr(), f["plates/upper/rim/peak_hoop"][-1]))
    with h5py.File(folder / "joint.h5") as f:
        return (dict(zip(f["fastener/id"].asstr(), f["F_vector"][-1])), peaks,
                list(zip(f["plates/upper/disc/hole"].asstr(), f["plates/upper/disc/direction"].asstr())))


def main():
    for contact, mu, gap in ((False, 0, 0), (False, 0.2, 0), (True, 0, 0), (True, 0.2, 0.01), (True, 0.2, -0.002)):
        with tempfile.TemporaryDirectory() as name:
            whole, whole_peaks, _ = solve(Path(name), False, contact, mu, gap)
            half, half_peaks, discs = solve(Path(name), True, contact, mu, gap)
        assert discs == [("on0", "x"), ("on1", "x"), *((id, d) for id in ("up0", "up1") for d in "xy")], discs
        largest = max(np.linalg.norm(F) for F in whole.values())
        worst = max(np.abs(half[id] * (2 if id[:2] == "on" else 1) - whole[id]).max() for id in half) / largest
        of_peaks = max(abs(half_peaks[id] / whole_peaks[id] - 1) for id in half)
        print(f"contact {contact}, mu {mu}, gap {gap}: forces differ by {worst:.1e} of the largest, hoop peaks by "
              f"{of_peaks:.1e}; beside the line they are {half['up0']}")
        assert worst < 1e-6 and of_peaks < 1e-5 and abs(half["up0"][1]) > 0.01 * largest
        assert half["on0"][1] == half["on1"][1] == 0


main()
