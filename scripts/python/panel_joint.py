# SPDX-License-Identifier: GPL-3.0-or-later
"""Joints of n times n fasteners: a panel of scripts/measure/make_panel over another like it, pulled apart in ten increments."""
import random

LAWS = {"linear": {"type": "linear", "k": 1e6}, "power": {"type": "power", "A": 3e5, "n": 0.7},
        "bilinear": {"type": "bilinear", "k": 1e6, "k_yield": 2e5, "F_yield": 500}}
WITH_CLEARANCE = 0.19  # of the fasteners of the linear law
FORCE = 300  # of each fastener, on the average


def panel_joint(n, law, matrices, solver=None):
    """The JOINT.json of two panels with these MATRICES.h5 as a dict; `law` names one of LAWS."""
    draw = random.Random(1)
    fasteners = []
    for j in range(n):
        for i in range(n):
            fasteners.append({"id": f"{i},{j}", "between": [f"a:{i},{j}", f"b:{i},{j}"], "law": law})
            if law == "linear" and draw.random() < WITH_CLEARANCE:
                fasteners[-1]["clearance"] = draw.uniform(1e-5, 5e-4)
    return {"format": "joint", "version": 1, "plates": {"a": matrices, "b": matrices}, "laws": {law: LAWS[law]},
            "fasteners": fasteners, "increments": 10,
            "loads": [{"external": "a:P", "force": FORCE * n * n}, {"external": "b:P", "displacement": 0}],
            } | ({"solver": solver} if solver else {})
