# SPDX-License-Identifier: GPL-3.0-or-later
"""Hoop stress of the first row by the gap of all rivets: driven.py GAP ..., beside the matrices of both sheets.

The place is that of the highest peak under load; the programs are taken from PATH.
"""
import json
import subprocess
import sys
from pathlib import Path

import h5py


def solve(gap):
    """A row of the table: gap, touching angle, hoop stress without load and with it."""
    joint = json.loads(Path("joint.json").read_text())
    joint |= {"plates": {name: str(Path(file).resolve()) for name, file in joint["plates"].items()}, "increments": [0, 1]}
    joint.pop("$schema")
    for fastener in joint["fasteners"]:
        fastener["gap"] = gap
    out = Path("out")
    out.mkdir(exist_ok=True)
    (out / "driven.json").write_text(json.dumps(joint))
    subprocess.run(["stage3_nonlinear", out / "driven.json", "-o", out / "driven.h5", "--quiet"], check=True)
    with h5py.File(out / "driven.h5") as f:
        lower = f["plates/lower"]
        hoop, hole = lower["rim/peak_hoop"][:], lower["rim/peak_hoop"][-1].argmax()
        return gap, lower["contact/touching"][-1, hole], *hoop[:, hole]


print("| gap, mm | touches over, deg | hoop stress without load, N/mm² | with load, N/mm² | rise, N/mm² |")
print("|---|---|---|---|---|")
for gap in map(float, sys.argv[1:]):
    gap, touching, before, peak = solve(gap)
    print(f"| {gap:g} | {touching:.0f} | {before:.0f} | {peak:.0f} | {peak - before:.0f} |")
