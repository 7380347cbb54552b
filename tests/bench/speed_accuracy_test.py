# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/chart_speed_accuracy on panel(1,1), and the program behind it: speed_accuracy_test.py BIN_FOLDER."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from pictures import check_curves, run_and_look  # noqa: E402

NAME = "scripts/measure/chart_speed_accuracy"


def run(*words, status=0, **more):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    assert result.returncode == status, result
    return result


def table(text):
    header, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()
                        if line.startswith("|"))
    return header, rows


def block(text):
    return text.split(f"<!-- {NAME} -->\n")[1].split(f"<!-- /{NAME} -->")[0]


def check_errors(rows):
    """Errors of each series fall with p, or with cuts at the order 2p of S; where a rule says more, by as much."""
    errors, loads = {}, {}
    for space, rings, cut, p, unknowns, seconds, error, load in rows:
        at = space, int(rings), int(cut), int(p)
        assert int(unknowns) > 0 and float(seconds) > 0, rows
        errors[at] = float(error)
        loads[at] = float(load) if load else None
    for space, rings in (("trunk", 0), ("trunk", 1), ("product", 0), ("product", 1), ("by stresses", 0)):
        by_p = [errors[space, rings, 1, p] for p in (2, 4, 6)]
        fall = 0.5 if space == "by stresses" else 0.1
        assert by_p[1] < fall * by_p[0] and by_p[2] < fall * by_p[1], (space, rings, by_p)
    for p in (2, 4, 6):
        assert errors["by stresses", 0, 1, p] > 3 * errors["trunk", 0, 1, p], errors
        assert loads["by stresses", 0, 1, p] is None
        for rings in (0, 1):
            assert errors["product", rings, 1, p] < errors["trunk", rings, 1, p], errors
    for p in (1, 2):  # h^(2p), from both sides
        assert 0.8 < errors["trunk", 1, 2, p] / errors["trunk", 1, 4, p] / 4**p < 1.25, (p, errors)
    assert all(0.5 < loads[at] / errors[at] < 2 for at in errors if loads[at] is not None), (loads, errors)


def check_summary(printed):
    """The cheapest of the summary are at most as dear as any other, and docs/performance.md has the same columns."""
    header, rows = table(printed)
    assert table(block((ROOT / "docs/performance.md").read_text()))[0] == header, header
    assert [row[:2] for row in rows] == [["panel(1,1)", f"1e-0{digits}"] for digits in range(2, 7)], rows
    ours = [float(row[3]) for row in rows]
    assert ours == sorted(ours), rows
    assert rows[-1][4].startswith("not reached: ") and rows[-1][6] == "", rows


def check_drawn(rows, drawn):
    """Each point of the table stands in the picture, over its seconds and over its unknowns."""
    series = {}
    for space, rings, cut, p, unknowns, seconds, error, _ in rows:
        name = space if space == "by stresses" else f"h, p = {p}" if int(cut) > 1 else f"{space}, {rings} rings"
        series.setdefault(name, []).append((float(seconds), float(unknowns), float(error)))
    left, right = drawn
    assert left.keys() == series.keys() and len(right) == len(left) == 7, drawn
    for (name, (seconds, error)), (unknowns, same) in zip(left.items(), right.values()):
        assert np.array_equal(error, same), name
        for found, told, digits in zip((seconds, unknowns, error), zip(*series[name]), (3, 9, 2)):
            assert np.allclose(found, told, rtol=0.6 * 10**(1 - digits)), (name, found, told)


def check_chart(folder):
    readme = folder / "README.md"
    readme.write_text(f"before\n<!-- {NAME} -->\nold\n<!-- /{NAME} -->\nafter\n")
    printed, drawn = run_and_look(ROOT / NAME, "--quick", "-o", folder / "chart", "--readme", readme)
    assert readme.read_text() == f"before\n<!-- {NAME} -->\n{printed}<!-- /{NAME} -->\nafter\n"
    picture = folder / "chart/pictures/panel_1_1.png"
    check_curves(picture, ["C0", "C1"], least_width=0.1)  # trunk and product space
    assert picture.stat().st_size < 150_000
    report = (folder / "chart/README.md").read_text()
    for name in re.findall(r"\]\((.*?)\)", report):
        assert (folder / "chart" / name).exists(), name
    assert float(re.search(r"within (\S+) of the reference", report)[1]) < 1e-10, report
    header, rows = table(report)
    assert header == ["space", "rings", "cut", "p", "unknowns", "seconds", "error of S", "error of the largest load"]
    assert len(rows) == 2 * 2 * 3 + 3 + 2 * 2, rows
    check_errors(rows)
    check_drawn(rows, drawn)
    check_summary(printed)
    check_report((ROOT / "examples/speed_accuracy/README.md").read_text(), header)


def check_report(report, header):
    """The chart that is kept has all scenes and the columns of today."""
    scenes = re.findall(r"^## (.*)$", report, re.M)
    assert scenes == ["panel(1,1)", "panel(10,10)", "three-fastener joint"], scenes
    assert all(table(part)[0] == header for part in report.split("\n## ")[1:])


def check_refusals(folder):
    readme = folder / "none.md"
    readme.write_text("no block\n")
    refused = run(ROOT / NAME, "--quick", "-o", folder / "chart", "--readme", readme, status=1)
    assert f"{readme} has no block from <!-- {NAME} --> to <!-- /{NAME} -->" in refused.stderr, refused
    without = run(ROOT / NAME, "--quick", "-o", folder / "chart", status=1, env={"PATH": "/usr/bin:/bin"})
    assert "stage1_plate is not on PATH" in without.stderr, without
    scene = ROOT / "examples/three_fasteners/doubler.json"
    refused = run("integrated_stress", scene, "-o", folder / "x.json", status=2)
    assert f"{scene}: /external: another first external, or none; allowed: a rigid one along x first" in refused.stderr


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as name:
        check_chart(Path(name))
        check_refusals(Path(name))


if __name__ == "__main__":
    main(*sys.argv[1:])
