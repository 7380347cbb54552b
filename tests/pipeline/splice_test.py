# SPDX-License-Identifier: GPL-3.0-or-later
"""The splice of the README: its laws are those of their sources, its tables what it prints: splice_test.py BIN_FOLDER."""
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.dont_write_bytecode = True
from examples import copy_example  # noqa: E402
from pictures import check_curves, check_field  # noqa: E402

HUTH = {"type": "formula", "formula": "huth rivet", "mode": "fastener only", "shear": "single", "t": [1.6, 1.6],
        "E": [72400, 72400], "d": 4, "E_f": 71000}


def done(*words):
    return subprocess.run(words, check=True, capture_output=True, text=True)


def solve(joint):
    Path("changed.json").write_text(json.dumps(joint))
    run = done("stage3_nonlinear", "changed.json", "-o", "changed.h5", "--quiet")
    return h5py.File("changed.h5"), run.stderr


def check_run(page):
    """Tables, solver and balance, without a warning; the picture."""
    run = done("make", "-s")
    assert "warning" not in run.stderr, run.stderr
    assert "18 fasteners, p = 8, damped newton" in run.stdout and "exact path" not in run.stdout
    table = done("make", "-s", "table").stdout
    assert table in page, f"README.md shows another table than:\n{table}"
    with h5py.File("joint.h5") as f:
        assert f.attrs["complete"] == 1 and len(f["load_factor"]) == 4
        load = f["F_vector"][-1].sum(axis=0)
        assert np.allclose(load, [16000, 0], atol=1e-5), load
        names = list(f["fastener/id"].asstr())
        F, fastest = f["F"][-1], f["F"][-1].argmax()
    assert names[fastest] == "a5", "the column beside the loose one carries most"
    assert all(F[names.index(f"{row}6")] < F[names.index(f"{row}4")] < F[names.index(f"{row}5")] for row in "abc")
    done("make", "-s", "out/stress.png")
    check_field("out/stress.png")


def check_laws(page):
    """Both laws have the stiffness of Huth's rivet without the bearing of the sheets: the power law as a secant at 1000 N, the
    cubic at first, of which a tenth is left at the rivet's shear strength."""
    joint = json.loads(Path("joint.json").read_text())
    power, cubic = joint["laws"]["rivet"], joint["laws"]["loose rivet"]
    result, said = solve({**joint, "laws": {"rivet": HUTH, "loose rivet": HUTH}})
    assert "formula" not in said, said
    with result:
        tight = [i for i, name in enumerate(result["fastener/id"].asstr()) if not name.endswith("6")]
        k = (result["F"][-1] / result["delta"][-1])[tight]
    assert np.ptp(k) < 1e-6 * k[0] and f"{k[0]:.0f} N/mm" in page, k
    secant = 1000 / (1000 / power["A"]) ** (1 / power["n"])
    assert abs(secant / k[0] - 1) < 1e-3, secant
    delta = np.array(cubic["delta"])
    a = np.linalg.solve(delta[:, None] ** [1, 2, 3], cubic["F"])
    assert abs(a[0] / k[0] - 1) < 5e-3, a
    ends = [u for u in np.roots([3 * a[2], 2 * a[1], 0.9 * a[0]]).real if u > delta[-1]]
    strength = 207 * np.pi * 2**2
    assert abs(a @ min(ends) ** np.array([1, 2, 3]) / strength - 1) < 0.01, (ends, strength)
    slope = a[0] + 2 * a[1] * np.linspace(0, 1) + 3 * a[2] * np.linspace(0, 1) ** 2
    assert (slope > 0).all(), "it rises everywhere"


def check_choices(page):
    """What other choices would make of it, as the page tells; of the last two stage 3 warns."""
    said = {}
    for choice in ("frictionless", "filled", "held"):
        run = done("make", "-s", choice)
        said[choice] = run.stderr
        told = run.stdout.splitlines()[-1]
        assert f"> {told}\n" in page, f"README.md says otherwise than:\n{told}"
        assert ("warning" in run.stderr) == (choice != "frictionless"), run.stderr
    for choice, words, unit in (("held", r"\[disc-held-across\]: .* reaction of ([\d.]+) N ", "N"),
                                ("filled", r"\[springs-pull\]: .* of up to ([\d.]+) N/mm\^2", "N/mm²")):
        told = f"{float(re.search(words, said[choice])[1]):.0f} {unit}"
        assert told in page.replace("\n", " "), (choice, told, said[choice])
    with h5py.File("out/filled/joint.h5") as f:
        highest = max(f[f"plates/{plate}/rim/peak_hoop"][-1].max() for plate in ("upper", "lower"))
    assert f"{highest:.0f} N/mm² instead of 379" in page.replace("\n", " "), highest
    assert "N/mm² instead of 379" in (ROOT / "docs/choosing.md").read_text()
    done("make", "-s", "out/choices.png")
    check_curves("out/choices.png", ["C0", "C2", "C3"])


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    page = (ROOT / "examples/splice/README.md").read_text()
    with tempfile.TemporaryDirectory() as name:
        os.chdir(copy_example("splice", name))
        check_run(page)
        check_laws(page)
        check_choices(page)
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
