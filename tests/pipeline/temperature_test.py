#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets and fasteners that expand, and holes that are off their place: hand-made joints, strips, free sheets, and what is refused.

Usage: temperature_test.py FOLDER_OF_PROGRAMS"""
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
from one_hole import PROGRAMS, end_if_missed, matrices, near  # noqa: E402

L, EA, K, ALPHA, DT = 100.0, (7.2e6, 6e6), 40000.0, (23e-6, 2e-6), 70.0
FORCE = (ALPHA[0] - ALPHA[1]) * DT * L / (L / EA[0] + L / EA[1] + 2 / K)  # of two sheets between two fasteners


def run(folder, joint, *words, status=0):
    (folder / "joint.json").write_text(json.dumps({"format": "joint", "version": 1} | joint))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", "out.h5", *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == status, (done.stdout, done.stderr)
    return done


def bar(path, stiffness, alpha, held=False):
    """A bar between two discs at x = 20 and 120, free to move or held by a spring at x = 20."""
    with h5py.File(path, "w") as f:
        f.attrs["format"], f.attrs["version"] = "plate-matrices", np.array([1, 11], dtype="i4")
        f["p"] = np.array([1], dtype="i4")
        f["disc/hole"], f["disc/direction"] = ["1", "2"], ["x", "x"]
        f["S_dd"] = stiffness * np.array([[[1.0, -1], [-1, 1]]]) + held * np.array([[[1e5, 0], [0, 0]]])
        f["disc/center"] = np.array([[20.0, 0], [20 + L, 0]])
        f["external/range"], f["traction/range"] = np.zeros((0, 2)), np.zeros((0, 2))
        f["support/range"] = f["support/middle"] = held * np.array([[20.0, 20], [0, 0]])
        if alpha is not None:
            f["expansion"] = np.array([alpha, alpha, 0])


def two_bars(folder, **more):
    fasteners = [{"id": i, "between": [f"a:{i}", f"b:{i}"], "law": "k", **more.pop(f"of_{i}", {})} for i in "12"]
    return {"plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"k": {"type": "linear", "k": K}}, "fasteners": fasteners,
            "temperatures": {"a": DT, "b": DT}, "cases": None, "loads": []} | more


def by_hand(folder):
    """Two bars of unlike expansion between two fasteners, in closed form; the same by holes off their place; free and equal expansion."""
    for name, each, alpha in zip("ab", EA, ALPHA):
        bar(folder / f"{name}.h5", each / L, alpha, name == "b")
    of = lambda name: h5py.File(folder / "out.h5")[name][-1]
    def joint(**more):
        made = two_bars(folder, **more)
        made.pop("cases")
        temperatures = made.pop("temperatures")
        made.pop("loads")
        return made | {"cases": [{"name": "warm", "loads": [], "temperatures": temperatures}]}
    run(folder, joint())
    near("closed form", FORCE, 1824.83, 5e-6)
    near("force", of("F")[1], FORCE, 1e-10)
    near("opposite force", of("F")[0], -FORCE, 1e-10)
    # The shortened bar lies about its middle, as the free one does; displacements are those of the drawing.
    D = of("plates/a/D")
    near("length of the bar", D[1] - D[0], ALPHA[0] * DT * L - FORCE * L / EA[0], 1e-9)
    gaps = {"of_1": {"clearance": 0.03}, "of_2": {"clearance": 0.03}}
    run(folder, joint(**gaps))
    near("with gaps", of("F")[1], 1080.0, 1e-10)
    run(folder, joint(temperatures={"a": DT, "b": DT * ALPHA[0] / ALPHA[1]}))
    assert np.abs(of("F")).max() < 1e-9 * FORCE, "equal expansion"
    run(folder, joint(temperatures={}, of_2={"offset": {"a": [(ALPHA[0] - ALPHA[1]) * DT * L, 0]}}))
    near("a hole that is off by as much", of("F")[1], FORCE, 1e-10)
    run(folder, joint(temperatures={}, of_2={"offset": {"b": [-(ALPHA[0] - ALPHA[1]) * DT * L, 0]}}))
    near("in the other sheet the other way", of("F")[1], FORCE, 1e-10)
    # Cases: warm, and warmer after it; back to no change nothing is left.
    cases = [{"name": "warm", "loads": [], "temperatures": {"a": DT, "b": DT}}, {"name": "warmer", "loads": [], "temperatures": {"a": 2 * DT, "b": 2 * DT}, "after": "warm"},
             {"name": "stays", "loads": [], "after": "warmer"}, {"name": "cold again", "loads": [], "temperatures": {"a": 0, "b": 0}, "after": "warmer"}]
    run(folder, joint() | {"cases": cases})
    with h5py.File(folder / "out.h5") as f:
        assert np.allclose(f["F"][:, 1], FORCE * np.array([1, 2, 2, 0]), rtol=1e-10, atol=1e-8), f["F"][:]
    # A cycle of temperature on fasteners that yield leaves what they have yielded.
    plastic = {"type": "bilinear", "k": K, "F_yield": 1000, "k_yield": 0}
    run(folder, joint() | {"laws": {"k": plastic}, "cases": [cases[0], {"name": "cold", "loads": [], "temperatures": {"a": 0, "b": 0}, "after": "warm"}]})
    with h5py.File(folder / "out.h5") as f:
        near("yielded", f["F"][0, 1], 1000, 1e-9)
        near("left", f["F"][1, 1], 1000 - FORCE, 1e-9)


def strips(folder):
    """Strips with holes and elastic pins: 1 % of the bars, since stress spreads from the pins; a free sheet and equal sheets carry nothing."""
    E, T, W = (72e3, 60e3), 2.0, 50.0
    spring = {"disk": {"E": 1e9, "nu": 0.3}}
    for i, name in enumerate("ab"):
        scene = {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"}, "analysis": "plane stress", "p": [6, 7],
                 "materials": {"m": {"E": E[i], "nu": 0.3, "alpha": ALPHA[i]}},
                 "geometry": {"grid": {"x": [0, 40, 70, 100, 140], "y": [-W / 2, W / 2], "thickness": T}},
                 "holes": [{"id": "1", "center": [20, 0], "radius": 2.5, "spring": spring}, {"id": "2", "center": [120, 0], "radius": 2.5, "spring": spring}],
                 "disc_directions": ["x", "y"]} | ({"supports": [{"on": "left", "fix": ["x", "y"]}]} if name == "b" else {})
        matrices(folder, scene, name)
    joint = {"plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"k": {"type": "linear", "k": K}},
             "fasteners": [{"id": i, "between": [f"a:{i}", f"b:{i}"], "law": "k"} for i in "12"]}
    warm = [{"name": "warm", "loads": [], "temperatures": {"a": DT, "b": DT}}]
    run(folder, joint | {"cases": warm})
    with h5py.File(folder / "out.h5") as f, h5py.File(folder / "a.h5") as a, h5py.File(folder / "b.h5") as b:
        F = f["F_vector"][-1]
        # The flexibility of a strip between its discs: apart and loaded by opposite forces, of its own matrices.
        apart = np.array([-1, 0, 1, 0])
        stretch = [apart @ np.linalg.pinv(sheet["S_dd"][-1], rcond=1e-10, hermitian=True) @ apart for sheet in (a, b)]
        near("force of strips, by the flexibility of their discs", F[1, 0], (ALPHA[0] - ALPHA[1]) * DT * L / (sum(stretch) + 2 / K), 1e-9)
        bars = (ALPHA[0] - ALPHA[1]) * DT * L / (L / (E[0] * T * W) + L / (E[1] * T * W) + 2 / K)
        print(f"strips {F[1, 0]:.2f} N, bars {bars:.2f} N: holes and the spread of stress add {1e6 * (sum(stretch) - L / (E[0] * T * W) - L / (E[1] * T * W)):.1f} nm/N to {2e6 / K:.1f} of the fasteners")
        peak = f["plates/a/rim/peak_hoop"][-1]
        assert peak.min() > 10, peak
        free = f["plates/a/free/D"][-1]
        assert np.allclose(free[2] - free[0], ALPHA[0] * DT * L) and np.allclose(free[[1, 3]], 0)
    run(folder, joint | {"cases": [warm[0] | {"temperatures": {"a": DT, "b": DT * ALPHA[0] / ALPHA[1]}}]})
    with h5py.File(folder / "out.h5") as f:
        assert np.abs(f["F"][-1]).max() < 1e-8 * bars and max(np.abs(f[f"plates/{name}/rim/peak_hoop"][-1]).max() for name in "ab") < 1e-6


def edges(folder):
    """An edge under traction moves as far as one that moves as one, expansion included."""
    seen = []
    for kind in ("rigid", "traction"):
        scene = {"format": "plate", "version": 1, "analysis": "plane stress", "p": [4, 5], "materials": {"m": {"E": 7e4, "nu": 0.3, "alpha": 2e-5}},
                 "geometry": {"grid": {"x": [0, 20, 80], "y": [-10, 10], "thickness": 2}}, "disc_directions": ["x", "y"], "supports": [{"on": "left", "fix": ["x", "y"]}],
                 "holes": [{"id": "1", "center": [10, 0], "radius": 2, "spring": {"modulus": 1e5}}], "external": [{"id": "P", "on": "right", "direction": "x", "kind": kind}]}
        matrices(folder, scene, "e")
        joint = {"plates": {"e": "e.h5"}, "laws": {"k": {"type": "linear", "k": 1e-3}}, "fasteners": [{"id": "1", "between": ["e:1", "ground"], "law": "k"}],
                 "loads": [{"external": "e:P", "force": 1000}], "temperatures": {"e": 50}}
        run(folder, joint)
        with h5py.File(folder / "out.h5") as f:
            seen.append(f["plates/e/De" if kind == "rigid" else "plates/e/traction/displacement"][-1, 0])
    assert abs(seen[1] / seen[0] - 1) < 1e-3 and seen[0] > 2e-5 * 50 * 80, seen


def contact(folder):
    """A shank that expands more than its sheets fills its hole: an interference as the same gap given; orthotropic sheets at an angle."""
    spring = {"compression_only": True, "harmonics": 16, "disk": {"E": 2e5, "nu": 0.3}}
    for name in "ab":
        scene = {"format": "plate", "version": 1, "analysis": "plane stress", "p": [4, 5], "materials": {"m": {"E": 7e4, "nu": 0.3, "alpha": 1e-6}},
                 "geometry": {"grid": {"x": [-20, 20], "y": [-20, 20], "thickness": 2}}, "disc_directions": ["x", "y"],
                 "holes": [{"id": "1", "center": [0, 0], "radius": 3, "spring": spring}],
                 **({"supports": [{"on": "left", "fix": ["x", "y"]}]} if name == "a" else {"external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]})}
        matrices(folder, scene, name)
    joint = {"plates": {"a": "a.h5", "b": "b.h5"}, "laws": {"k": {"type": "linear", "k": 5e4}}, "loads": [{"external": "b:P", "force": 500}]}
    bolt = {"id": "1", "between": ["a:1", "b:1"], "law": "k"}
    seen = []
    for more, gap, alpha in (({"temperatures": {"a": 100, "b": 100}}, 0, {"expansion": 2e-5}), ({}, -3 * 100 * (2e-5 - 1e-6), {}),
                             ({"temperatures": {"a": 100, "b": 100}, "fastener_temperature": 0}, 0, {"expansion": 2e-5}), ({}, 3 * 100 * 1e-6, {})):
        run(folder, joint | more | {"fasteners": [bolt | {"gap": gap} | alpha]})
        with h5py.File(folder / "out.h5") as f:
            seen.append((f["plates/a/contact/peak_pressure"][-1, 0], f["plates/a/rim/peak_hoop"][-1, 0], f["plates/a/contact/gap"][0]))
    assert np.allclose(seen[0], seen[1], rtol=1e-8) and np.allclose(seen[2], seen[3], rtol=1e-8) and seen[0][0] > 1.5 * seen[2][0], seen
    # Expansion along the fibres at 30 degrees to x: the disc moves along them, and a free sheet carries nothing.
    laminate = {"E1": 1.4e5, "E2": 1e4, "nu12": 0.3, "G12": 5e3, "angle": 30, "alpha1": -1e-6, "alpha2": 3e-5}
    scene = {"format": "plate", "version": 1, "analysis": "plane stress", "p": [3, 4], "materials": {"m": laminate},
             "geometry": {"grid": {"x": [0, 20, 40], "y": [-10, 10], "thickness": 2}}, "disc_directions": ["x", "y"],
             "holes": [{"id": i, "center": [x, 0], "radius": 3, "spring": spring} for i, x in (("1", 10), ("2", 30))]}
    matrices(folder, scene, "c")
    turn = np.array([[np.cos(np.pi / 6), -np.sin(np.pi / 6)], [np.sin(np.pi / 6), np.cos(np.pi / 6)]])
    strain = turn @ np.diag([-1e-6, 3e-5]) @ turn.T
    with h5py.File(folder / "c.h5") as f:
        assert np.allclose(f["expansion"][:], [strain[0, 0], strain[1, 1], strain[0, 1]], rtol=1e-12)
    for i in "12":
        bolts = [{"id": i, "between": [f"c:{i}", "ground"], "law": "k"} for i in "12"]
    run(folder, {"plates": {"c": "c.h5"}, "laws": joint["laws"], "fasteners": bolts, "cases": [{"name": "hot", "loads": [], "temperatures": {"c": 50}}]})
    with h5py.File(folder / "out.h5") as f:
        free, F = f["plates/c/free/D"][-1].reshape(2, 2), f["F_vector"][-1].reshape(2, 2)
        assert np.allclose(free[1] - free[0], 50 * strain @ [20, 0], rtol=1e-12) and np.abs(F.sum(axis=0)).max() < 1e-9 * np.abs(F).max() and F[1, 0] > 0


def refusals(folder):
    """What cannot be known is said."""
    bar(folder / "a.h5", 1e5, None)
    bar(folder / "b.h5", 1e5, 1e-5)
    base = two_bars(folder)
    for key in ("temperatures", "cases", "loads"):
        base.pop(key)
    warm = lambda **temperatures: {"cases": [{"name": "x", "loads": [], "temperatures": temperatures}]}
    first, second = base["fasteners"]
    for change, message in ((warm(a=10), "/cases/0/temperatures/a: the expansion of"), (warm(c=10), "/cases/0/temperatures/c: no plate has this name; allowed: a, b"),
                            (warm(a="hot"), "/cases/0/temperatures/a"), (warm() | {"temperatures": {"a": 1}}, "/temperatures: given together with"),
                            (warm() | {"fasteners": [first | {"offset": {"c": [0, 0]}}, second]}, "/fasteners/0/offset/c: not a plate of this fastener"),
                            (warm() | {"fasteners": [first | {"offset": {"a": [0, 1]}}, second]}, "do not move"),
                            (warm() | {"fasteners": [first | {"offset": {"a": 1}}, second]}, "/fasteners/0/offset/a")):
        done = run(folder, base | change, status=2)
        assert message in done.stderr, (message, done.stderr)
    with h5py.File(folder / "b.h5", "r+") as f:
        f["support/middle"][0] = [0, 140]
    done = run(folder, base | warm(b=1), status=2)
    assert "between which it cannot expand" in done.stderr, done.stderr
    scene = {"format": "plate", "version": 1, "analysis": "plane strain", "p": [1, 2], "materials": {"m": {"E": 7e4, "nu": 0.3, "alpha": 1e-6}},
             "geometry": {"grid": {"x": [0, 1], "y": [0, 1], "thickness": 2}}}
    (folder / "s.json").write_text(json.dumps(scene))
    done = subprocess.run([PROGRAMS / "stage1_plate", "s.json", "-o", "s.h5"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 2 and "/materials/m/alpha: given in plane strain" in done.stderr, done.stderr


def main():
    with tempfile.TemporaryDirectory() as name:
        for each in (by_hand, strips, edges, contact, refusals):
            each(Path(name))
    end_if_missed()


if __name__ == "__main__":
    main()
