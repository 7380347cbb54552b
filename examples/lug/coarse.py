# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints loads, peaks and times of the lug by the size of its elements: coarse.py, in the example's folder, with the programs and Gmsh on PATH."""
import json
import subprocess
import tempfile
import time
from pathlib import Path

import h5py

from readme_block import markdown_table


def run(*words):
    start = time.perf_counter()
    subprocess.run([str(word) for word in words], check=True, capture_output=True)
    return time.perf_counter() - start


def solve(size, n, folder):
    """Elements, load of bolt 1, peaks at hole 1 and at the pin's hole with their errors, seconds of stages 1 and 2."""
    mesh, sheet = folder / "lug.msh", folder / "lug.json"
    run("gmsh", "-2", "-format", "msh41", "-setnumber", "size", size, "-setnumber", "n", n, "-o", mesh, "lug.geo")
    run("../../scripts/import_mesh", mesh, "--plate", "lug.plate.json", "-o", sheet)
    joint = json.loads(Path("joint.json").read_text())
    joint["plates"] = {"lug": str(folder / "lug.matrices.h5"), "base": str(Path("base.matrices.h5").resolve())}
    (folder / "joint.json").write_text(json.dumps(joint))
    seconds = run("stage1_plate", sheet, "-o", folder / "lug.h5") + run("stage2_extract", folder / "lug.h5", "-o", folder / "lug.matrices.h5")
    run("stage3_nonlinear", folder / "joint.json", "-o", folder / "joint.h5")
    with h5py.File(folder / "joint.h5") as f:
        rim = f["plates/lug/rim"]
        at = [list(rim["hole"].asstr()).index(hole) for hole in ("1", "pin")]
        peaks, errors = ([rim[name][-1, i] for i in at] for name in ("peak_hoop", "peak_error"))
        elements = len(json.loads(sheet.read_text())["geometry"]["mesh"]["quads"])
        return [elements, f["F"][-1, 0], *zip(peaks, errors), seconds]


with tempfile.TemporaryDirectory() as name:
    rows = []
    for size, n in ((40, 1), (8, 1), (20, 2), (4, 2), (4, 4)):
        elements, load, bolt, pin, seconds = solve(size, n, Path(name))
        rows.append([f"{size}", f"{8 * n}", f"{elements}", f"{load:.3f}", *(f"{peak:.2f} +- {error:.1g}" for peak, error in (bolt, pin)), f"{seconds:.1f}"])
print(markdown_table(["largest element, mm", "elements around a hole", "elements", "load of bolt 1, N", "peak at hole 1, N/mm²", "peak at the pin's hole", "stages 1 and 2, s"], rows), end="")
