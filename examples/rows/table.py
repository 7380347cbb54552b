# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares examples/rows with contact and with springs all around: table.py JOINT.h5 FILLED.h5

A line for each row of rivets: its load beside that of a chain of springs, and the peaks of the lower sheet; how much columns differ. Of the
chain a sheet between two rows has E t width / pitch, and a hole the flexibility of one rivet alone in a strip, which the programs, taken
from PATH, find for both kinds of springs.
"""
import argparse
import json
from pathlib import Path

import h5py

from readme_block import markdown_table
from timed_runs import run, work_folder


def hole_flexibility(lower, joint, folder):
    """What one rivet's hole in a strip of the lower sheet adds to the strip's length, over the load."""
    x, y = lower["geometry"]["grid"]["x"], lower["geometry"]["grid"]["y"][:2]
    hole = lower["holes"][0]
    strip = lower | {"geometry": {"grid": lower["geometry"]["grid"] | {"y": y}}, "holes": [hole],
                     "external": [*lower["external"], {"id": "L", "on": "left", "direction": "x", "kind": "rigid"}],
                     "supports": [{"on": "bottom", "fix": ["y"]}], "p": lower["p"][-1]}
    strip.pop("$schema")
    pinned = {"format": "joint", "version": 1, "plates": {"strip": "strip.matrices.h5"}, "laws": {"rigid": {"type": "rigid"}},
              "fasteners": [{"id": "pin", "between": [f"strip:{hole['id']}", "ground"], "law": "rigid"}],
              "loads": [{"external": "strip:L", "force": -1}]}
    for name, text in (("strip", strip), ("pinned", pinned)):
        (folder / f"{name}.json").write_text(json.dumps(text))
    run("stage1_plate", folder / "strip.json", "-o", folder / "strip.h5", "--quiet")
    run("stage2_extract", folder / "strip.h5", "-o", folder / "strip.matrices.h5", "--loads-only", "--quiet")
    run("stage3_nonlinear", folder / "pinned.json", "-o", folder / "result.h5", "--quiet")
    with h5py.File(folder / "result.h5") as f:
        moved = -f["plates/strip/De"][0, list(f["plates/strip/external/id"].asstr()).index("L")]
    return moved - (hole["center"][0] - x[0]) / (modulus(lower) * section(lower))


def modulus(lower):
    return next(iter(lower["materials"].values()))["E"]


def section(lower):
    grid = lower["geometry"]["grid"]
    return grid["thickness"] * (grid["y"][1] - grid["y"][0])


def chain(lower, k, load, hole):
    """Loads of three rows in line under the load of a column: the outer ones, then the inner one."""
    pitch = lower["holes"][6]["center"][0] - lower["holes"][0]["center"][0]
    ratio = 1 + pitch / (modulus(lower) * section(lower)) / (1 / k + 2 * hole)
    return load * ratio / (2 * ratio + 1), load / (2 * ratio + 1)


def rows_of(path, folder):
    lower = json.loads((path.parent / "lower.json").read_text())
    with h5py.File(path) as f:
        joint = json.loads(f["input"].asstr()[()])
        F, names = f["F"][-1].reshape(3, -1), f["fastener/id"].asstr()[::6]
        peaks = f["plates/lower/rim/peak_hoop"][-1].reshape(3, -1)[:, 0]
        contact = f["plates/lower/contact/peak_pressure"][-1]
        pressure = contact.reshape(3, -1)[:, 0] if contact.size else None
    outer, inner = chain(lower, joint["laws"]["rivet"]["k"], F.sum() / F.shape[1], hole_flexibility(lower, joint, folder))
    spread = max(abs(F / F[:, :1] - 1).max(axis=1))
    kind = "push and pull" if pressure is None else "only push"
    return spread, [[kind, name[0], f"{F[i, 0]:.2f}", f"{(outer, inner, outer)[i]:.1f}", f"{peaks[i]:.1f}",
                     f"{pressure[i]:.1f}" if pressure is not None else ""] for i, name in enumerate(names)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("joints", nargs=2, type=Path)
    a = parser.parse_args()
    with work_folder() as name:
        found = [rows_of(joint.resolve(), Path(name)) for joint in a.joints]
    print(markdown_table(["springs", "row", "load of a rivet, N", "by a chain of springs, N", "peak hoop stress, lower sheet, N/mm²",
                          "peak pressure, N/mm²"], [row for _, rows in found for row in rows]), end="")
    print(f"\nColumns differ by at most {max(spread for spread, _ in found):.0e} of a load.")


if __name__ == "__main__":
    main()
