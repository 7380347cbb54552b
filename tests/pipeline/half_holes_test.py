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

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = Path(sys.argv[1]).resolve()
sys.path.insert(0, str(ROOT / "scripts/python"))
sys.dont_write_bytecode = True
from stress_field import Field  # noqa: E402


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
    """What `read` finds of a lap joint of a row on the line of symmetry and one on either side of it."""
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
    run(folder, "stage3_nonlinear", "joint.json", "-o", "joint.h5", "--rim-stresses")
    # The state of the half holes, whose discs the file has along x alone, goes back to stage 2.
    run(folder, "stage2_extract", "upper.plate.h5", "--field", "joint.h5", "--plate", "upper", "-o", "field.vtu")
    return read(folder / "joint.h5", Field(folder / "field.vtu"))


def read(path, field):
    """Forces of the fasteners, of the upper sheet the peaks and the stresses one degree apart around its holes, its discs,
    and stresses of von Mises at its nodes."""
    with h5py.File(path) as f:
        plate = f["plates/upper"]
        rim = plate["rim"]
        table = np.column_stack([rim["angle"][:], *(rim[f"sigma_{kind}"][-1] for kind in ("rr", "tt", "rt"))])
        holes = list(rim["hole"].asstr())
        return (dict(zip(f["fastener/id"].asstr(), f["F_vector"][-1])), dict(zip(holes, rim["peak_hoop"][-1])),
                dict(zip(holes, np.split(table, rim["start"][1:-1]))),
                list(zip(plate["disc/hole"].asstr(), plate["disc/direction"].asstr())),
                {tuple(at): stress for at, stress in zip(field.points["points"].reshape(-1, 3)[:, :2].round(6).tolist(),
                                                         field.points["von_mises"].ravel())})


def apart(table, whole):
    """Largest difference of stresses around a hole, but for the place where friction may jump: 180 degrees."""
    there = table[:, 0] != 180
    return np.abs(table - whole[:len(table)])[there].max()


def main():
    for contact, mu, gap in ((False, 0, 0), (False, 0.2, 0), (True, 0, 0), (True, 0.2, 0.01), (True, 0.2, -0.002)):
        with tempfile.TemporaryDirectory() as name:
            whole, whole_peaks, whole_rims, _, whole_field = solve(Path(name), False, contact, mu, gap)
            half, half_peaks, half_rims, discs, half_field = solve(Path(name), True, contact, mu, gap)
        assert discs == [("on0", "x"), ("on1", "x"), *((id, d) for id in ("up0", "up1") for d in "xy")], discs
        largest = max(np.linalg.norm(F) for F in whole.values())
        worst = max(np.abs(half[id] * (2 if id[:2] == "on" else 1) - whole[id]).max() for id in half) / largest
        of_peaks = max(abs(half_peaks[id] / whole_peaks[id] - 1) for id in half)
        of_rims = max(apart(table, whole_rims[id]) / whole_peaks[id] for id, table in half_rims.items())
        assert [len(half_rims[id]) for id in ("on0", "up0")] == [181, 360]
        of_fields = max(abs(stress - whole_field[at]) for at, stress in half_field.items()) / max(half_field.values())
        print(f"contact {contact}, mu {mu}, gap {gap}: forces differ by {worst:.1e} of the largest, hoop peaks by "
              f"{of_peaks:.1e}, stresses around holes by {of_rims:.1e}, fields by {of_fields:.1e}; beside the line they are "
              f"{half['up0']}")
        assert worst < 1e-6 and of_peaks < 1e-5 and abs(half["up0"][1]) > 0.01 * largest
        assert of_rims < 1e-5 and of_fields < 1e-5
        assert half["on0"][1] == half["on1"][1] == 0


main()
