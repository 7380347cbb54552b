#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The splice of examples/rows: its page has the table that it prints, and columns are equal: rows_test.py BIN_FOLDER [sweep].
Of the table of gaps the first row, with the last word all."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path
from shutil import copytree, ignore_patterns

ROOT = Path(__file__).resolve().parents[2]

with tempfile.TemporaryDirectory() as folder:
    copytree(ROOT / "examples/rows", f"{folder}/examples/rows", ignore=ignore_patterns("*.h5", "out"))
    copytree(ROOT / "scripts", f"{folder}/scripts")
    path = os.environ | {"PATH": f"{Path(sys.argv[1]).resolve()}:{os.environ['PATH']}"}
    driving = ["make", "-s", "driven"] if sys.argv[2:] == ["sweep"] else [ROOT / "scripts/with_python", "driven.py", "0.01"]
    printed, driven = (subprocess.run(words, cwd=f"{folder}/examples/rows", env=path, check=True, capture_output=True,
                                      text=True).stdout for words in (["make", "-s", "table"], driving))
table = printed[printed.index("| springs |"):]
page = (ROOT / "examples/rows/README.md").read_text()
assert table.split("\n\n")[0] in page, f"README.md shows another table than:\n{table}"
driven = driven[driven.index("| gap, mm |"):]
assert driven in page, f"README.md shows another table than:\n{driven}"
assert float(re.search(r"differ by at most (\S+) of a load", table)[1]) < 1e-6, table
for line in table.splitlines()[2:8]:
    springs, load, chain = (line.split("|")[i].strip() for i in (1, 3, 4))
    assert abs(float(load) / float(chain) - 1) < (0.01 if springs == "only push" else 0.05), line
