# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture and the table of scripts/draw/draw_study have what STUDY.h5 has: draw_study_test.py FOLDER_OF_PROGRAMS."""
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

import h5py
import matplotlib.image
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from one_hole import matrices, run  # noqa: E402
from pictures import run_and_look  # noqa: E402
from scripts import run_script  # noqa: E402

N = 3  # fasteners
FIRST = {"name": "clearance of $1", "at": "/fasteners/0/clearance"}
RANDOM = {"samples": 300, "seed": 7, "outputs": ["peaks", "displacements"], "limits": {"force": 45},
          "variables": [{"name": "clearance", "at": "/fasteners/*/clearance", "each": True,
                         "distribution": {"type": "uniform", "from": 0, "to": 0.02}},
                        {"name": "k", "at": "/laws/pin/k", "use": "factor", "distribution": {"type": "normal", "mean": 1, "deviation": 0.1}}]}
STUDIES = {"random": RANDOM, "few": RANDOM | {"samples": 10, "outputs": []}, "grid": {"variables": [FIRST | {"grid": {"from": 0, "to": 0.02, "n": 21}}]},
           "two": {"variables": [FIRST | {"values": [0, 0.01]}, {"at": "/laws/pin/k", "values": [500, 1000, 2000]}]},
           "one": {"variables": [FIRST | {"values": [0.01]}]}}


def solve(folder):
    """A sheet with pins in a row, and all studies of it."""
    matrices(folder, {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"},
                      "analysis": "plane stress", "materials": {"m": {"E": 1e5, "nu": 0.3}},
                      "geometry": {"grid": {"x": [-10, -5, 5, 10], "y": [10 * i for i in range(N + 1)], "thickness": 1}},
                      "disc_directions": ["x"], "supports": [{"on": side, "fix": ["y"]} for side in ("bottom", "top")],
                      "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}],
                      "holes": [{"id": str(i), "center": [0, 10 * i + 5], "radius": 1, "spring": {"modulus": 1e5}} for i in range(N)]})
    joint = {"format": "joint", "version": 1, "plates": {"sheet": "sheet.h5"}, "laws": {"pin": {"type": "linear", "k": 1000}},
             "fasteners": [{"id": f"bolt {i}", "between": [f"sheet:{i}", "ground"], "law": "pin"} for i in range(N)],
             "loads": [{"external": "sheet:P", "force": 120}]}
    (folder / "joint.json").write_text(json.dumps(joint))
    for name, study in STUDIES.items():
        (folder / f"{name}.json").write_text(json.dumps({"format": "study", "version": 1, **study}))
        run(folder, "stage3_nonlinear", "joint.json", "--study", f"{name}.json", "-o", f"{name}.study.h5")


def check_table(printed, file, kind, top):
    """Rows have the numbers of the file, those with the largest 95 % quantiles first; that of the largest number stands above them."""
    head, *rows = [line.strip("| ").split(" | ") for line in printed.splitlines()]
    its, largest = file[f"statistics/{kind}"], file.get(f"statistics/largest_{kind}")
    assert its["quantile"].attrs["unit"] in head[0] and head[1:] == ["5 %", "50 %", "95 %", "99 %", "governs"], head
    if largest:
        assert rows[0][1:] == [f"{each:.6g}" for each in largest["quantile"][0]] + ["-"], rows[0]
        rows = rows[1:]
    of = list(its["of"].asstr())
    assert len(rows) == min(top, len(of)), rows
    shown = [of.index(row[0]) for row in rows]
    quantile = its["quantile"][:]
    assert shown == list(np.argsort(-quantile[:, 2], kind="stable")[:top]), "the largest first"
    for i, row in zip(shown, rows):
        governs = f"{100 * its['governs'][i]:.1f} %" if "governs" in its else "-"
        assert row[1:] == [f"{each:.6g}" for each in quantile[i]] + [governs], (row, quantile[i])


def check_picture(path):
    """It has shades of the words and of the panels' colours, and something drawn in all four quarters."""
    pixels = (255 * matplotlib.image.imread(path)[:, :, :3]).round().astype(int)
    assert len(np.unique(pixels.reshape(-1, 3), axis=0)) > 50, "blank"
    half = np.array(pixels.shape[:2]) // 2
    for quarter in (pixels[:half[0], :half[1]], pixels[:half[0], half[1]:], pixels[half[0]:, :half[1]], pixels[half[0]:, half[1]:]):
        assert (quarter < 250).any(axis=2).mean() > 0.01, "an empty quarter"


def pictures(folder):
    for name, kind, top in (("random", "peak", 2), ("random", "displacement", 20), ("few", "force", 1),
                            ("grid", "force", 2), ("two", "force", 20), ("one", "force", 20)):
        picture = folder / f"{name}_{kind}.png"
        done = run_script("draw/draw_study", folder / f"{name}.study.h5", "-o", picture, "--of", kind, "--top", top)
        assert done.returncode == 0 and not done.stderr, done
        with h5py.File(folder / f"{name}.study.h5") as file:
            check_table(done.stdout, file, kind, top)
        check_picture(picture)


def curves(folder):
    """Of a grid of one variable all items are drawn over its values; the marks of the bars are the file's quantiles."""
    _, panels = run_and_look(ROOT / "scripts/draw/draw_study", folder / "grid.study.h5", "-o", folder / "grid.png")
    assert len(panels) == 3, panels
    with h5py.File(folder / "grid.study.h5") as file:
        for i in range(N):
            x, y = panels[0][f"bolt {i}"]
            assert np.array_equal(x, file["samples/variable"][:, 0]) and np.array_equal(y, file["samples/force"][:, i])
        quantile = file["statistics/force/quantile"][:]
        order = np.argsort(-quantile[:, 2], kind="stable")
        assert np.array_equal(panels[1]["median"][0], quantile[order, 1])
        assert np.array_equal(panels[1]["99 % are below"][0], quantile[order, 3])
    _, panels = run_and_look(ROOT / "scripts/draw/draw_study", folder / "random.study.h5", "-o", folder / "random.png")
    assert len(panels) == 4 and all(any(label.startswith("limit, 45 N") for label in panel) for panel in panels[:2]), [*map(list, panels)]
    with h5py.File(folder / "random.study.h5") as file:
        strongest = np.abs(file["statistics/largest_force/rank_correlation"][0]).argmax()
        truth = np.sort([file["samples/variable"][:, strongest], file["samples/largest_force"][:]])
    lines = [np.sort(line) for panel in panels for line in panel.values()]
    assert any(line.shape == truth.shape and np.array_equal(line, truth) for line in lines), "all samples are in the last panel"


def refusals(folder):
    shutil.copy(folder / "random.study.h5", folder / "failed.h5")
    with h5py.File(folder / "failed.h5", "r+") as file:
        file["samples/status"][:] = 2
    (folder / "text.h5").write_text("no HDF5")
    for words, told in (((folder / "sheet.h5",), 'not of the format "study-result"'), ((folder / "text.h5",), "text.h5: "),
                        ((folder / "nowhere.h5",), "nowhere.h5: "), ((folder / "grid.study.h5", "--of", "peak"), 'has no "peak"; allowed: force'),
                        ((folder / "failed.h5",), "300 samples none was solved"), ((folder / "grid.study.h5", "--top", 0), "--top: 0"),
                        ((folder / "grid.study.h5", "--of", "moment"), "invalid choice")):
        done = run_script("draw/draw_study", *words, "-o", folder / "refused.png")
        last = done.stderr.splitlines()[-1]
        assert done.returncode == 2 and told in last and last.startswith("draw_study: error: "), (words, done)
        assert not done.stdout and not (folder / "refused.png").exists(), words
    done = run_script("draw/draw_study", folder / "grid.study.h5", "-o", folder / "nowhere/a.png")
    assert done.returncode == 2 and "nowhere/a.png" in done.stderr and not done.stdout, done


with tempfile.TemporaryDirectory() as name:
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    solve(Path(name))
    for check in (pictures, curves, refusals):
        check(Path(name))
        print(f"{check.__name__}: as they should be", flush=True)
