# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/time_large and scripts/measure/time_solvers on a few holes: time_large_test.py BIN_FOLDER."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def run(script, *words, status=0):
    result = subprocess.run([str(ROOT / script), *map(str, words)], capture_output=True, text=True)
    assert result.returncode == status, result
    return result.stdout if status == 0 else result.stderr


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def rows(text):
    header, _, *lines = [line for line in text.splitlines() if line.startswith("|")]
    return [dict(zip(cells(header), cells(line))) for line in lines]


def kept(page, script):
    return (ROOT / page).read_text().split(f"<!-- {script} -->\n")[1].split("<!-- /")[0]


def check_large(folder):
    script, readme = "scripts/measure/time_large", folder / "README.md"
    readme.write_text(f"<!-- {script} -->\n<!-- /{script} -->\n")
    printed = run(script, "--quick", "--repeat", 1, "--readme", readme)
    assert readme.read_text() == f"<!-- {script} -->\n{printed}<!-- /{script} -->\n"
    found = rows(printed)
    assert [row["job"] for row in found][5:8] == [f"9 fasteners, {law}, stage 3" for law in ("linear", "power", "bilinear")], printed
    assert all(float(row["seconds"]) > 0 for row in found), printed
    assert list(rows(kept("docs/performance.md", script))[0]) == list(found[0]), "docs/performance.md has other columns"
    assert "argument --repeat" in run(script, "--repeat", 0, status=2)


def check_chart(folder):
    block, readme, chart = "scripts/measure/time_large --chart", folder / "README.md", folder / "chart.png"
    readme.write_text(f"<!-- {block} -->\n<!-- /{block} -->\n")
    printed = run("scripts/measure/time_large", "--quick", "--repeat", 1, "--chart", chart, "--readme", readme)
    assert readme.read_text() == f"<!-- {block} -->\n{printed}<!-- /{block} -->\n"
    for what in ("loads only", "with stresses"):
        costs = re.search(rf"Milliseconds per hole, {what} \(holes\): ([\d.e+]+) \(4\), ([\d.e+]+) \(9\)\.", printed)
        assert costs and all(float(cost) > 0 for cost in costs.groups()), printed
        assert f"Milliseconds per hole, {what} (holes): " in kept("docs/performance.md", block), "docs/performance.md"
    assert chart.read_bytes().startswith(b"\x89PNG"), chart


def check_solvers():
    script = "scripts/measure/time_solvers"
    found = rows(run(script, "--quick", "--repeat", 1))
    assert [row["fasteners"] for row in found] == ["4", "9"], found
    for row in found:
        assert abs(float(row["ratio"]) * float(row["damped newton"]) / float(row["hybridsj"]) - 1) < 0.15, found
    assert list(rows(kept("docs/solvers.md", script))[0]) == list(found[0]), "docs/solvers.md has other columns"


def main(bin_folder):
    bin_folder = Path(bin_folder).resolve()
    os.environ["PATH"] = f"{bin_folder}{os.pathsep}{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        check_large(Path(folder))
        check_chart(Path(folder))
    check_solvers()


if __name__ == "__main__":
    main(*sys.argv[1:])
