# SPDX-License-Identifier: GPL-3.0-or-later
"""The paper's figures of sections 3 and 5 show what the paper says of them: figures_test.py BIN_FOLDER."""
import csv
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
import inclusion  # noqa: E402
from pictures import check_curves, run_and_look, same_pixels  # noqa: E402


def rows(script, folder):
    """The numbers that a figure's script prints, and the curves of its picture."""
    picture = folder / f"{script}.png"
    printed, (drawn, *_) = run_and_look(ROOT / "examples/paper_figures" / f"{script}.py", "-o", picture)
    check_curves(picture, ["C0", "C1"])
    return list(csv.DictReader(printed.splitlines())), drawn


def curves(printed_and_drawn, value):
    """Values over rising unknowns by model; the picture has the same."""
    table, drawn = printed_and_drawn
    models, unknowns = {}, {}
    for row in table:
        models.setdefault(row["model"], []).append(float(row[value]))
        unknowns.setdefault(row["model"], []).append(float(row["unknowns"]))
    assert drawn.keys() == models.keys(), drawn.keys()
    for model, (x, y) in drawn.items():
        assert np.allclose(x, unknowns[model], rtol=1e-3) and np.allclose(y, models[model], rtol=1e-3), model
    return models


def check_line_springs(folder):
    ratio = curves(rows("figure_5", folder), "F2/F1")
    distributed = ratio.pop("distributed springs, p = 1 ... 8")
    assert abs(distributed[-1] / distributed[-2] - 1) < 1e-4, distributed
    finest = [values[-1] for values in ratio.values()]
    assert max(finest) / min(finest) > 1.4, "gradings of one mesh size do not agree"
    for model, values in ratio.items():
        assert values[-1] / values[-2] < 0.98, f"{model}: still drifts from 400 to 1600 elements: {values}"
    # The drift is that of ln h: as much from 100 to 400 elements as from 400 to 1600, and so on without end.
    flexibility = [1 / value for value in ratio["Q = 1"]]
    assert flexibility[3] - flexibility[2] > 0.7 * (flexibility[2] - flexibility[1])


def check_links(folder):
    stress = curves(rows("figure_8", folder), "largest stress")
    smooth = stress.pop("p-version, 8 elements, p = 1 ... 8")
    (reference,) = stress["reference: p-version, 256 elements, p = 8"]
    assert abs(smooth[-1] / reference - 1) < 0.02, smooth
    falling, constant = stress["links, K n constant"], stress["links, K constant"]
    missing = [1 - value / reference for value in falling[2:]]
    assert all(0.4 < fine / coarse < 0.7 for coarse, fine in zip(missing, missing[1:])), f"half with twice the links: {missing}"
    assert constant[-1] / reference > 1.03 and constant[-1] > constant[-2], "K constant stiffens without end"


def check_inclusion(folder):
    table, drawn = rows("figure_16", folder)
    assert [float(row["E_D/E_P"]) for row in table] == [float(f"{beta:.4g}") for beta in inclusion.BETAS]
    for beta, row in zip(inclusion.BETAS, table):
        A, B = inclusion.springs(beta)
        assert abs(float(row["A"]) - A) < 1e-6 and abs(float(row["B"]) - B) < 1e-6, row
        assert abs(float(row["B by the second-harmonic law"]) - inclusion.disk(beta)[1]) < 1e-6, row
    for label, column in (("computed, (29)", "A"), ("computed, second harmonic matched", "B by the second-harmonic law")):
        assert np.allclose(drawn[label], [inclusion.BETAS, [float(row[column]) for row in table]], atol=1e-5), label


def check_contact(row, radial, hoop):
    """The curves of a sheet of Figure 18 have its numbers: pressure within the contact and none beyond, the largest hoop stress."""
    steep = 0.05 if "elastic" in row["sheet"] and "friction 0" in row["sheet"] else 0.01  # within a degree of the end of contact
    (away, pressure), end = radial, float(row["contact half-angle"])
    assert np.array_equal(away, hoop[0]) and away.min() <= 5 and away.max() == 180, away
    assert np.isclose(-np.min(pressure), float(row["peak pressure"]), rtol=1e-3), (row, pressure)
    assert (pressure[away < end - 4] < -0.05).all() and np.abs(pressure[away > end + 4]).max() < 0.02, (row, radial)
    largest = float(row["largest hoop stress"])  # at a kink, between points one degree apart
    assert (1 - steep) * largest <= np.max(hoop[1]) <= largest + 1e-4, (row, hoop)


def check_nisida(folder):
    shutil.copytree(ROOT / "scripts", folder / "scripts")
    shutil.copytree(ROOT / "examples/nisida", folder / "examples/nisida", ignore=shutil.ignore_patterns("out"))
    example = folder / "examples/nisida"
    subprocess.run(["make", "-s"], cwd=example, check=True, capture_output=True)
    table = list(csv.DictReader((example / "out/figure_18.csv").open()))
    check_curves(example / "out/figure_18.png", ["C0", "C1", "C2", "C3"])
    joints = ("frictionless", "friction", "elastic_frictionless", "elastic_friction")
    files = [example / f"out/{name}.h5" for name in ("sheet.matrices", *joints)]
    _, (radial, hoop) = run_and_look(example / "figure_18.py", *files, "-o", folder / "again.png")
    assert same_pixels(folder / "again.png", example / "out/figure_18.png")
    for row in table:
        check_contact(row, radial[row["sheet"]], hoop[row["sheet"]])
    smooth, rough, *elastic = table
    assert abs(float(smooth["contact half-angle"]) - 87.19) < 0.1, smooth
    assert abs(float(smooth["peak pressure"]) / 1.2045 - 1) < 1e-3, smooth
    for without, with_friction in ((smooth, rough), elastic):
        assert float(with_friction["peak pressure"]) < float(without["peak pressure"])
        assert float(with_friction["largest hoop stress"]) > float(without["largest hoop stress"])
    for springs, disk in zip((smooth, rough), elastic):  # springs miss some of the peak
        assert 1.01 < float(disk["largest hoop stress"]) / float(springs["largest hoop stress"]) < 1.1
    page = (ROOT / "examples/nisida/README.md").read_text()
    for row in table:
        assert " | ".join(list(row.values())[1:]) in page, "the example's page has these numbers"


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as name:
        for check in (check_line_springs, check_links, check_inclusion, check_nisida):
            folder = Path(name) / check.__name__
            folder.mkdir()
            check(folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
