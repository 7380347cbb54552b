# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/measure/chart_peaks on the isotropic pin: chart_peaks_test.py BIN_FOLDER."""
import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
import calculix_pin  # noqa: E402
from peak_scenes import PIN  # noqa: E402
from pin_on_springs import WideSheet, isotropic  # noqa: E402
from pictures import check_curves, run_and_look  # noqa: E402

NAME = "scripts/measure/chart_peaks"
COARSEST = 0.15  # error of the peak at p = 3 at most


def table(text):
    header, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()
                        if line.startswith("|"))
    return header, rows


def check_curves_fall(curves):
    """Errors fall from p = 3 to 5, where the waves of the pressure limit them; those of CalculiX with the mesh."""
    for name in ("trunk, rings 1", "product, rings 1"):
        seconds, (first, last) = curves[name]
        assert min(seconds) > 0 and COARSEST > first > 4 * last and last < 2e-3, (name, curves[name])
    assert curves["product, rings 1"][1][-1] < 6e-4, curves
    assert curves["product, rings 1, at points"][1][-1] > 0.01, curves
    (_, (error,)) = curves["defaults, p = 1 to 8"]
    assert error < 2e-3, error
    assert ("CalculiX, CPS8" in curves) == calculix_pin.is_there(), curves.keys()
    if "CalculiX, CPS8" in curves:
        coarse, fine = curves["CalculiX, CPS8"][1]
        assert fine < 0.02 and fine < coarse / 2, (coarse, fine)


def check_table(printed):
    """Seconds grow as errors fall; docs/performance.md has the same columns."""
    header, rows = table(printed)
    kept = (ROOT / "docs/performance.md").read_text().split(f"<!-- {NAME} -->\n")[1].split(f"<!-- /{NAME} -->")[0]
    assert table(kept)[0] == header, header
    assert [row[1] for row in rows[:-1]] == ["1e-02", "3e-03", "1e-03", "3e-04"], rows
    assert all(row[0] == "isotropic pin" and float(row[3]) > 0 for row in rows), rows
    assert rows[-1][2] == "defaults" and float(rows[-1][1]) < 2e-3, rows
    assert all(row[4].startswith("not reached: least ") for row in rows[:-1]), rows


def check_calculix(folder):
    """The springs take the whole force, and press as the exact solution says."""
    found = calculix_pin.solve(folder, 32, PIN)
    _, pressure, _ = WideSheet(isotropic(PIN.E, PIN.nu)).pin(PIN.force, PIN.modulus, PIN.gap)
    assert abs(found.force / PIN.force - 1) < 1e-4 and abs(found.pressure / pressure - 1) < 3e-3, (found, pressure)


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as name:
        picture, readme = Path(name) / "chart.png", Path(name) / "README.md"
        readme.write_text(f"before\n<!-- {NAME} -->\nold\n<!-- /{NAME} -->\nafter\n")
        printed, (curves,) = run_and_look(ROOT / NAME, "--quick", "-o", picture, "--readme", readme)
        assert readme.read_text() == f"before\n<!-- {NAME} -->\n{printed}<!-- /{NAME} -->\nafter\n"
        check_curves(picture, ["C0", "C1"], least_width=0.02)
        check_curves_fall(curves)
        check_table(printed)
        if calculix_pin.is_there():
            check_calculix(Path(name))


if __name__ == "__main__":
    main(*sys.argv[1:])
