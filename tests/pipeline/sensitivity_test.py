# SPDX-License-Identifier: GPL-3.0-or-later
"""--sensitivities against runs of a changed JOINT.json: sensitivity_test.py BIN_FOLDER [sweep].
With the last word peaks of both kinds of springs in both numbers of directions."""
import copy
import json
import os
import shutil
import subprocess
import sys
import tempfile
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import h5py
import numpy as np

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
SWEEP = "sweep" in sys.argv[2:]
STEP = 1e-4  # of each number: truncation about its square, rounding 1e-12 / STEP


def run(*words):
    told = subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stderr
    assert "illegal value" not in told, f"a library complains: {told}"


def solve(scene):
    """F at every increment, and the peaks of all holes at the last."""
    Path("changed.json").write_text(json.dumps(scene))
    run("stage3_nonlinear", "changed.json", "-o", "changed.h5")
    with h5py.File("changed.h5") as f:
        assert "sensitivity" not in f, "only if asked for"
        return f["F"][:], peaks(f)


def peaks(file):
    """Largest hoop stress of each "plate:hole" at the last increment."""
    return {f"{name}:{hole}": peak for name, plate in file["plates"].items()
            for hole, peak in zip(plate["rim/hole"].asstr(), plate["rim/peak_hoop"][-1])}


def difference(scene, change, step):
    """Central differences of F, and of the peaks in the order of their names, by a number that change(scene, h) adds h to."""
    found = []
    for h in (step, -step):
        changed = copy.deepcopy(scene)
        change(changed, h)
        F, peak = solve(changed)
        found.append((F, np.array([peak[name] for name in sorted(peak)])))
    return tuple((plus - minus) / (2 * step) for plus, minus in zip(*found))


def expect(by, scene, change, value):
    by_difference, _ = difference(scene, change, STEP * value)
    assert np.abs(by - by_difference).max() < 1e-6 * np.abs(by_difference).max(), (by, by_difference)


def sensitivities(scene):
    Path("joint.json").write_text(json.dumps(scene))
    run("stage3_nonlinear", "joint.json", "-o", "joint.h5", "--sensitivities")
    with h5py.File("joint.h5") as f:
        group = f["sensitivity"]
        found = {}
        group.visititems(lambda name, item: found.update({name: item.asstr()[:] if h5py.check_string_dtype(item.dtype) else item[:]})
                         if isinstance(item, h5py.Dataset) else None)
        return found | {"peaks": peaks(f)}


def check_lap_joint():
    """Power law, clearance, friction."""
    for path in (ROOT / "tests/pipeline/scenes/lap_joint").glob("*.json"):
        shutil.copy(path, ".")
    for sheet in ("upper", "lower"):
        run("stage1_plate", f"{sheet}.json", "-o", f"{sheet}.h5", "--p", 4)
        run("stage2_extract", f"{sheet}.h5", "-o", f"{sheet}.matrices.h5", "--loads-only")
    scene = json.loads(Path("joint.json").read_text())
    scene["solver"] = {"tolerance": 1e-13}
    for fastener in scene["fasteners"]:
        fastener["friction"] = {"upper": 0.15, "lower": 0.15}
    by = sensitivities(scene)
    factors = np.arange(1, 5) / 4

    def add_clearance(changed, h):
        changed["fasteners"][1]["clearance"] += h

    expect(by["clearance"][:, :, 1], scene, add_clearance, 0.02)
    assert list(zip(by["law_name"], by["law_number"], by["law_unit"])) == [
        ("rivet", "A", "mm^0.8"), ("rivet", "n", "N"), ("rivet", "delta0", "N/mm")]
    for i, (number, value) in enumerate((("A", 9000), ("n", 0.8))):
        def add_number(changed, h):
            changed["laws"]["rivet"][number] += h

        expect(by["law"][:, :, i], scene, add_number, value)
    assert sorted(by["mu_hole"]) == sorted(f"{sheet}:{hole}" for sheet in ("upper", "lower") for hole in "abcd")
    for i, name in enumerate(by["mu_hole"]):
        sheet, hole = name.split(":")

        def add_friction(changed, h):
            changed["fasteners"]["abcd".index(hole)]["friction"][sheet] += h

        expect(by["mu"][:, :, i], scene, add_friction, 0.15)

    def add_force(changed, h):
        changed["loads"][0]["force"] += h

    assert list(by["force_external"]) == ["upper:P"]
    expect(by["force"][:, :, 0], scene, add_force, 4000)
    assert by["displacement"].shape == (4, 4, 0)
    assert np.allclose(by["load_factor"] * factors[:, None], by["force"][:, :, 0] * 4000, rtol=1e-9)
    scene["fasteners"][0]["friction"] = 0.1
    scene["fasteners"][2]["friction"] = {"upper": 0.2}
    check_bars(scene, {"load", "clearances", "friction", "rivet: A", "rivet: n"})


def load_draw_loads():
    loader = SourceFileLoader("draw_loads", str(ROOT / "scripts/draw/draw_loads"))
    module = module_from_spec(spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def times(number, by):
    if isinstance(number, list):
        return [times(each, by) for each in number]
    return {plate: mu * by for plate, mu in number.items()} if isinstance(number, dict) else number * by


def scale(changed, name, by):
    """Multiplies what a bar of scripts/draw/draw_loads names."""
    if name == "load":
        changed["loads"][0]["force"] *= by
    elif name in ("clearances", "friction"):
        for fastener in changed["fasteners"]:
            key = name.removesuffix("s")
            fastener[key] = times(fastener.get(key, 0), by)
    else:
        law, number = name.split(": ")
        key, _, index = number.removesuffix("]").partition("[")
        if index:
            changed["laws"][law][key][int(index)] *= by
        else:
            changed["laws"][law][key] *= by


def check_bars(scene, names):
    """1 % more of a number, here a hundredth of that, changes F as much as runs of a changed input say."""
    draw_loads = load_draw_loads()
    sensitivities(scene)
    result = draw_loads.Result("joint.h5")
    for plane in range(result.F.shape[1]):
        bars = dict(draw_loads.changes(result, plane))
        assert set(bars) == names, bars
        for name, bar in bars.items():
            slope = difference(scene, lambda changed, h: scale(changed, name, 1 + h), STEP)[0][-1, plane] / result.F[-1, plane]
            assert abs(bar - slope) < 1e-6 * max(map(abs, bars.values())), (plane, name, bar, slope)
    return result


def check_bars_of_a_stack():
    """Two shear planes of one fastener with laws and clearances of their own."""
    for name, left, right in (("a", "free", "external:P=600"), ("b", "ground=100", "free"), ("c", "ground=300", "free")):
        run(ROOT / "scripts/chain_matrices", "-o", f"{name}.h5", "--segments", 500, "--left", left, "--right", right)
    scene = {"format": "joint", "version": 1, "plates": {plate: f"{plate}.h5" for plate in "abc"},
             "laws": {"curved": {"type": "power", "A": 300, "n": 0.7},
                      "cubic": {"type": "cubic", "delta": [0.5, 1, 2], "F": [90, 160, 250]}},
             "fasteners": [{"id": "first one", "between": ["b:1", "a:1", "c:1"], "law": ["curved", "cubic"],
                            "clearance": [0.01, 0.03]},
                           {"id": "2", "between": ["b:2", "a:2"], "law": "curved", "clearance": 0.02}],
             "loads": [{"external": "a:P", "force": 200}], "solver": {"tolerance": 1e-13}}
    result = check_bars(scene, {"load", "clearances", "curved: A", "curved: n", "cubic: F[0]", "cubic: F[1]", "cubic: F[2]"})
    assert result.names == ["first one b:1-a:1", "first one a:1-c:1", "2"], result.names


def check_linear_chains():
    """The linear path too, under given displacements; without labels of units."""
    for name, left, right in (("a", "external:Q=300", "external:P=600"), ("b", "ground=100", "free")):
        run(ROOT / "scripts/chain_matrices", "-o", f"{name}.h5", "--segments", 500, "--left", left, "--right", right)
    scene = {"format": "joint", "version": 1, "plates": {"a": "a.h5", "b": "b.h5"},
             "laws": {"soft": {"type": "linear", "k": 100}, "hard": {"type": "linear", "k": 700}},
             "fasteners": [{"id": "1", "between": ["a:1", "b:1"], "law": "soft"},
                           {"id": "2", "between": ["a:2", "b:2"], "law": "hard"}],
             "loads": [{"external": "a:P", "displacement": 1}, {"external": "a:Q", "displacement": 0}], "increments": 2}
    by = sensitivities(scene)
    assert list(by["displacement_external"]) == ["a:Q", "a:P"] and by["force"].shape == (2, 2, 0)
    assert list(by["law_unit"]) == ["length", "length"]
    for i, load in enumerate((1, 0)):
        def add_displacement(changed, h):
            changed["loads"][load]["displacement"] += h

        expect(by["displacement"][:, :, i], scene, add_displacement, 1)
    for i, (law, k) in enumerate((("soft", 100), ("hard", 700))):
        def add_stiffness(changed, h):
            changed["laws"][law]["k"] += h

        expect(by["law"][:, :, i], scene, add_stiffness, k)


def expect_peaks(by, scene, change, value):
    """Derivatives of all peaks by a number of about `value`."""
    _, differences = difference(scene, change, STEP * value)
    assert sorted(by) == sorted(by) and len(by) == len(differences)
    found = np.array([by[name] for name in sorted(by)])
    assert np.abs(found - differences).max() < 1e-4 * np.abs(differences).max(), (found, differences)


def check_holes_of_both_kinds():
    """A fastener through one hole whose springs only push and one whose springs pull too: each has one coefficient, which acts."""
    for sheet in ("upper", "lower"):
        plate = json.loads((ROOT / f"tests/pipeline/scenes/lap_joint/{sheet}.json").read_text())
        for hole in plate["holes"]:
            hole["spring"] |= {"compression_only": True, "harmonics": 16} if sheet == "upper" else {}
        Path(f"{sheet}.json").write_text(json.dumps(plate))
        run("stage1_plate", f"{sheet}.json", "-o", f"{sheet}.h5", "--p", 4)
        run("stage2_extract", f"{sheet}.h5", "-o", f"{sheet}.matrices.h5", "--loads-only")
    scene = json.loads((ROOT / "tests/pipeline/scenes/lap_joint/joint.json").read_text())
    for fastener in scene["fasteners"]:
        fastener["friction"] = 0.15
        fastener.pop("clearance", None)
    by = sensitivities(scene)
    assert sorted(by["mu_hole"]) == sorted(f"{sheet}:{hole}" for sheet in ("upper", "lower") for hole in "abcd"), by["mu_hole"]
    assert np.abs(by["mu"]).max(axis=(0, 1)).min() > 0, by["mu"]


def check_peaks():
    """Of both kinds of springs, with a law, gaps or clearances and friction; loaded at an edge and in a hole."""
    rows = [(f"{kind} {directions}", kind, directions) for kind in ("all around", "contact") for directions in (["x"], ["x", "y"])]
    if not SWEEP:
        rows = rows[::3]
    for name, kind, directions in rows:
        for sheet in ("upper", "lower"):
            plate = json.loads((ROOT / f"tests/pipeline/scenes/lap_joint/{sheet}.json").read_text())
            plate["disc_directions"] = directions
            for hole in plate["holes"]:
                hole["spring"] |= {"compression_only": True, "harmonics": 16} if kind == "contact" else {}
            if sheet == "lower":
                plate["external"] = [{"id": "Q", "on": "right", "direction": "x", "kind": "traction"}]
            Path(f"{sheet}.json").write_text(json.dumps(plate))
            run("stage1_plate", f"{sheet}.json", "-o", f"{sheet}.h5", "--p", "5..6")
            run("stage2_extract", f"{sheet}.h5", "-o", f"{sheet}.matrices.h5")
        scene = json.loads((ROOT / "tests/pipeline/scenes/lap_joint/joint.json").read_text())
        scene |= {"solver": {"tolerance": 1e-13}, "increments": 2}
        scene["loads"].append({"external": "lower:Q", "force": 900})
        for i, fastener in enumerate(scene["fasteners"]):
            fastener["friction"] = {"upper": 0.1 + 0.02 * i, "lower": 0.15}
            fastener.pop("clearance", None)
            fastener |= {"gap": 0.01 + 0.002 * i} if kind == "contact" else {"clearance": 0.01 if i == 1 else 0}
        by = sensitivities(scene)
        assert list(by["peak/hole"]) == list(by["peaks"]), name

        def named(table, column):
            return dict(zip(by["peak/hole"], by[f"peak/{table}"][:, column]))

        def add(*keys):
            def change(changed, h):
                for key in keys[:-1]:
                    changed = changed[key]
                changed[keys[-1]] += h
            return change

        for i, (external, load, force) in enumerate((("upper:P", 0, 4000), ("lower:Q", 1, 900))):
            at = list(by["force_external"]).index(external)
            expect_peaks(named("force", at), scene, add("loads", load, "force"), force)
        for i, (number, value) in enumerate((("A", 9000), ("n", 0.8))):
            expect_peaks(named("law", i), scene, add("laws", "rivet", number), value)
        for hole in ("upper:a", "lower:c"):
            at = list(by["mu_hole"]).index(hole)
            plate, fastener = hole.split(":")[0], "abcd".index(hole[-1])
            expect_peaks(named("mu", at), scene, add("fasteners", fastener, "friction", plate), 0.15)
        if kind == "contact":
            both = {hole: by["peak/gap"][i, [list(by["gap_hole"]).index(f"{sheet}:b") for sheet in ("upper", "lower")]].sum()
                    for i, hole in enumerate(by["peak/hole"])}
            expect_peaks(both, scene, add("fasteners", 1, "gap"), 0.012)
        else:
            expect_peaks(named("clearance", 1), scene, add("fasteners", 1, "clearance"), 0.01)
        unloaded = sensitivities(scene | {"increments": [0.0]})
        assert np.all(np.isinf(unloaded["peak/load_factor"])), unloaded["peak/load_factor"]
        total = 4000 * by["peak/force"][:, list(by["force_external"]).index("upper:P")] + \
            900 * by["peak/force"][:, list(by["force_external"]).index("lower:Q")]
        assert np.allclose(by["peak/load_factor"], total, rtol=1e-4, atol=1e-6 * np.abs(total).max()), name


def main(bin_folder, *_):
    os.environ["PATH"] = str(Path(bin_folder).resolve()) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        for check in (check_lap_joint, check_bars_of_a_stack, check_linear_chains, check_holes_of_both_kinds, check_peaks):
            folder = Path(work) / check.__name__
            folder.mkdir()
            os.chdir(folder)
            check()
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
