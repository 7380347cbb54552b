# SPDX-License-Identifier: GPL-3.0-or-later
"""The order of the holes of a sheet changes nothing but the order of the results: whole holes, half holes on a vertical and
on a horizontal line of symmetry, springs, contact and friction. Argument: folder of the programs."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

PROGRAMS = Path(sys.argv[1]).resolve()
CENTERS = {"vertical": [0, 30], "horizontal": [30, 0], "whole": [30, 30]}
# Of the lower, then of the upper sheet; half holes come first in all but the first.
ORDERS = [(["whole", "vertical", "horizontal"],) * 2,
          (["vertical", "horizontal", "whole"], ["horizontal", "whole", "vertical"]),
          (["horizontal", "vertical", "whole"], ["vertical", "whole", "horizontal"])]


def run(program, *arguments):
    done = subprocess.run([PROGRAMS / program, *arguments, "--quiet"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def matrices(name, order, contact, thickness, external):
    spring = {"disk": {"E": 72000, "nu": 0.3}} | ({"compression_only": True, "harmonics": 6} if contact else {})
    Path(f"{name}.json").write_text(json.dumps({
        "format": "plate", "version": 1, "analysis": "plane stress", "p": [2, 3],
        "materials": {"al": {"E": 72000, "nu": 0.3}},
        "geometry": {"grid": {"x": [0, 15, 45], "y": [0, 15, 45], "thickness": thickness}},
        "holes": [{"id": id, "center": CENTERS[id], "radius": 3, "spring": spring} for id in order],
        "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}], "external": external}))
    run("stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
    run("stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")


def results(orders, contact):
    """Numbers of a joint by their names."""
    matrices("lower", orders[0], contact, 2, [])
    matrices("upper", orders[1], contact, 3, [{"id": "X", "on": "right", "direction": "x", "kind": "rigid"},
                                              {"id": "Y", "on": "top", "direction": "y", "kind": "traction"}])
    Path("joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"lower": "lower.h5", "upper": "upper.h5"},
        "laws": {"l": {"type": "power", "A": 40000, "n": 0.8}},
        "fasteners": [{"id": id, "between": [f"upper:{id}", f"lower:{id}"], "law": "l", "friction": 0.1}
                      for id in CENTERS],
        "loads": [{"external": "upper:X", "force": 3000}, {"external": "upper:Y", "force": 2000}]}))
    run("stage3_nonlinear", "joint.json", "-o", "result.h5")
    named = {}
    with h5py.File("result.h5") as file:
        for i, id in enumerate(file["fastener/id"].asstr()):
            for d, direction in enumerate(file["direction"].asstr()):
                named["F", id, direction] = file["F_vector"][-1, i, d]
            named["error", id] = file["F_error"][-1, i]
        for name in ("lower", "upper"):
            plate = file[f"plates/{name}"]
            for i, disc in enumerate(zip(plate["disc/hole"].asstr(), plate["disc/direction"].asstr())):
                named["D", name, *disc] = 1e5 * plate["D"][-1, i]
            for i, id in enumerate(plate["rim/hole"].asstr()):
                named["peak", name, id] = plate["rim/peak_hoop"][-1, i]
    return named


def main():
    for contact in (False, True):
        expected = results(ORDERS[0], contact)
        largest = max(map(abs, expected.values()))
        assert min(abs(expected["F", "vertical", "y"]), abs(expected["F", "horizontal", "x"])) > 0.01 * largest, expected
        for orders in ORDERS[1:]:
            found = results(orders, contact)
            assert found.keys() == expected.keys()
            worst = max(expected, key=lambda name: abs(found[name] - expected[name]))
            print(f"contact {contact}, {orders}: {worst} differs most, {found[worst]} and {expected[worst]}")
            assert abs(found[worst] - expected[worst]) < 1e-7 * largest


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
