#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies against closed forms, runs of their own, numpy, and each other: study_test.py FOLDER_OF_PROGRAMS [sweep].

The sweep kills a study 100 times, and takes a million samples for its memory."""
import json
import math
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from one_hole import PROGRAMS, matrices, near, end_if_missed  # noqa: E402
from study_numbers import place, share, value  # noqa: E402

SWEEP = "sweep" in sys.argv[2:]
K, C = 1000.0, 0.01  # stiffness of a law, and the largest clearance


SPRINGS = {"compression_only": True, "harmonics": 16}
DISKS = {"compression_only": True, "disk": {"E": 2e5, "nu": 0.3, "law": "elastic"}}


def row_of_pins(folder, n, E, name, contact=None):
    """A sheet with n holes of radius 1 in a row along y, held against turning, that is moved along x."""
    y = [10 * i for i in range(n + 1)]
    spring = {"spring": {**({} if contact is DISKS else {"modulus": E}), **(contact or {})}}
    matrices(folder, {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": {"E": E, "nu": 0.3}},
                      "geometry": {"grid": {"x": [-10, -5, 5, 10], "y": y, "thickness": 1}}, "disc_directions": ["x"],
                      "supports": [{"on": side, "fix": ["y"]} for side in ("bottom", "top")],
                      "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}],
                      "holes": [{"id": str(i + 1), "center": [0, 10 * i + 5], "radius": 1, **spring} for i in range(n)]}, name)


def joint_of(name, n, P, law=None, **more):
    return {"format": "joint", "version": 1, "plates": {"sheet": f"{name}.h5"}, "laws": {"pin": law or {"type": "linear", "k": K}},
            "fasteners": [{"id": str(i + 1), "between": [f"sheet:{i + 1}", "ground"], "law": "pin", **more} for i in range(n)],
            "loads": [{"external": "sheet:P", "force": P}]}


def run(folder, joint, study, *words, output="study.h5", status=0):
    """Runs a study; what it says."""
    (folder / "joint.json").write_text(json.dumps(joint))
    (folder / "study.json").write_text(json.dumps({"format": "study", "version": 1, **study}))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "--study", "study.json", "-o", output, *words], cwd=folder,
                          capture_output=True, text=True)
    assert done.returncode == status, (words, done.returncode, done.stderr)
    return done.stdout + done.stderr


def uniform(low, high):
    return {"distribution": {"type": "uniform", "from": low, "to": high}}


EACH_CLEARANCE = {"name": "clearance", "at": "/fasteners/*/clearance", "each": True, **uniform(0, C)}


def closed_forms(folder):
    """A rigid sheet on n springs: with all bearing F_i = P/n + k (mean of the clearances less its own)."""
    for n, quantiles in ((4, (0.5066, 0.5863)), (2, (0.38820, 0.45))):
        P = 4 * n * K * C
        row_of_pins(folder, n, 1e9, "rigid")
        run(folder, joint_of("rigid", n, P), {"samples": 100000, "seed": 1, "variables": [EACH_CLEARANCE], "limits": {"force": P / n}})
        with h5py.File(folder / "study.h5") as study:
            force, largest = study["statistics/force"], study["statistics/largest_force"]
            assert study["statistics/n_status"][0] == 100000
            for i in range(n):
                near(f"{n} springs: variance of F {i + 1}", force["deviation"][i]**2, K**2 * C**2 * (1 - 1 / n) / 12, 0.02)
                near("  by sensitivities", force["by_sensitivities"][i]**2, K**2 * C**2 * (1 - 1 / n) / 12, 0.02)
                near("  governs", force["governs"][i], 1 / n, 0.02)
                near("  above the mean", force["exceeds"][i], 0.5, 0.01)
                assert force["exceeds_low"][i] < force["exceeds"][i] < force["exceeds_high"][i]
            near("  largest: mean", largest["mean"][0], P / n + K * C * (0.5 - 1 / (n + 1)), 0.01)
            for at, factor in zip((2, 3), quantiles):
                near("  largest: quantile less P/n, over k C", (largest["quantile"][0, at] - P / n) / (K * C), factor, 0.01)
                low, high = largest["quantile_low"][0, at], largest["quantile_high"][0, at]
                assert low < largest["quantile"][0, at] < high and high - low < 0.02 * K * C, (low, high)
            all_forces = study["samples/force"][:]
            assert np.array_equal(np.sort(all_forces[:, 0])[[4999, 49999, 94999, 98999]], force["quantile"][0])
            assert np.array_equal(all_forces.max(axis=1), study["samples/largest_force"][:])
            ranks = np.argsort(np.argsort(all_forces[:, 0])), np.argsort(np.argsort(study["samples/variable"][:, 0]))
            near("  rank correlation", force["rank_correlation"][0, 0], np.corrcoef(*ranks)[0, 1], 1e-9)


DISTRIBUTIONS = [{"type": "uniform", "from": 0, "to": C}, {"type": "triangular", "from": 0, "mode": 0.3 * C, "to": C},
                 {"type": "normal", "mean": C, "deviation": 0.1 * C}, {"type": "lognormal", "mean": C, "deviation": 0.3 * C},
                 {"type": "discrete", "values": [0.1 * C, 0.2 * C, 0.7 * C], "weights": [1, 2, 5]}]


def numbers_of_numpy(folder):
    row_of_pins(folder, 5, 1e5, "five")
    variables = [{"at": f"/fasteners/{i}/clearance", "distribution": each} for i, each in enumerate(DISTRIBUTIONS)]
    n, seed = 20000, 123456789
    for sampling in ("random", "latin hypercube"):
        run(folder, joint_of("five", 5, 100), {"samples": n, "seed": seed, "sampling": sampling, "variables": variables})
        with h5py.File(folder / "study.h5") as study:
            drawn = study["samples/variable"][:]
        for sample in (0, 1, 12345, n - 1):
            for v, distribution in enumerate(DISTRIBUTIONS):
                u = share(seed, sample, v)
                if sampling == "latin hypercube":
                    u = (place(seed, sample, v, n) + u) / n
                assert drawn[sample, v] == value(distribution, u), (sampling, sample, v, drawn[sample, v], value(distribution, u))
        if sampling == "latin hypercube":
            assert np.array_equal(np.sort((drawn[:, 0] / C * n).astype(int)), np.arange(n)), "one sample in each stratum"


def contact_study():
    """A joint in contact with friction, gaps and interference, whose samples differ in all that a study may vary."""
    joint = joint_of("contact", 3, 50.0, {"type": "power", "A": 2000, "n": 0.9}, gap=0.001, friction=0.1) | {"increments": 2}
    variables = [{"name": "gap", "at": "/fasteners/*/gap", "each": True, **uniform(-5e-4, 2e-3)},
                 {"name": "friction", "at": "/fasteners/*/friction", **uniform(0.0, 0.3)},
                 {"name": "A", "at": "/laws/pin/A", "use": "factor", "distribution": {"type": "lognormal", "mean": 1, "deviation": 0.2}},
                 {"name": "load", "at": "/loads/0/force", "use": "offset", **uniform(-20, 20)}]
    return joint, {"samples": 40, "seed": 5, "variables": variables, "outputs": ["peaks", "displacements"]}


def samples_are_runs(folder):
    """What the study has of a sample is what a run of its joint has, from no load; peaks at disks with friction are extrapolated in both."""
    for contact in (DISKS, SPRINGS):  # other checks go on with the last
        row_of_pins(folder, 3, 7e4, "contact", contact)
        samples_are_runs_of(folder)


def samples_are_runs_of(folder):
    run(folder, *contact_study())
    with h5py.File(folder / "study.h5") as study:
        for sample in (0, 7, 39):
            run(folder, *contact_study(), "--sample", str(sample), output="one.json")
            done = subprocess.run([PROGRAMS / "stage3_nonlinear", "one.json", "-o", "one.h5", "--quiet"], cwd=folder, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            with h5py.File(folder / "one.h5") as one:
                for name, found, truth in (("force", study["samples/force"][sample], np.abs(one["transferred"][-1, :, 0])),
                                           ("peak", study["samples/peak"][sample], one["plates/sheet/rim/peak_hoop"][-1]),
                                           ("displacement", study["samples/displacement"][sample], one["plates/sheet/De"][-1])):
                    near(f"sample {sample}: {name}", np.abs(found - truth).max() / np.abs(truth).max(), 0, 1e-8, absolute=True)


def same_bytes(folder):
    """Threads, slices and their order leave no trace, and neither does a study that was there before."""
    joint, study = contact_study()
    run(folder, joint, study, "--threads", "1")
    truth = (folder / "study.h5").read_bytes()
    for threads in ("2", "8"):
        run(folder, joint, study, "--threads", threads)
        assert (folder / "study.h5").read_bytes() == truth, threads
    study["samples"] = 200
    run(folder, joint, study)
    truth = (folder / "study.h5").read_bytes()
    for i in (3, 1, 7, 2, 5, 4):
        run(folder, joint, study, "--slice", f"{i}/7", output="sliced.h5")
    said = run(folder, joint, study, "--merge", output="sliced.h5", status=2)
    assert "sliced.h5.parts: lacks samples 144 to 175" in said, said
    run(folder, joint, study, "--slice", "6/7", output="sliced.h5")
    for name, changed in (("another joint", (joint | {"name": "x"}, study)), ("another study", (joint, study | {"name": "x"}))):
        said = run(folder, *changed, "--merge", output="sliced.h5", status=2)
        assert f"its samples are of {name}" in said, said
    run(folder, joint, study, "--merge", output="sliced.h5")
    assert (folder / "sliced.h5").read_bytes() == truth and not (folder / "sliced.h5.parts").exists()
    said = run(folder, joint, study, "--merge", output="sliced.h5", status=2)
    assert "sliced.h5 is there: another merge may have made it" in said, said
    run(folder, joint, study, "--slice", "1/2", output="sliced.h5")
    row_of_pins(folder, 3, 7.1e4, "contact", contact=SPRINGS)
    said = run(folder, joint, study, output="sliced.h5", status=2)
    assert "another matrices of plate sheet" in said, said
    row_of_pins(folder, 3, 7e4, "contact", contact=SPRINGS)
    for words, what in ((["--p", "7", "--slice", "2/2"], "another polynomial degree"), (["--p", "7"], "another polynomial degree")):
        said = run(folder, joint, study, *words, output="sliced.h5", status=2)
        assert what in said, said
    said = run(folder, joint | {"name": "x"}, study, "--slice", "2/2", output="sliced.h5", status=2)
    assert "another joint" in said, "it is refused before any work"
    (folder / "sliced.h5.parts/block-000003.h5").write_bytes(b"")
    assert "remove this block" in run(folder, joint, study, output="sliced.h5", status=3)
    (folder / "sliced.h5.parts/block-000003.h5").unlink()
    run(folder, joint, study, output="sliced.h5")
    assert (folder / "sliced.h5").read_bytes() == truth


def kills(folder):
    """A study that is killed again and again ends as one that is not, and goes on where it was."""
    joint, study = contact_study()
    study["samples"] = 400 if SWEEP else 160
    started = time.time()
    run(folder, joint, study)
    truth = (folder / "study.h5").read_bytes()
    whole, chance = time.time() - started, random.Random(11)
    words = [PROGRAMS / "stage3_nonlinear", "joint.json", "--study", "study.json", "-o", "killed.h5", "--quiet"]
    n_blocks = []
    for i in range(100 if SWEEP else 12):
        going = subprocess.Popen(words, cwd=folder, stderr=subprocess.DEVNULL)
        time.sleep(chance.uniform(0, (0.1 if SWEEP else 0.2) * whole))
        going.send_signal(chance.choice((signal.SIGKILL, signal.SIGINT, signal.SIGTERM)))
        going.wait()
        n_blocks.append(len(list((folder / "killed.h5.parts").glob("block-*.h5"))))
        if (folder / "killed.h5").exists():  # it ended before
            assert (folder / "killed.h5").read_bytes() == truth
            (folder / "killed.h5").unlink()
            n_blocks.clear()
        assert n_blocks == sorted(n_blocks), "no block is lost"
    subprocess.run(words, cwd=folder, check=True, capture_output=True)
    assert (folder / "killed.h5").read_bytes() == truth
    assert sorted(path.name for path in folder.glob("killed.h5*")) == ["killed.h5"]


def failures(folder):
    """One sample in twenty is refused and one not solved: counted, named, and to be had as a joint of its own."""
    row_of_pins(folder, 2, 1e5, "two")
    law = {"type": "bilinear", "k": 1000, "F_yield": 20, "k_yield": 0}
    joint, seed = joint_of("two", 2, 30, law), 9
    study = {"samples": 2000, "seed": seed, "limits": {"force": 15},
             "variables": [{"name": "load", "at": "/loads/0/force", "distribution": {"type": "discrete", "values": [30, 50], "weights": [19, 1]}},
                           {"name": "clearance", "at": "/fasteners/0/clearance", "distribution": {"type": "discrete", "values": [0.01, -1], "weights": [19, 1]}}]}
    said = run(folder, joint, study)
    with h5py.File(folder / "study.h5") as result:
        status, drawn = result["samples/status"][:], result["samples/variable"][:]
        expected = np.where(drawn[:, 1] < 0, 1, np.where(drawn[:, 0] > 40, 2, 0))
        assert np.array_equal(status, expected) and 60 < (status == 1).sum() < 140 and 60 < (status == 2).sum() < 140
        assert np.array_equal(np.isnan(result["samples/force"][:, 0]), status != 0)
        assert np.array_equal(result["statistics/n_status"][:], [(status == i).sum() for i in range(4)])
        assert result["statistics/force/exceeds_high"][1] - result["statistics/force/exceeds_low"][1] > 0.08, "failed ones count as either"
    first = int(np.flatnonzero(status)[0])
    assert f"{(status != 0).sum()} samples failed ({(status == 1).sum()} refused, {(status == 2).sum()} not solved" in said, said
    assert f"--sample {first} -o FILE.json" in said, said
    for kind, words in ((1, "clearance"), (2, "limit")):
        run(folder, joint, study, "--sample", str(int(np.flatnonzero(status == kind)[0])), output="one.json")
        done = subprocess.run([PROGRAMS / "stage3_nonlinear", "one.json", "-o", "one.h5"], cwd=folder, capture_output=True, text=True)
        assert done.returncode == (2 if kind == 1 else 4) and words in done.stderr, done.stderr


def bad_studies(folder):
    joint = joint_of("two", 2, 30)
    good = {"samples": 5, "seed": 1, "variables": [{"at": "/fasteners/0/clearance", **uniform(0, 1)}]}
    for change, words in (
            ({"samples": 0}, "study.json: /samples: 0 is not allowed; allowed: an integer from 1"),
            ({"variables": []}, "/variables: "),
            ({"variables": [{"at": "/plates/sheet", **uniform(0, 1)}]}, "/variables/0/at: \"/plates/sheet\" is not allowed; allowed: JSON pointers"),
            ({"variables": [{"at": "/laws/other/k", **uniform(0, 1)}]}, "leads to no number of the joint"),
            ({"variables": [{"at": "/laws/pin/type", **uniform(0, 1)}]}, "leads to no number of the joint"),
            ({"variables": [{"at": "/fasteners/00/clearance", **uniform(0, 1)}]}, "leads to no number of the joint"),
            ({"variables": [{"at": "/fasteners/7/clearance", **uniform(0, 1)}]}, "leads to no number of the joint"),
            ({"variables": [{"at": "/laws/pin/k", "use": "factor", "values": [1e99]}], "samples": 1, "sampling": "random"}, "/laws/pin/k: "),
            ({"variables": [{"at": "/fasteners/0/clearence", **uniform(0, 1)}]}, "unknown key"),
            ({"outputs": ["peaks"], "variables": [{"at": "/plates", **uniform(0, 1)}]}, "allowed: JSON pointers"),
            ({"variables": [{"at": "/laws/pin/k"}]}, "one of \"values\", \"grid\", \"table\" and \"distribution\""),
            ({"variables": 2 * good["variables"]}, "stands twice"),
            ({"variables": [good["variables"][0] | {"name": "a"}, good["variables"][0]]}, "is varied already"),
            ({"variables": [good["variables"][0] | {"use": "factor"}]}, "no number at"),
            ({"variables": [{"at": "/laws/pin/k", "distribution": {"type": "uniform", "from": 2, "to": 1}}]}, "/distribution/to: 1"),
            ({"sampling": "grid"}, "not all variables have levels"),
            ({"variables": [{"at": "/laws/pin/k", "table": {"file": "table.csv", "column": "b"}}]}, "table.csv:1: no column \"b\"; allowed: a"),
            ({"variables": [{"at": "/laws/pin/k", "table": {"file": "table.csv", "column": "a"}}]}, "5; allowed: up to the 2 rows"),
            ({"limits": {"force": 0}}, "/limits/force: 0")):
        (folder / "table.csv").write_text("a\n1000\n2000\n")
        said = run(folder, joint, good | change, status=2)
        assert words in said, (words, said)
    for option, words in (("--slice=3/2", "i from 1 to n"), ("--slice= 1/2", "i from 1 to n"), ("--slice=1/2x", "i from 1 to n"), ("--sample=5", "--sample: '5' is not allowed; allowed: an integer from 0 to 4"), ("--csv=x.csv", "given together with --study")):
        assert words in run(folder, joint, good, option, status=2)
    assert "--slice: '' is not allowed; allowed: I/N" in run(folder, joint, good, "--slice", "", status=2), "a variable of the shell that is not set"
    assert "given together with --merge" in run(folder, joint, good, "--slice", "1/2", "--merge", status=2)
    subprocess.run([PROGRAMS / "stage2_extract", "two.plate.h5", "-o", "two.h5", "--loads-only", "--quiet"], cwd=folder, check=True)
    assert "no plate's matrices hold stresses" in run(folder, joint, good | {"outputs": ["peaks"]}, status=2)
    (folder / "table.csv").write_text("a\n1000\nx\n")
    said = run(folder, joint, {"variables": [{"at": "/laws/pin/k", "table": {"file": "table.csv", "column": "a"}}]}, status=2)
    assert "table.csv:3: \"x\" in column \"a\"" in said, said


def rare_friction(folder):
    """Friction that hardly any sample has, in a joint that has none, is that of runs with it."""
    row_of_pins(folder, 2, 1e5, "two")
    variables = [{"at": "/fasteners/1/friction", "distribution": {"type": "discrete", "values": [0.3, 0], "weights": [1, 999]}},
                 {"at": "/fasteners/0/clearance", **uniform(0, 0.01)}]
    run(folder, joint_of("two", 2, 30), {"samples": 2000, "seed": 3, "variables": variables})
    with h5py.File(folder / "study.h5") as study:
        rubs = np.flatnonzero(study["samples/variable"][:, 0] > 0)
        force = study["samples/force"][:]
    assert 0 < len(rubs) < 20
    for sample in (rubs[0], 0 if 0 not in rubs else 1):
        run(folder, joint_of("two", 2, 30), {"samples": 2000, "seed": 3, "variables": variables}, "--sample", str(sample), output="one.json")
        subprocess.run([PROGRAMS / "stage3_nonlinear", "one.json", "-o", "one.h5", "--quiet"], cwd=folder, check=True, capture_output=True)
        with h5py.File(folder / "one.h5") as one:
            near(f"rare friction, sample {sample}", np.abs(force[sample] - np.abs(one["transferred"][-1, :, 0])).max() / 15, 0, 1e-10, absolute=True)


def grids_and_tables(folder):
    """All combinations, the last variable fastest; and rows of a table."""
    joint = joint_of("two", 2, 30)
    run(folder, joint, {"variables": [{"at": "/laws/pin/k", "values": [1000, 3000]},
                                      {"at": "/fasteners/0/clearance", "grid": {"from": 0.001, "to": 0.1, "n": 3, "spacing": "logarithmic"}}]})
    with h5py.File(folder / "study.h5") as study:
        assert np.allclose(study["samples/variable"][:], [[k, c] for k in (1000, 3000) for c in (0.001, 0.01, 0.1)], rtol=1e-14)
        assert study.attrs["sampling"] == "grid"
    (folder / "table.csv").write_text("k, c\n1000, 0.5\n2000, 0.25\n")
    tabled = {"variables": [{"at": "/laws/pin/k", "table": {"file": "table.csv", "column": "k"}}]}
    assert "a file that study.json reads" in run(folder, joint, tabled, output="table.csv", status=2)
    run(folder, joint, {"variables": [{"at": place, "table": {"file": "table.csv", "column": column}} for place, column in
                                      (("/laws/pin/k", "k"), ("/fasteners/1/clearance", "c"))]})
    with h5py.File(folder / "study.h5") as study:
        assert study["samples/variable"][:].tolist() == [[1000, 0.5], [2000, 0.25]]
    assert "seed" not in run(folder, joint, tabled, "--sample", "1", output="one.json"), "a table needs none"
    assert json.loads((folder / "one.json").read_text())["laws"]["pin"]["k"] == 2000
    assert "slices and --sample would not be" in run(folder, joint, {"samples": 3, "variables": [EACH_CLEARANCE]}, "--sample", "1", status=2)


def margins(folder):
    """One spring whose load is normal: P(margin < m) is that of a load above P_su / (1 + m)."""
    P, deviation, P_su, least, n = 40.0, 0.1, 46.0, 0.1, 40000
    row_of_pins(folder, 1, 1e9, "one")
    joint = joint_of("one", 1, P) | {"margins": {"checks": [{"check": "fastener shear", "name": "shear", "P_su": P_su}, {"check": "fastener shear", "P_su": P_su}]}}
    load = {"name": "load", "at": "/loads/0/force", "use": "factor", "distribution": {"type": "normal", "mean": 1, "deviation": deviation}}
    said = run(folder, joint, {"samples": n, "seed": 3, "variables": [load], "outputs": ["margins"],
                               "limits": {"shear": least, "force": {"1": 1.2 * P}}})
    above = lambda factor: 0.5 * math.erfc((factor - 1) / deviation / math.sqrt(2))  # noqa: E731
    with h5py.File(folder / "study.h5") as study:
        of = study["statistics/utilisation"]
        assert list(of["of"].asstr()) == ["shear: 1", "fastener shear: 1"]
        for i, m in enumerate((least, 0)):
            near(f"limit of margin {m}", of["limits"][i], 1 / (1 + m), 1e-12)
            near(f"P(margin < {m})", of["exceeds"][i], above(P_su / P / (1 + m)), 0.05)
            assert of["exceeds_low"][i] < of["exceeds"][i] < of["exceeds_high"][i]
        near("limit of a fastener", study["statistics/force/exceeds"][0], above(1.2), 0.1)
        near("utilisation in the middle", of["middle"][1], P / P_su, 1e-9)
        assert np.allclose(study["samples/utilisation"][:, 1] * P_su, study["samples/force"][:, 0], rtol=1e-12)
    assert "P(margin < its limit)" in said and "P(> 48)" in said, said
    joint["margins"]["checks"].pop(0)
    assert "P(margin < 0)" in run(folder, joint, {"samples": 20, "seed": 3, "variables": [load], "outputs": ["margins"]})
    for limits, text in (({"shear": 0.1}, "force, peak, K_I, bent_peak, fastener shear"), ({"force": {"2": 1}}, "/limits/force/2: no fastener; allowed: 1")):
        assert text in run(folder, joint, {"samples": 20, "seed": 3, "variables": [load], "limits": limits}, status=2), text
    del joint["margins"]
    assert "the joint has no checks" in run(folder, joint, {"samples": 20, "seed": 3, "variables": [load], "outputs": ["margins"]}, status=2)


def memory(folder):
    """Statistics have the numbers of all samples at once, here of one group of two forces, with ranks and variables."""
    most = {}
    for n in (20000, 1000000 if SWEEP else 200000):
        study = {"samples": n, "seed": 1, "variables": [EACH_CLEARANCE]}
        run(folder, joint_of("two", 2, 200), study, "--quiet", "--timings", "times.json")
        most[n] = json.loads((folder / "times.json").read_text())["peak_memory_bytes"]
    few, many = most.values()
    assert many < few + 8 * 8 * (1000000 if SWEEP else 200000), most
    print(f"memory by samples: {most}")


with tempfile.TemporaryDirectory() as name:
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    for check in (closed_forms, numbers_of_numpy, samples_are_runs, same_bytes, kills, failures, bad_studies, rare_friction, grids_and_tables, margins, memory):
        before = time.time()
        check(Path(name))
        print(f"{check.__name__}: {time.time() - before:.1f} s", flush=True)
end_if_missed()
