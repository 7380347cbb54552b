# SPDX-License-Identifier: GPL-3.0-or-later
"""A load in a hole bears on the side that it points to: a sheet and its mirror image under the mirrored load do the same,
on one path through both signs. Argument: folder of the programs."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()
FACTORS = [0.5, 1, -0.25, -1, 0.5]


def run(program, *arguments, status=0, quiet=True):
    """What the program says of doubts, or prints."""
    done = subprocess.run([PROGRAMS / program, *arguments, *["--quiet"] * quiet], capture_output=True, text=True)
    assert done.returncode == status, done.stderr
    return done.stderr if quiet else done.stdout


def matrices(name, mirrored, contact, directions):
    """A bracket on two bolts and its lug, or their image beyond y = 15."""
    spring = {"disk": {"E": 205000, "nu": 0.3}} | ({"compression_only": True, "harmonics": 6} if contact else {})
    at = lambda x, y: [x, 30 - y if mirrored else y]
    y = [0, 14, 30]
    Path(f"{name}.json").write_text(json.dumps({
        "format": "plate", "version": 1, "analysis": "plane stress", "p": [2, 3], "disc_directions": directions,
        "materials": {"al": {"E": 71000, "nu": 0.33}},
        "geometry": {"grid": {"x": [0, 16, 40], "y": sorted(30 - each for each in y) if mirrored else y, "thickness": 3}},
        "holes": [{"id": "1", "center": at(8, 6), "radius": 2, "spring": spring},
                  {"id": "2", "center": at(7, 22), "radius": 2, "spring": spring},
                  {"id": "L", "center": at(28, 23), "radius": 3}],
        "external": [{"id": "Lx", "on": "L", "direction": "x", "kind": "bearing"},
                     {"id": "Ly", "on": "L", "direction": "y", "kind": "bearing"}]}))
    run("stage1_plate", f"{name}.json", "-o", f"{name}.plate.h5")
    run("stage2_extract", f"{name}.plate.h5", "-o", f"{name}.h5")


def joint(name, law, Ly, Lx=0.0, increments=FACTORS, status=0, **more):
    Path("joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"b": f"{name}.h5"}, "laws": {"l": law},
        "fasteners": [{"id": id, "between": [f"b:{id}", "ground"], "law": "l"} for id in "12"],
        "loads": [{"external": "b:Lx", "force": Lx}, {"external": "b:Ly", "force": Ly}], "increments": increments, **more}))
    return run("stage3_nonlinear", "joint.json", "-o", f"{name}.result.h5", "--sensitivities", "--rim-stresses", status=status)


def read(name, *datasets):
    with h5py.File(f"{name}.result.h5") as file:
        return [file[dataset][:] for dataset in datasets]


def close(what, a, b, share=1e-7):
    worst = np.abs(np.subtract(a, b)).max() / np.abs(b).max()
    print(f"{what}: {worst:.1e}")
    assert worst < share, (what, a, b)


def mirrored_path(contact):
    matrices("sheet", False, contact, ["x", "y"])
    matrices("image", True, contact, ["x", "y"])
    law = {"type": "power", "A": 150000, "n": 0.9}
    joint("sheet", law, 800, 300)
    joint("image", law, -800, 300)
    names = ("F_vector", "plates/b/rim/peak_hoop", "stiffness/tangent", "sensitivity/force", "sensitivity/load_factor",
             "plates/b/traction/force", "F_error")
    (F, peak, tangent, by_force, by_factor, forces, error), image = read("sheet", *names), read("image", *names)
    close("F", image[0] * [1, -1], F)
    close("peaks", image[1], peak)
    close("tangent stiffness", image[2], tangent)
    close("dF by forces", image[3] * [1, -1], by_force)
    close("dF by the load factor", image[4], by_factor)
    close("error of F", image[6], error)
    # Each force is of the case of its side.
    assert np.array_equal(forces, np.outer(FACTORS, [300, 300, 800, 800]) * [np.array([f > 0, f < 0] * 2) for f in FACTORS])
    joint("image", law, 800, -300, increments=[-f for f in FACTORS])
    close("F, load factors of the other sign", read("image", "F_vector")[0] * [1, -1], F)
    # Slopes are those of the path on either side.
    for factor in (1, -1):
        joint("sheet", law, 800, 300, increments=[factor * (1 + h) for h in (-1e-4, 0, 1e-4)])
        F, by_factor, by_force = read("sheet", "F", "sensitivity/load_factor", "sensitivity/force")
        close("slope by differences", factor * (F[2] - F[0]) / 2e-4, by_factor[1], 1e-5)
        close("the same by forces", by_force[1] @ [300, 800], factor * by_factor[1])
    joint("sheet", law, 800, 300)
    joint("image", law, -800, 300)
    mirrored_stresses()


def mirrored_stresses():
    """Around holes, and back in stage 2, where each side is its own case."""
    names = [f"plates/b/rim/{name}" for name in ("start", "angle", "sigma_rr", "sigma_tt", "sigma_rt")]
    (start, angle, *stresses), (_, _, *image) = read("sheet", *names), read("image", *names)
    mirrored = np.concatenate([first + (-np.arange(last - first) % (last - first)) for first, last in zip(start, start[1:])])
    assert np.allclose((angle + angle[mirrored]) % 360, 0)
    close("stresses around holes", np.stack(image)[:, :, mirrored] * np.reshape([1, 1, -1], (3, 1, 1)), np.stack(stresses))
    for increment in (1, 3):
        largest = [float(re.search(r"largest von Mises stress (\S+)", run("stage2_extract", f"{name}.plate.h5", "--field",
                                   f"{name}.result.h5", "--increment", str(increment), "-o", "field.vtu", quiet=False))[1])
                   for name in ("sheet", "image")]
        close("largest stress of a field", largest[0], largest[1], 1e-5)


def corners():
    """Bilinear laws with clearance, along y alone: solvers and events agree on either side."""
    matrices("sheet", False, False, ["y"])
    matrices("image", True, False, ["y"])
    law = {"type": "bilinear", "k": 50000, "F_yield": 400, "k_yield": 5000, "reversible": True}
    found = {}
    for method in ("hybridsj", "damped newton"):
        joint("sheet", law, 1000, solver={"method": method, "tolerance": 1e-12})
        found[method], = read("sheet", "F")
    close("two solvers", found["damped newton"], found["hybridsj"])
    joint("sheet", law, -1000, increments="events")
    joint("image", law, 1000, increments="events")
    (load, F), image = read("sheet", "load_factor", "F"), read("image", "load_factor", "F")
    assert len(load) > 1, load
    close("events", image[0], load)
    close("F at events", -image[1], F)
    close("F at the end", F[-1], found["hybridsj"][3])


def one_side_alone():
    plate = json.loads(Path("sheet.json").read_text())
    plate["holes"][2]["center"] = [0, 22]  # of this hole the model has the side +x
    plate["holes"][1]["center"] = [28, 22]
    plate["external"] = plate["external"][:1]
    plate["supports"] = [{"on": "left", "fix": ["x"]}]
    Path("half.json").write_text(json.dumps(plate))
    run("stage1_plate", "half.json", "-o", "half.plate.h5")
    run("stage2_extract", "half.plate.h5", "-o", "half.h5")
    text = {"format": "joint", "version": 1, "plates": {"b": "half.h5"}, "laws": {"l": {"type": "linear", "k": 1000}},
            "fasteners": [{"id": id, "between": [f"b:{id}", "ground"], "law": "l"} for id in "12"]}
    for force, increments, status in ((10, 1, 0), (-10, 1, 2), (10, [1, -1], 2), (-10, "events", 2)):
        loads = [{"external": "b:Lx", "force": force}]
        Path("joint.json").write_text(json.dumps(text | {"loads": loads, "increments": increments}))
        message = run("stage3_nonlinear", "joint.json", "-o", "half.result.h5", status=status)
        assert status == 0 or all(part in message for part in ("joint.json: /loads/0", "no rim", "half.h5")), message


def main():
    for contact in (False, True):
        mirrored_path(contact)
    corners()
    one_side_alone()


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    main()
