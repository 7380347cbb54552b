# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the joint files of one study of Bortman & Szabo, section 6.2: joints.py STUDY FOLDER."""
import json
import sys
from pathlib import Path

# Quarter decades of stiffness, lb/in; clearances of fastener 1, in (1e3: never in contact); friction coefficients.
STIFFNESSES = [10 ** (i / 4) for i in range(0, 29)]
CLEARANCES = [1e3, 0.18, 0.12, 0.06, 0]
FRICTIONS = [0, 0.1, 0.2, 0.3]


def joint(k, load, increments=1, clearance=0, friction=0):
    fasteners = [{"id": i, "between": [f"center:{i}", f"doubler:{i}"], "law": "bolt", "friction": friction}
                 for i in ("1", "2", "3")]
    fasteners[0]["clearance"] = clearance
    return {"format": "joint", "version": 1,
            "plates": {p: f"../{p}.matrices.h5" for p in ("center", "doubler")},
            "laws": {"bolt": {"type": "linear", "k": k}}, "fasteners": fasteners,
            "loads": [{"external": "center:P", "force": load}], "increments": increments}


STUDIES = {
    "stiffness": [joint(k, 1000) for k in STIFFNESSES],
    "clearance": [joint(1000, 3000, "events", clearance=c) for c in CLEARANCES],  # the paper has three equal steps
    "friction": [joint(1000, 1000, friction=mu) for mu in FRICTIONS],
}


def main(study, folder):
    Path(folder).mkdir(parents=True, exist_ok=True)
    for i, scene in enumerate(STUDIES[study]):
        Path(folder, f"{i:02}.json").write_text(json.dumps(scene, indent=1) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
