# SPDX-License-Identifier: GPL-3.0-or-later
"""Three bolts in line in double shear as a stack of three sheets, against the analysis of NACA TN 1051 (Tate and Rosenfeld,
1946): bolt_row_test.py BIN_FOLDER.

The report's analysis takes sheets for bars and a bolt for a flexibility C: shear and bending of the bolt, and bearing of bolt,
plate and straps. For its three-bolt joints with 1/4 in steel bolts it gives the end bolts 0.365, 0.354 and 0.378 of the load,
3 to 10 % off the tests. The dimensions of its specimens are not known here: the plate is 3/16 in, straps are half as thick, all 1 in
wide, and the pitch is such that the analysis gives these shares. In the stack the holes give what the bars and the bearing
stand for in the analysis; the bolts only shear and bend.
"""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np
from scipy.optimize import brentq

E, NU, E_BOLT, NU_BOLT, D, PLATE, STRAP, WIDTH = 10.5e6, 0.33, 29e6, 0.3, 0.25, 3 / 16, 3 / 32, 1.0
SHARES = 0.365, 0.354, 0.378


def of_bolt():
    """Flexibility of a bolt in double shear by its shear and bending, both planes together (TN 1051, equation (18))."""
    A, I, G = np.pi * D**2 / 4, np.pi * D**4 / 64, E_BOLT / (2 * (1 + NU_BOLT))
    bending = 8 * STRAP**3 + 16 * STRAP**2 * PLATE + 8 * STRAP * PLATE**2 + PLATE**3
    return (2 * STRAP + PLATE) / (3 * G * A) + bending / (192 * E_BOLT * I)


def of_bearing():
    """The rest of C: bearing of the bolt, of both straps and of the plate."""
    return (2 * STRAP + PLATE) / (STRAP * PLATE * E_BOLT) + 1 / (STRAP * E) + 2 / (PLATE * E)


def analysis(pitch):
    """Shares of the load of the three bolts by bars and C; the straps hold on the left, the plate is pulled on the right."""
    C, plate, straps = of_bolt() + of_bearing(), pitch / (E * WIDTH * PLATE), pitch / (E * WIDTH * 2 * STRAP)
    A = [[1, 1, 1], [-C - plate, C + straps, straps], [-plate, -C - plate, C + straps]]
    return np.linalg.solve(A, [1, 0, 0])


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def stack(pitch):
    """Shares of the three bolts in the stack, each the force of both its planes."""
    edge = 2 * D
    lines = [-edge - pitch / 2, *(pitch * (i - 0.5) for i in range(1, 4)), 2 * pitch + edge + pitch / 2]
    holes = [{"id": str(i + 1), "center": [i * pitch, WIDTH / 2], "radius": D / 2, "rings": 2,
              "spring": {"compression_only": True, "disk": {"E": E_BOLT, "nu": NU_BOLT, "law": "elastic"}}} for i in range(3)]
    for name, thickness, x in (("plate", PLATE, [-edge, *lines[1:3], lines[-1]]), ("strap", STRAP, [lines[0], *lines[1:3], 2 * pitch + edge])):
        sheet = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"24S-T": {"E": E, "nu": NU}},
                 "disc_directions": ["x"], "geometry": {"grid": {"x": x, "y": [0, WIDTH], "thickness": thickness}}, "holes": holes}
        if name == "plate":
            sheet["external"] = [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}]
            sheet["supports"] = [{"on": "right", "fix": ["y"]}]
        else:
            sheet["supports"] = [{"on": "left", "fix": ["x", "y"]}]
        Path(f"{name}.json").write_text(json.dumps(sheet))
        run("stage1_plate", f"{name}.json", "-o", f"{name}.h5", "--p", "5..8")
        run("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5")
    joint = {"format": "joint", "version": 1, "plates": {"top": "strap.matrices.h5", "plate": "plate.matrices.h5", "bottom": "strap.matrices.h5"},
             "laws": {"bolt": {"type": "linear", "k": 1 / (2 * of_bolt())}},
             "fasteners": [{"id": i, "between": [f"top:{i}", f"plate:{i}", f"bottom:{i}"], "law": "bolt"} for i in "123"],
             "loads": [{"external": "plate:P", "force": 1000}]}
    Path("joint.json").write_text(json.dumps(joint))
    run("stage3_nonlinear", "joint.json", "-o", "joint.h5")
    with h5py.File("joint.h5") as f:
        forces = np.abs(f["F"][-1]).reshape(3, 2)
        assert np.allclose(forces[:, 0], forces[:, 1], rtol=1e-6), "both straps are the same"
        assert abs(forces.sum() - 1000) < 1e-6
        return forces.sum(axis=1) / 1000


def main():
    os.environ["PATH"] = f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for share in SHARES:
            pitch = brentq(lambda pitch: analysis(pitch)[0] - share, 0.6, 6)
            ours = stack(pitch)
            print(f"pitch {pitch:.3f} in: analysis {share:.3f}, {1 - 2 * share:.3f}, {share:.3f}; stack {ours[0]:.3f}, {ours[1]:.3f}, {ours[2]:.3f}")
            assert abs(ours[0] - ours[2]) < 2e-3, "plate and straps are equally stiff"
            assert share < ours[0] < 1.11 * share, (share, ours)
        os.chdir("/")


main()
