#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/tune_joint: clearances that share a splice's load equally, and bad input: tune_test.py FOLDER_OF_PROGRAMS."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from one_hole import PROGRAMS, end_if_missed, near  # noqa: E402

N, P = 5, 3000.0


def chain(folder, name, left, right):
    holes = [str(i + 1) for i in range(N)]
    subprocess.run([ROOT / "scripts/chain_matrices", "-o", f"{name}.h5", "--segments", f"2e5*{N - 1}", "--left", left, "--right", right,
                    "--holes", *holes], cwd=folder, check=True, capture_output=True)


def tune(folder, variables):
    (folder / "tune.json").write_text(json.dumps({"format": "study", "version": 1, "variables": variables}))
    return subprocess.run([ROOT / "scripts/tune_joint", "joint.json", "tune.json", "-o", "best.json"], cwd=folder, capture_output=True, text=True)


def main(folder):
    """The outer fasteners of a row carry most; with clearances that let the inner ones catch up all carry P / n."""
    chain(folder, "left", "ground=1e6", "free")
    chain(folder, "right", "free", "external:P=1e6")
    ids = [str(i + 1) for i in range(N)]
    (folder / "joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"left": "left.h5", "right": "right.h5"}, "laws": {"rivet": {"type": "linear", "k": 1e5}},
        "fasteners": [{"id": id, "between": [f"left:{id}", f"right:{id}"], "law": "rivet"} for id in ids],
        "loads": [{"external": "right:P", "force": P}]}))
    bounds = {"distribution": {"type": "uniform", "from": 0, "to": 0.05}}
    done = tune(folder, [{"name": f"clearance of {id}", "at": f"/fasteners/{i}/clearance", **bounds} for i, id in enumerate(ids)])
    assert done.returncode == 0, done.stderr
    found = re.match(r"largest force: (\S+) \S+, of \d; in the middle of the bounds (\S+)", done.stdout)
    print(done.stdout)
    near("largest load, tuned", float(found[1]), P / N, 1e-5)
    assert float(found[2]) > 1.2 * P / N, found[2]
    run = subprocess.run([PROGRAMS / "stage3_nonlinear", "best.json", "-o", "best.h5"], cwd=folder, capture_output=True, text=True)
    loads = [abs(float(line.split()[2])) for line in run.stdout.splitlines() if re.match(r" +[1-5] +-?\d", line)]
    assert len(loads) == N and max(loads) < 1.0001 * P / N, run.stdout
    for variables, words in (([{"at": "/laws/rivet/k", "values": [1, 2]}], "uniform distribution"),
                             ([{"at": "/laws/rivet/k", "distribution": {"type": "uniform", "from": -2, "to": -1}}], "/laws/rivet/k"),
                             ([{"at": "/laws/x/k", **bounds}], "leads to no number")):
        done = tune(folder, variables)
        assert done.returncode != 0 and words in done.stderr, (words, done.stderr)
        assert "Traceback" not in done.stderr, done.stderr


with tempfile.TemporaryDirectory() as name:
    os.environ["PATH"] = f"{PROGRAMS}:{os.environ['PATH']}"
    main(Path(name))
end_if_missed()
