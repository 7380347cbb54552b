# SPDX-License-Identifier: GPL-3.0-or-later
"""What the text of section 6.2 would read with other geometries than the one chosen for the lost Figure 22: geometries.py [HALF_WIDTH RADIUS]

Half widths of 0.35 to 0.70 in and radii of 0.10 to 0.15 in, all else as in center.json and doubler.json; the programs are
taken from PATH. Prints a table in Markdown and the spread of each column, or of one geometry its row.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

from joints import joint

HERE = Path(__file__).resolve().parent
HALF_WIDTHS = (0.35, 0.42, 0.49, 0.56, 0.63, 0.70)
RADII = (0.10, 0.125, 0.15)
HEADS = ("share of fastener 1, K = 1 lb/in, %", "the same, K = 1e7 lb/in, %", "load at contact, 0.06 in, lb", "0.12 in, lb", "0.18 in, lb",
         "F of fastener 1 at mu = 0.1, change in %", "F (1 + 2 mu / pi), change in %", "mu = 0.3, %")
PAPER = ("59", "63", "~650", "~1300", "~2000", "", "5", "15")


def run(*words):
    subprocess.run([str(word) for word in words], check=True)


def solve(folder, scene):
    """F, transferred loads and delta at the last increment."""
    scene["plates"] = {name: f"{name}.matrices.h5" for name in ("center", "doubler")}
    (folder / "joint.json").write_text(json.dumps(scene))
    subprocess.run(["stage3_nonlinear", folder / "joint.json", "-o", folder / "joint.h5", "--quiet"], check=True,
                   stderr=subprocess.DEVNULL)  # warns of the paper's springs all around, each time
    with h5py.File(folder / "joint.h5") as f:
        return f["F"][-1], f["transferred"][-1, :, 1], f["delta"][-1]


def numbers(folder, half_width, radius):
    """One row: what the paper's text has, then both readings of Figure 26."""
    for name in ("center", "doubler"):
        scene = json.loads((HERE / f"{name}.json").read_text())
        scene["geometry"]["grid"]["y"] = [0, half_width]
        for hole in scene["holes"]:
            hole["radius"] = radius
        (folder / f"{name}.json").write_text(json.dumps(scene))
        run("stage1_plate", folder / f"{name}.json", "-o", folder / f"{name}.h5", "--quiet")
        run("stage2_extract", folder / f"{name}.h5", "-o", folder / f"{name}.matrices.h5", "--quiet")
    for k in (1, 1e7):
        _, loads, _ = solve(folder, joint(k, 1000))
        yield 100 * loads[0] / loads.sum()
    for gap in (0.06, 0.12, 0.18):
        _, _, delta = solve(folder, joint(1000, 1, clearance=gap))
        yield gap / delta[0]
    base, *_ = solve(folder, joint(1000, 1000))
    rises = [[100 * (each[0] / base[0] - 1) for each in solve(folder, joint(1000, 1000, friction=mu))[:2]] for mu in (0.1, 0.3)]
    yield from (*rises[0], rises[1][1])


def line(first, values):
    print("| " + " | ".join([*first, *values]) + " |", flush=True)


def main(*one):
    geometries = [tuple(map(float, one))] if one else [(half_width, radius) for half_width in HALF_WIDTHS for radius in RADII]
    line(("half width, in", "radius, in"), HEADS)
    line(("---",) * 2, ("---",) * len(HEADS))
    line(("the paper", ""), PAPER)
    digits = (2, 2, 0, 0, 0, 2, 2, 2)
    rows = []
    with tempfile.TemporaryDirectory() as name:
        for half_width, radius in geometries:
            rows.append(list(numbers(Path(name), half_width, radius)))
            line((f"{half_width:g}", f"{radius:g}"), [f"{value:.{d}f}" for value, d in zip(rows[-1], digits)])
    if not one:
        line(("least to largest", ""), [f"{min(column):.{d}f} to {max(column):.{d}f}" for column, d in zip(zip(*rows), digits)])


if __name__ == "__main__":
    main(*sys.argv[1:])
