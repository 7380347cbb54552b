# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/time_panels on panel(6,6): at least so much faster than the straightforward path in the same run, and the
same S and R: time_panels_test.py BIN_FOLDER."""
import os
import subprocess
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAME = "scripts/measure/time_panels"
LEAST_RATIO = 3.5  # half of what was measured, about 7


def run(*words, status=0, **more):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    assert result.returncode == status, result
    return result


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


def check_table(folder):
    readme = folder / "README.md"
    readme.write_text(f"<!-- {NAME} -->\n<!-- /{NAME} -->\n")
    printed = run(ROOT / NAME, "--quick", "--readme", readme).stdout
    assert readme.read_text() == f"<!-- {NAME} -->\n{printed}<!-- /{NAME} -->\n"
    header, _, row = map(cells, printed.splitlines()[:3])
    values = dict(zip(header, row))
    assert values["run"] == "panel(6,6), loads only, p = 8", printed
    assert float(values["ratio"]) >= LEAST_RATIO, printed
    assert float(values["S, R differ by"]) <= 1e-10, printed
    ratio = float(values["its seconds"]) / float(values["seconds"])
    assert abs(ratio / float(values["ratio"]) - 1) < 0.1, printed
    assert "Milliseconds per hole, loads only, p = 8 (holes): " in printed, printed
    kept = (ROOT / "docs/performance.md").read_text().split(f"<!-- {NAME} -->\n")[1]
    assert cells(kept.splitlines()[0]) == header, "docs/performance.md has other columns"


def check_faults():
    """What the script would fail for."""
    sys.path.insert(0, str(ROOT / "scripts/python"))
    sys.dont_write_bytecode = True
    loader = SourceFileLoader("time_panels", str(ROOT / NAME))
    script = module_from_spec(spec_from_loader("time_panels", loader))
    loader.exec_module(script)
    contest = script.Contest("a panel", [], "8")
    assert script.faults([contest], 0.1) == []
    contest.difference = 2e-10
    assert script.faults([contest], 0.5) == ["a panel: S or R differs by 2e-10; allowed: 1e-10",
                                            "seconds per hole grow as holes^0.50; allowed: below 0.5"]
    assert abs(script.exponent([4, 16, 64], [4, 32, 256]) - 0.5) < 1e-12


def check_refusals(folder):
    without = run(ROOT / NAME, "--quick", status=1, env={"PATH": "/usr/bin:/bin"})
    assert "stage1_plate is not on PATH" in without.stderr, without
    scene = ROOT / "examples/lap_joint/upper.json"
    refused = run("straightforward", scene, "-o", folder / "x.json", "--p", "9", status=2)
    assert "--p: '9' is not allowed" in refused.stderr, refused


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as name:
        check_table(Path(name))
        check_refusals(Path(name))
    check_faults()


if __name__ == "__main__":
    main(*sys.argv[1:])
