# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/stability_chart prints what it draws: chart_test.py BIN_FOLDER."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "stability.png"
        printed = subprocess.run([ROOT / "scripts/stability_chart", "-o", picture, "--joints", "24"], check=True,
                                 capture_output=True, text=True).stdout
        assert picture.read_bytes()[1:4] == b"PNG"
    rows = [re.split(r" *\| *", line.strip("| ")) for line in printed.splitlines()[2:]]
    solved = {(row[0], row[1]): float(row[2]) for row in rows}
    assert len(solved) == 19, "nine solvers with two unknowns each, and the program"
    assert solved["as shipped", "contact"] == solved["damped newton", "contact"] == 100, printed
    for solver in ("newton", "dnewton", "hybrid", "hybridsj"):
        assert solved[solver, "displacement"] < solved[solver, "contact"], printed

    usage = subprocess.run(["stability", "check", "many"], capture_output=True, text=True)
    assert usage.returncode == 2 and usage.stderr == "usage: stability check|chart JOINTS [MAX_ITERATIONS]\n"


if __name__ == "__main__":
    main(*sys.argv[1:])
