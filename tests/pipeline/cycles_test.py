#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws that remember in whole joints: cycles, sets, shakedown and ratcheting, random joints through random cycles, and what is refused.

Usage: cycles_test.py FOLDER_OF_PROGRAMS"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
from one_hole import PROGRAMS, end_if_missed, near  # noqa: E402


def springs(n, *ends):
    """Stiffness of n nodes joined by springs (node, node or None for the ground, stiffness)."""
    S = np.zeros((n, n))
    for i, k, stiffness in ends:
        at = np.zeros(n)
        at[i] += 1
        if k is not None:
            at[k] -= 1
        S += stiffness * np.outer(at, at)
    return S


def matrices(path, S, holes, external=(), directions="x"):
    """A hand-made MATRICES.h5: S by discs, hole after hole, then externals."""
    m = len(holes) * len(directions)
    with h5py.File(path, "w") as f:
        f.attrs["format"], f.attrs["version"] = "plate-matrices", np.array([1, 0], dtype="i4")
        f["p"] = np.array([1], dtype="i4")
        f["disc/hole"] = [hole for hole in holes for _ in directions]
        f["disc/direction"] = [d for _ in holes for d in directions]
        f["S_dd"] = S[None, :m, :m]
        if external:
            f["external/id"], f["external/direction"] = [name for name, _ in external], [d for _, d in external]
            f["S_ee"], f["S_ed"] = S[None, m:, m:], S[None, m:, :m]


def run(folder, joint, *words, status=0):
    (folder / "joint.json").write_text(json.dumps({"format": "joint", "version": 1} | joint))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "out.h5", *words], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == status, (done.stdout[-2000:], done.stderr)
    return done


def read(folder, *names):
    with h5py.File(folder / "out.h5") as f:
        return [f[name].asstr()[:] if name == "event" else f[name][:] for name in names]


def a_slipped_joint(folder):
    """A four-stage fastener that has slipped and is unloaded keeps its slip, and its events are told once each."""
    matrices(folder / "a.h5", springs(2, (0, 1, 1e7)), ["1"], [("P", "x")])
    law = {"type": "four stage", "k_stick": 2e4, "F_slip": 400, "slip": 0.05, "k_bearing": 2e4, "F_yield": 1500, "k_yield": 1e3}
    joint = {"plates": {"a": "a.h5"}, "laws": {"bolt": law}, "loads": [{"external": "a:P", "force": 100}], "increments": [3, 5, 4, 0, -3],
             "fasteners": [{"id": "1", "between": ["a:1", "ground"], "law": "bolt"}]}
    done = run(folder, joint)
    assert "permanent-set" not in done.stderr and "keeps a set of 0 mm" not in done.stdout
    delta, event, dissipated, F = read(folder, "delta", "event", "memory/dissipated", "F")
    stuck, slipped = 400 / 2e4, 400 / 2e4 + 0.05
    loaded = slipped + 100 / 2e4
    # Unloading turns the friction too: the bearing and the spring of the friction act side by side, until the rim opens.
    near("displacement under 300", delta[0, 0], 0.015, 1e-9)
    near("displacement under 500", delta[1, 0], loaded, 1e-9)
    near("displacement after 500", delta[2, 0], loaded - 100 / 4e4, 1e-9)
    # At no load friction, -2 k_stick x, and bearing, which has opened after 100 / k_bearing, are in balance.
    near("set at no load", delta[3, 0], loaded - 400 / 2e4, 1e-9)
    near("set under -300", delta[4, 0], loaded - 700 / 2e4, 1e-9)
    assert list(event) == ["", "1 slips", "1 sticks again", "", ""], event
    near("work of friction", dissipated[-1, 0], 400 * (loaded - stuck), 1e-9)
    assert np.allclose(F[:, 0], [300, 500, 400, 0, -300], atol=1e-9)
    run(folder, joint | {"laws": {"bolt": law | {"reversible": True}}})
    assert np.abs(read(folder, "delta")[0][3, 0]) < 1e-12, "a reversible law keeps nothing"
    with h5py.File(folder / "out.h5") as f:
        assert "memory" not in f
    done = run(folder, joint, "--sensitivities", status=2)
    assert "has unloaded or turned after it slipped or yielded" in done.stderr and "load factor 4" in done.stderr, done.stderr
    run(folder, joint | {"increments": [3, 5]}, "--sensitivities")
    for number in ("k_yield", "k_bearing"):
        wrong = {"k_yield": 3e4} if number == "k_yield" else {"k_bearing": 10}
        done = run(folder, joint | {"laws": {"bolt": law | wrong}}, status=2)
        assert '/laws/bolt/k_yield' in done.stderr and '"reversible": true' in done.stderr, done.stderr


def turns_and_studies(folder):
    """A load that turns at once names the yield the other way; a study's samples are runs, with what they remember; events after a case are refused;
    temperature acts before the loads do."""
    matrices(folder / "a.h5", springs(3, (0, 1, 3e4), (1, 2, 5e4)), ["1", "2"], [("P", "x")])
    matrices(folder / "b.h5", springs(2, (0, 1, 2e4), (0, None, 4e4)), ["1", "2"])
    law = {"type": "bilinear", "k": 2e4, "F_yield": 60, "k_yield": 1e3}
    base = {"plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"bolt": law}, "fasteners": [{"id": i, "between": [f"a:{i}", f"b:{i}"], "law": "bolt"} for i in "12"]}
    loads = [{"external": "a:P", "force": 200}]
    run(folder, base | {"loads": loads, "increments": [1, -1, 1]})
    event, F = read(folder, "event", "F")
    assert all("yield" in each and "elastic" not in each for each in event), event
    cases = [{"name": "up", "loads": loads}, {"name": "down", "loads": [{"external": "a:P", "force": -200}], "after": "up"}]
    studied = {"format": "study", "version": 1, "sampling": "random", "seed": 1, "samples": 6,
               "variables": [{"at": "/laws/bolt/F_yield", "distribution": {"type": "uniform", "from": 50, "to": 90}}]}
    for joint, more in ((base | {"loads": loads, "increments": [1, 0, 0.5]}, {}), (base | {"cases": cases}, {"cases": ["down"]})):
        (folder / "study.json").write_text(json.dumps(studied | more))
        (folder / "joint.json").write_text(json.dumps({"format": "joint", "version": 1} | joint))
        words = [PROGRAMS / "stage3_nonlinear", "joint.json", "--study", "study.json"]
        subprocess.run([*words, "-o", "study.h5", "--quiet"], cwd=folder, check=True)
        with h5py.File(folder / "study.h5") as f:
            samples = f["samples/force"][:]
        for k in (0, 5):
            subprocess.run([*words, "--sample", str(k), "-o", "one.json", "--quiet"], cwd=folder, check=True)
            subprocess.run([PROGRAMS / "stage3_nonlinear", "one.json", "-o", "one.h5", "--quiet"], cwd=folder, check=True)
            with h5py.File(folder / "one.h5") as f:
                found = np.abs(f["transferred"][-1, :, 0])
            assert np.abs(samples[k] - found).max() < 1e-7 * 200 and found.max() > 1, (k, samples[k], found)
    done = run(folder, base | {"cases": [cases[0], cases[1] | {"increments": "events"}]}, status=2)
    assert '/cases/1/increments' in done.stderr and '"events" after "up"' in done.stderr, done.stderr
    # However far the load is beyond what the joint holds, the yields before the last are found.
    for load in (121, 160, 500, 3000, 1e5):
        done = run(folder, base | {"laws": {"bolt": law | {"k_yield": 0}}, "loads": [{"external": "a:P", "force": load}], "increments": "events"}, status=4)
        event, factor = read(folder, "event", "load_factor")
        assert "limit load reached" in done.stderr and event[0] in ("1 yields", "2 yields") and 90 < factor[0] * load < 119.9, (load, event, factor * load)
    for name in "ab":
        with h5py.File(folder / f"{name}.h5", "r+") as f:
            f["disc/center"] = np.array([[0.0, 0], [100, 0]])
            f["external/range"], f["traction/range"] = np.full((len(f.get("external/id", [])), 2), 150.0), np.zeros((0, 2))
            f["support/range"] = f["support/middle"] = np.zeros((2, 2))
            f["expansion"] = np.array([1e-4, 1e-4, 0]) if name == "a" else np.zeros(3)
    warm = {"temperatures": {"a": 100}}
    seen = []
    for made in ({"loads": loads, "increments": 1}, {"loads": loads, "increments": [0, 1]}, {"loads": loads, "increments": 50},
                 {"cases": [{"name": "T", "loads": []} | warm, {"name": "P", "loads": loads, "after": "T"}]}):
        run(folder, base | made | ({} if "cases" in made else warm))
        seen.append(read(folder, "F")[0][-1])
    assert np.abs(np.diff(seen, axis=0)).max() < 1e-9 * 200 and np.abs(seen[0]).max() > 61, seen


def two_bars(folder):
    """Two plastic fasteners under a constant force P and a cyclic difference q of their displacements: they shake down where q is small, and
    ratchet by the same step in each cycle where it is large (J. Bree's problem with two bars)."""
    k, F = 1000.0, 100.0  # of each fastener
    stiff = 1e9
    S = springs(4, (0, 2, stiff))
    at = np.array([-1, 1, 0, -1])  # disc 2 - disc 1 - q
    S += stiff * np.outer(at, at)
    matrices(folder / "bars.h5", S, ["1", "2"], [("P", "x"), ("q", "x")])
    law = {"type": "bilinear", "k": k, "F_yield": F, "k_yield": 0}
    fasteners = [{"id": i, "between": [f"bars:{i}", "ground"], "law": "l"} for i in "12"]
    n = 12

    def cycle(P, q):
        """Displacement of the first fastener and dissipated energy after the load and after each half cycle of q."""
        held = lambda value: {"external": "bars:q", "displacement": value}
        cases = [{"name": "load", "loads": [{"external": "bars:P", "force": P}, held(0)]}]
        for i in range(2 * n):
            cases.append({"name": f"{i}", "loads": [held(q if i % 2 == 0 else -q)], "after": cases[-1]["name"]})
        run(folder, {"plates": {"bars": "bars.h5"}, "laws": {"l": law}, "fasteners": fasteners, "cases": cases})
        delta, dissipated = read(folder, "delta", "memory/dissipated")
        return delta[:, 0], dissipated.sum(axis=1)

    # With F1 + F2 = P < 2 F and q across both: elastic as long as P / 2 + k q / 2 < F; beyond, one yields at q and, where
    # k q > 2 (2 F - P), the other at 0.
    P = 120.0
    delta, dissipated = cycle(P, 1.5 * (2 * F - P) / k)
    assert dissipated[2] > 0 and np.ptp(dissipated[4:]) < 1e-9 * dissipated[2], ("shakes down", dissipated)
    assert np.ptp(delta[3::2]) < 1e-9, delta
    q = 3 * (2 * F - P) / k
    delta, dissipated = cycle(P, q)
    steps = np.diff(delta[2::2])
    near("step of ratcheting", steps[-1], q - 2 * (2 * F - P) / k, 1e-5)
    assert np.ptp(steps[1:]) < 1e-6 * steps[-1], steps
    near("energy of a cycle, in which each yields by the step once", dissipated[-1] - dissipated[-3], 2 * F * steps[-1], 1e-5)


def random_law(random, F, d):
    k = F / d * random.uniform(0.5, 2)
    kind = random.integers(4)
    if kind == 0:
        return {"type": "bilinear", "k": k, "F_yield": F * random.uniform(0.2, 0.8), "k_yield": k * random.choice([0, 0.05, 0.3])}
    if kind == 1:
        slips = F * random.uniform(0.05, 0.3)
        return {"type": "four stage", "k_stick": 4 * k, "F_slip": slips, "slip": d * random.uniform(0, 0.3), "k_bearing": k,
                "F_yield": slips + F * random.uniform(0.2, 0.6), "k_yield": k * 0.1}
    if kind == 2:
        return {"type": "table", "delta": [d * x for x in (0.3, 0.7, 1.2, 2.5, 6)], "F": [F * y for y in (0.4, 0.8, 1.0, 1.2, 1.5)], "F_yield": 0.5 * F}
    return {"type": "linear", "k": k}


def random_joint(folder, seed):
    """Two sheets with up to six fasteners along x, or x and y, hand-made, under a random cycle."""
    random = np.random.default_rng(seed)
    directions = "x" if seed % 2 else "xy"
    a, n = len(directions), int(random.integers(2, 7))
    F, d = 1000.0, 0.05
    stiffness = F / d
    for name, ends in (("a", a), ("b", 0)):
        m = n * a + ends
        S = np.zeros((m, m))
        for _ in range(4 * m):  # springs between any two, or to the ground of the second sheet
            at = np.zeros(m)
            i, j = random.integers(m, size=2)
            if i == j:
                continue
            at[i], at[j] = 1, -1
            S += stiffness * random.uniform(0.3, 3) * np.outer(at, at)
        if name == "b":
            S += stiffness * np.diag(random.uniform(0.1, 1, m))
        matrices(folder / f"{name}.h5", S, [str(i) for i in range(n)], [(f"P{axis}", axis) for axis in directions[:ends]], directions)
    laws = {str(i): random_law(random, F, d) for i in range(n)}
    loads = [{"external": f"a:P{axis}", "force": float(0.3 * n * F * random.uniform(0.3, 1))} for axis in directions]
    factors = [float(each) for each in random.uniform(-1, 1, 6)]
    fasteners = [{"id": str(i), "between": [f"a:{i}", f"b:{i}"], "law": str(i), "clearance": float(d * random.choice([0, 0.2]))} for i in range(n)]
    return {"plates": {"a": "a.h5", "b": "b.h5"}, "laws": laws, "fasteners": fasteners, "loads": loads, "increments": factors}


def random_joints(folder):
    """Solved in balance, to the same state by each solver, with energy that only falls; along one direction the increments between reversals
    change nothing."""
    n_remember, falls = 0, []
    for seed in range(20):
        joint = random_joint(folder, seed)
        states = []
        for method in ("hybridsj", "damped newton"):
            run(folder, joint | {"solver": {"method": method, "tolerance": 1e-12}})
            states.append(read(folder, "F_vector", "residual"))
            with h5py.File(folder / "out.h5") as f:
                if "memory" not in f:
                    continue
                dissipated = f["memory/dissipated"][:]
                n_remember += dissipated[-1].max() > 0
                assert (np.diff(dissipated, axis=0) >= 0).all() and (dissipated >= 0).all(), (seed, dissipated)
        (one, _), (other, _) = states
        assert np.abs(one - other).max() < 1e-6 * np.abs(one).max(), (seed, np.abs(one - other).max())
        factors = joint["increments"]
        between = lambda parts: [float(a + (b - a) * i / parts) for a, b in zip([0, *factors], factors) for i in range(1, parts + 1)]
        turned = []
        for parts in (1, 4, 8, 16):
            run(folder, joint | {"increments": between(parts), "solver": {"tolerance": 1e-12}})
            turned.append(read(folder, "F_vector")[0][parts - 1::parts])
        off = [np.abs(each - turned[-1]).max() / np.abs(one).max() for each in turned[:-1]]
        print(f"joint {seed}: increments cut in 1, 4, 8 of 16 change forces by", *(f"{each:.1e}" for each in off))
        if seed % 2:
            assert max(off) < 1e-10, (seed, off)
        elif off[1] > 1e-8:
            falls.append(np.log2(off[1] / off[2]))
    # Of errors in proportion to the increment those of 4 and 8 parts, less that of 16, are as 3 to 1.
    print(f"along x and y the change by increments falls by 2 to the power of {np.mean(falls):.2f}, log2(3) = 1.58 if of order 1, in {len(falls)} joints")
    assert n_remember > 25 and len(falls) > 5 and 1.2 < np.mean(falls) < 2.2, (n_remember, falls)


def main():
    with tempfile.TemporaryDirectory() as name:
        for each in (a_slipped_joint, turns_and_studies, two_bars, random_joints):
            each(Path(name))
    end_if_missed()


if __name__ == "__main__":
    main()
