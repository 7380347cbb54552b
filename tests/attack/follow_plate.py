# SPDX-License-Identifier: GPL-3.0-or-later
"""A joint for any sheet: every disc fastened to the ground, every external loaded."""
import json

import h5py
import numpy as np


def joint_on_ground(matrices, path):
    """Writes JOINT.json for the sheet of MATRICES.h5; False if it has nothing to fasten or to load.

    Laws are as stiff as the sheet, and loads such that displacements come to about a thousandth of it, so that nothing
    in the joint is wild that is not so in the sheet.
    """
    with h5py.File(matrices) as file:
        holes = list(dict.fromkeys(file["disc/hole"].asstr()[:]))
        stiffness = float(np.abs(file["S_dd"][-1]).max()) if holes else 0.0
        externals = [*text(file, "external/id"), *text(file, "traction/id")]
        arms = np.array(file["traction/arm"]) if "traction/arm" in file else np.zeros(0)
        n_rigid = len(text(file, "external/id"))
    if not holes or not externals or not 0 < stiffness < 1e300:
        return False
    loads, seen = [], set()
    for i, external in enumerate(externals):
        if external not in seen:
            arm = arms[i - n_rigid] if n_rigid <= i < n_rigid + len(arms) else 0
            loads.append({"external": f"sheet:{external}"} | ({"moment": 1e-3 * stiffness * arm} if arm > 0 else
                                                             {"force": 1e-3 * stiffness}))
        seen.add(external)
    fasteners = [{"id": str(i), "between": [f"sheet:{hole}", "ground"], "law": "k"} for i, hole in enumerate(holes)]
    path.write_text(json.dumps({"format": "joint", "version": 1, "plates": {"sheet": matrices.name},
                                "laws": {"k": {"type": "linear", "k": stiffness}}, "fasteners": fasteners,
                                "loads": loads, "increments": 2}))
    return True


def text(file, name):
    return list(file[name].asstr()[:]) if name in file else []
