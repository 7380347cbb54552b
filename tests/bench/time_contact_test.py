# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/time_contact on two fasteners, beside the same programs: time_contact_test.py BIN_FOLDER."""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAME = "scripts/measure/time_contact"


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def main(programs):
    os.environ["PATH"] = f"{programs}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.md"
        page.write_text(f"<!-- {NAME} -->\n<!-- /{NAME} -->\n")
        printed = subprocess.run([ROOT / NAME, "--quick", "--beside", programs, "--readme", page], check=True,
                                 capture_output=True, text=True).stdout
        assert page.read_text() == f"<!-- {NAME} -->\n{printed}<!-- /{NAME} -->\n"
    header, _, *rows = [cells(line) for line in printed.splitlines()]
    assert [row[:2] for row in rows] == [["2", "0"], ["2", "0.15"]], printed
    assert all(float(value) > 0 for row in rows for value in row[2:]), printed
    kept = (ROOT / "docs/performance.md").read_text().split(f"<!-- {NAME} -->\n")[1].splitlines()[0]
    assert cells(kept) == header, "docs/performance.md has other columns"


if __name__ == "__main__":
    main(*sys.argv[1:])
