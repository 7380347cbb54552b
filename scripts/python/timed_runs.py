# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of programs (taken from PATH) on one thread, with the times that they tell by --timings."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

MEMORY = "/dev/shm"  # where it is: fsync to a disk takes longer than a small sheet


def work_folder():
    """A temporary folder, in memory if there is one there: a context that gives its path."""
    return tempfile.TemporaryDirectory(dir=MEMORY if os.path.isdir(MEMORY) else None)


def run(*words, folder=None):
    """Of a program that must succeed, run in a folder: what it prints."""
    try:
        result = subprocess.run([str(word) for word in words], env=os.environ | ONE_THREAD, cwd=folder, capture_output=True,
                                text=True)
    except FileNotFoundError:
        sys.exit(f"{Path(sys.argv[0]).name}: error: {words[0]} is not on PATH; after "
                 "cmake --build --preset release --target all benchmarks: PATH=$PWD/build/release/bin:$PATH")
    if result.returncode:
        sys.exit(f"{Path(sys.argv[0]).name}: error: {result.stderr.strip()}")
    return result.stdout


def timed(program, source, target, *more):
    """A run and its record as --timings writes it: "seconds" by phase, "total", "peak_memory_bytes", "unknowns"."""
    times = Path(f"{target}.times")
    run(program, source, "-o", target, "--timings", times, "--quiet", *more)
    return json.loads(times.read_text())


def solve_sheet(scene, p, stresses=False):
    """Both stages of a sheet beside its file PLATE.json, at the degrees p ("8" or "1..8"): MATRICES.h5, records."""
    options = [] if stresses else ["--loads-only"]
    plate, matrices = scene.with_suffix(".h5"), scene.with_suffix(".matrices.h5")
    return matrices, [timed("stage1_plate", scene, plate, "--p", p), timed("stage2_extract", plate, matrices, *options)]


def read_S_and_R(matrices, level=-1):
    """S, shape (e + m, e + m), and R, shape (e + m, h), externals before discs."""
    with h5py.File(matrices) as f:
        ee, ed, dd, R_ef, R_df = (f[name][level] for name in ("S_ee", "S_ed", "S_dd", "R_ef", "R_df"))
    return np.block([[ee, ed], [ed.T, dd]]), np.vstack([R_ef, R_df])
