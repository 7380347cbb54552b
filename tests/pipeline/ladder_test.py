# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains of segments, by scripts/chain_matrices and stage3_nonlinear: ladder_test.py BIN_FOLDER."""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.dont_write_bytecode = True
from scripts import run_script  # noqa: E402

# AFFDL-TR-67-184: on the doubler at fastener 1 ... 10, in lb, printed to 0.1.
PRINTED = [385.1, 1554.5, 853.1, 442.1, 181.7, -17.0, -221.4, -501.1, -951.4, -1725.7]
P, SEGMENT, FASTENER, CLEARANCE = 8000, 4.7e6, 8e5, 0.003


def chain(*words):
    return run_script("chain_matrices", *words)


def write_chain(path, *words):
    result = chain("-o", path, *words)
    assert (result.returncode, result.stdout, result.stderr) == (0, "", ""), result


def stiffness(path, level=-1):
    """All of S, discs first."""
    with h5py.File(path) as f:
        S_dd, S_ed, S_ee = (f[name][level] for name in ("S_dd", "S_ed", "S_ee"))
    return np.block([[S_dd, S_ed.T], [S_ed, S_ee]])


def solve(scene, *words):
    Path("scene.json").write_text(json.dumps(scene))
    subprocess.run(["stage3_nonlinear", "scene.json", "-o", "result.h5", "--quiet", *words], check=True)
    with h5py.File("result.h5") as f:
        names = ("load_factor", "event", "F", "delta", "plates/sheet/Pe", "plates/sheet/D", "plates/doubler/D")
        return {name: f[name][:] for name in names}


def check_recurrence(F, load, clearance_of_1):
    """Compatibility: neighbours differ by how much more the sheet than the doubler stretches between them."""
    doubler = np.cumsum(F)[:-1]
    stretch = F / FASTENER
    stretch[0] += clearance_of_1
    assert np.allclose(stretch[:-1] - stretch[1:], (load - 2 * doubler) / SEGMENT, rtol=0, atol=1e-14), F


def check_ladder():
    shutil.copytree(ROOT / "scripts", "scripts")
    shutil.copytree(ROOT / "examples/ladder", "examples/ladder", ignore=shutil.ignore_patterns("*.h5"))
    os.chdir("examples/ladder")
    subprocess.run(["make", "-s"], check=True, capture_output=True)
    subprocess.run(["make", "-q"], check=True)
    with h5py.File("joint.h5") as f:
        F, sheet, doubler = f["F"][-1], f["plates/sheet/D"][-1], f["plates/doubler/D"][-1]
    assert np.abs(F - PRINTED).max() < 0.05, F  # half of the last digit printed
    assert np.array_equal(np.round(F, 1), PRINTED)
    # Each disc in equilibrium under its segments, the doubler as a whole; order of discs: fastener 10 ... 1.
    tension = SEGMENT * np.diff(doubler)
    assert abs(F.sum()) < 1e-9 * P
    assert np.allclose(np.diff(tension, prepend=0, append=0), -F[::-1], atol=1e-6)
    assert np.allclose(SEGMENT * np.diff(sheet) + tension, P, atol=1e-6), "what one lacks the other carries"
    check_recurrence(F, P, CLEARANCE)
    page = Path("README.md").read_text()
    for words in (map(str, PRINTED), (f"{force:.2f}" for force in F)):
        assert f"| {' | '.join(words)} |" in page, "the example's page has these numbers"
    check_contact(json.loads(Path("joint.json").read_text()), page)


def check_contact(scene, page):
    """Open, fastener 1 carries nothing; it bears from the load on that the page tells."""
    load = float(re.search(r"bears from (\d+) lb", page)[1])
    open_, closed = ((load + by) / P for by in (-1, 1))
    result = solve({**scene, "increments": [open_, closed]})
    (F_open, F_closed), (gap, _) = result["F"], result["delta"][:, 0]
    events = solve({**scene, "increments": "events"})
    assert list(events["event"]) == [b"1 closes", b""] and events["load_factor"][1] == 1
    assert abs(events["load_factor"][0] * P - load) < 0.5, events["load_factor"]
    assert abs(events["delta"][0, 0] - CLEARANCE) < 1e-12 * CLEARANCE and abs(events["F"][0, 0]) < 1e-12 * P
    assert F_open[0] == 0 and 0 < F_closed[0] < 1 and 0 < CLEARANCE - gap < 1e-3 * CLEARANCE, (F_open, gap)
    check_recurrence(F_open, load - 1, gap)
    check_recurrence(F_closed, load + 1, CLEARANCE)


def check_floating_doubler():
    """Two fasteners: one equation of compatibility says what they carry, at every degree."""
    random = np.random.default_rng(1)
    K, k_sheet, k_doubler = np.exp(random.uniform(np.log(1e3), np.log(1e6), 3))
    write_chain("sheet.h5", "--segments", k_sheet, "--left", "ground=500/2", "--right", "external:P=1e4")
    write_chain("doubler.h5", "--segments", k_doubler)
    scene = {"format": "joint", "version": 1, "plates": {"sheet": "sheet.h5", "doubler": "doubler.h5"},
             "laws": {"lin": {"type": "linear", "k": K}},
             "fasteners": [{"id": i, "between": [f"sheet:{i}", f"doubler:{i}"], "law": "lin"} for i in "12"],
             "loads": [{"external": "sheet:P", "force": 1000}]}
    F = 1000 / k_sheet / (2 / K + 1 / k_sheet + 1 / k_doubler)
    for words in ([], ["--p", "1"]):
        result = solve(scene, *words)
        assert np.allclose(result["F"][-1], [-F, F], rtol=1e-9), "a chain has no degree"
        assert np.isclose(result["plates/sheet/D"][-1, 0], 1000 / 250, rtol=1e-9), "EA/L holds the sheet"
    check_displacement(scene)


def check_displacement(scene):
    """Externals at both ends, one held: series of all that lies between them."""
    write_chain("sheet.h5", "--left", "external:Q=300", "--right", "external:P=600")
    write_chain("doubler.h5", "--left", "ground=100")
    scene = {**scene, "fasteners": [{"id": "1", "between": ["sheet:1", "doubler:1"], "law": "lin"}],
             "laws": {"lin": {"type": "linear", "k": 100}},
             "loads": [{"external": "sheet:P", "displacement": 1}, {"external": "sheet:Q", "displacement": 0}]}
    result = solve(scene)
    at_disc = 600 / (600 + 300 + 50)
    assert np.allclose(result["plates/sheet/Pe"][-1], [-300 * at_disc, 600 * (1 - at_disc)], rtol=1e-9), result
    assert np.allclose(result["F"][-1], 50 * at_disc, rtol=1e-9)


def check_stiffness():
    """Rigid motion, forces between neighbours, and flexibilities in series of random chains."""
    random = np.random.default_rng(2)
    for n in (1, 2, 7, 12):
        k = np.exp(random.uniform(np.log(1e2), np.log(1e7), n + 1))  # left end, n - 1 segments, right end
        inner = ["--segments", *k[1:-1]] if n > 1 else []
        write_chain("free.h5", *inner)
        write_chain("pulled.h5", *inner, "--left", f"external:L={k[0]}", "--right", f"external:R={k[-1]}")
        write_chain("held.h5", *inner, "--left", f"ground={k[0]}", "--right", "free")
        free, pulled, held = map(stiffness, ("free.h5", "pulled.h5", "held.h5"))
        assert free.shape == held.shape == (n, n) and pulled.shape == (n + 2, n + 2)
        for S in (free, pulled, held):
            assert np.array_equal(S, S.T)
        for S in (free, pulled):
            assert np.abs(S.sum(axis=1)).max() <= 1e-15 * k.max() * 4, "no force in rigid motion: 4 roundings a row"
        # Pulled at its ends, held nowhere: one spring, the series of all.
        ends = pulled[n:, n:] - pulled[n:, :n] @ np.linalg.solve(pulled[:n, :n], pulled[:n, n:])
        assert np.allclose(ends * (1 / k).sum(), [[1, -1], [-1, 1]], rtol=1e-9, atol=1e-9)
        # A force on disc j moves disc i by the flexibility from the ground to the nearer of both.
        flexibility = np.cumsum(1 / k[:-1])
        exact = np.minimum.outer(flexibility, flexibility)
        assert np.allclose(held @ exact, np.eye(n), rtol=0, atol=1e-15 * k.max() * exact.max() * n)


def check_words():
    """K, EA/L and *N are the same stiffnesses; names and labels come through."""
    write_chain("a.h5", "--segments", "2e6*2", "5e5", "--holes", "p", "q", "r", "s", "--units", "mm", "N")
    write_chain("b.h5", "--segments", "2e6", "4e6/2", "1e6/2*1")
    assert np.array_equal(stiffness("a.h5"), stiffness("b.h5"))
    with h5py.File("a.h5") as a, h5py.File("b.h5") as b:
        assert list(a["disc/hole"].asstr()) == ["p", "q", "r", "s"] and list(b["disc/hole"].asstr()) == list("1234")
        assert json.loads(a.attrs["units"]) == {"length": "mm", "force": "N"} and "units" not in b.attrs
        assert a["S_dd"].attrs["unit"] == "N/mm" and b["S_dd"].attrs["unit"] == "force/length"
        assert all(np.array_equal(S, a["S_dd"][0]) for S in a["S_dd"]) and list(a["p"]) == list(range(1, 9))


def check_page():
    """What the page of MATRICES.h5 says of each dataset is so: version, type, rank, unit."""
    page = (ROOT / "schemas/plate-matrices.md").read_text()
    row = r"^\| `(.+?)` \| (\w+) \| \((.*?)\) \| (\S+) \| .* \| ([\d.]+) \|$"
    rows = {name: columns for name, *columns in re.findall(row, page, re.M)}
    write_chain("page.h5", "--segments", "7", "--left", "external:P=3")
    found = {}

    def compare(path, dataset):
        if not isinstance(dataset, h5py.Dataset):
            return
        kind, shape, unit, since = rows[path]
        is_text = h5py.check_string_dtype(dataset.dtype) is not None
        assert kind == ("string" if is_text else str(dataset.dtype)), path
        assert len(shape.split(",")) == dataset.ndim and dataset.attrs["unit"] == unit, path
        assert dataset.attrs["description"], path
        found[path] = [int(number) for number in since.split(".")]

    with h5py.File("page.h5") as f:
        f.visititems(compare)
        assert f.attrs["format"] == "plate-matrices" and list(f.attrs["version"]) == max(found.values())
    assert {"p", "disc/hole", "disc/direction", "S_dd", "S_ed", "S_ee", "external/id"} < set(found)


def check_whole():
    """The same words give the same bytes; a file that was there survives a failed run, a link stays a link."""
    words = ("--segments", "3*4", "--left", "ground=2", "--units", "in", "lbf")
    write_chain("whole.h5", *words)
    before = Path("whole.h5").read_bytes()
    os.symlink("whole.h5", "link.h5")
    write_chain("link.h5", *words)
    assert Path("link.h5").is_symlink() and Path("whole.h5").read_bytes() == before
    assert chain("-o", "whole.h5", "--segments", "none").returncode == 2 and Path("whole.h5").read_bytes() == before
    for path, message in (("none/a.h5", "No such file or directory"), ("folder", "Is a directory")):
        os.makedirs("folder", exist_ok=True)
        result = chain("-o", path)
        assert result.returncode == 3, result
        assert result.stderr == f"chain_matrices: error: {path}: cannot be written: {message}\n", result.stderr
    assert not list(Path().rglob("*.partial"))


def check_messages():
    segment = "is not a segment; allowed: K or EA/L, numbers > 0, and *N for N = 1..1000 of it, as in 4.7e6*9"
    last = "is not an end; allowed: free, ground=K, external:ID=K, with K or EA/L of numbers > 0"
    bad = [(f"argument --segments: '{word}' {segment}", "--segments", "1", word)
           for word in ("x", "0", "-3", "nan", "inf", "1/0", "1/2/3", "/2", "1e308/1e-308",
                        "3*0", "3*x", "3*", "3*1001", "*3")]
    bad += [(f"argument --{side}: '{word}' {last}", f"--{side}", word) for side in ("left", "right")
            for word in ("ground", "ground=0", "ground=x", "ground:a=1",
                         "external=1", "external:=1", "external:P", "P=1", "")]
    names = "different ones, one for each disc, one more than segments"
    bad += [
        (f"argument --holes: 3 names (a, b, a); allowed: 3 {names}", "--segments", "1*2", "--holes", "a", "b", "a"),
        (f"argument --holes: 1 names (a); allowed: 2 {names}", "--segments", "1", "--holes", "a"),
        (f"argument --holes: 2 names (a, ); allowed: 2 {names}", "--segments", "1", "--holes", "a", ""),
        ("argument --right: external 'P' is at the left end already; allowed: another id",
         "--left", "external:P=1", "--right", "external:P=2"),
        ("argument --units: ['in', '']; allowed: two labels that are not empty", "--units", "in", ""),
        ("argument --units: expected 2 arguments", "--units", "in"),
        ("unrecognized arguments: --hole a", "--hole", "a"),
    ]
    for message, *words in bad:
        result = chain("-o", "no.h5", *words)
        assert result.returncode == 2, (words, result)
        assert result.stderr.endswith(f"\nchain_matrices: error: {message}\n"), (words, message, result.stderr)
    assert "required: -o/--output" in chain().stderr and chain().returncode == 2
    assert not Path("no.h5").exists()


def main(bin_folder):
    os.environ["PATH"] = str(Path(bin_folder).resolve()) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        for check in (check_ladder, check_floating_doubler, check_stiffness, check_words, check_page, check_whole,
                      check_messages):
            folder = Path(work) / check.__name__
            folder.mkdir()
            os.chdir(folder)
            check()
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
