# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/stability_chart prints what it draws, and `stability check` can fail: chart_test.py BIN_FOLDER."""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.dont_write_bytecode = True
from pictures import extent, plt, run_and_look  # noqa: E402


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as folder:
        printed, _ = run_and_look(ROOT / "scripts/measure/stability_chart", "-o", Path(folder) / "stability.png", "--joints", "18")
        axis = plt.gcf().axes[0]
        tiles = dict(zip((label.get_text() for label in axis.get_yticklabels()), axis.images[0].get_array()))
        assert extent(Path(folder) / "stability.png", plt.cm.RdYlGn(1.0)[:3])[2] > 0.05, "tiles of 100 % are green"
    rows = [re.split(r" *\| *", line.strip("| ")) for line in printed.splitlines()[2:]]
    solved = {(row[0], row[1]): float(row[2]) for row in rows}
    assert len(solved) == 19, "nine solvers with two unknowns each, and the program"
    assert solved["as shipped", "contact"] == solved["damped newton", "contact"] == 100, printed
    assert list(tiles)[0] == "as shipped" and (tiles["as shipped"] == 100).all(), "the program's tiles are drawn first"
    assert len(tiles) == 6, "the chart has the methods that matter"
    for method, shares in tiles.items():
        solver, _, unknown = method.partition(", ")
        per_cent = solved[solver, unknown or "contact"]
        assert shares.min() - 0.5 <= per_cent <= shares.max() + 0.5, (method, shares)
    for solver in ("newton", "dnewton", "hybrid", "hybridsj"):
        assert solved[solver, "displacement"] < solved[solver, "contact"], printed

    few = subprocess.run(["stability", "check", "20", "3"], capture_output=True, text=True)
    broken = [line for line in few.stdout.splitlines() if re.match("(falling laws, )?seed ", line)]
    assert few.returncode == 1 and not few.stderr, "three iterations are too few: a broken promise is status 1"
    assert any(line.endswith("damped Newton does not converge") for line in broken), few.stdout
    assert f"promises broken: {len(broken)}\n" in few.stdout, few.stdout

    usage = subprocess.run(["stability", "check", "many"], capture_output=True, text=True)
    assert usage.returncode == 2 and usage.stderr == "usage: stability check|chart|friction JOINTS [MAX_ITERATIONS]\n"


if __name__ == "__main__":
    main(*sys.argv[1:])
