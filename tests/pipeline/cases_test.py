#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Load cases and their envelope against single runs, one case after another, studies over cases, and what is refused.

Usage: cases_test.py FOLDER_OF_PROGRAMS"""
import csv
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

N = 3  # fasteners in a row


def sheets(folder, contact=False):
    """Two sheets in a lap, each with a rigid end and an edge under traction."""
    spring = {"compression_only": True, "harmonics": 16, "disk": {"E": 2e5, "nu": 0.3}} if contact else {"modulus": 1e5}
    for name, free, fixed in (("upper", "right", None), ("lower", "left", "left")):
        scene = {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"}, "analysis": "plane stress", "p": [4, 5],
                 "materials": {"m": {"E": 7e4, "nu": 0.3}},
                 "geometry": {"grid": {"x": [10 * i for i in range(N + 1)], "y": [0, 10], "thickness": 2}},
                 "holes": [{"id": str(i), "center": [10 * i + 5, 5], "radius": 2, "spring": spring} for i in range(N)]}
        if fixed:
            scene["supports"] = [{"on": fixed, "fix": ["x", "y"]}]
        else:
            scene["external"] = [{"id": "P", "on": free, "direction": "x", "kind": "rigid"}, {"id": "T", "on": "top", "direction": "y", "kind": "traction"}]
        matrices(folder, scene, name)


def joint(cases=None, law=None, **more):
    fasteners = [{"id": f"bolt {i}", "between": [f"upper:{i}", f"lower:{i}"], "law": "bolt"} for i in range(N)]
    made = {"format": "joint", "version": 1, "name": "lap", "plates": {name: f"{name}.h5" for name in ("upper", "lower")},
            "laws": {"bolt": law or {"type": "linear", "k": 3e4}}, "fasteners": fasteners}
    return made | ({"cases": cases} if cases else {}) | more


def run(folder, scene, *words, output="out.h5", status=0):
    (folder / "joint.json").write_text(json.dumps(scene))
    done = subprocess.run([PROGRAMS / "stage3_nonlinear", "joint.json", "-o", output, *words], cwd=folder, capture_output=True, text=True)
    assert done.returncode == status, (done.stdout, done.stderr)
    return done


def loads(P, T=0.0):
    return [{"external": "upper:P", "force": P}, {"external": "upper:T", "force": T}]


def tables(file):
    """Every table of a RESULT.h5 with a row for each increment, by path."""
    steps, found = len(file["load_factor"]), {}
    file.visititems(lambda name, item: found.update({name: item[:]}) if isinstance(item, h5py.Dataset) and item.dtype == float and item.ndim > 1 and len(item) == steps and "/free/" not in name and name.split("/")[-1] not in ("center", "ends", "at")
                    and "stiffness" not in name else None)
    return found


def hoop(file):
    """By hole: the points of its rim, and the hoop stress there at every increment."""
    found = {}
    for plate in file["plate/name"].asstr():
        rims = file[f"plates/{plate}/rim"]
        for i, hole in enumerate(rims["hole"].asstr()):
            points = slice(*rims["start"][i:i + 2])
            found[f"{plate}:{hole}"] = rims["angle"][points], rims["sigma_tt"][:, points]
    return found


def ranges_by_brute_force(kind, ranges, singles, with_jumps):
    """The stress range of every hole against hoop stresses of single runs at points one degree apart: its spot lies between two of them.
    Around jumps of friction a spot does not count in that increment; where contact with friction ends the stress has a cusp, which may stand between two points."""
    assert sorted(ranges["of"]) == sorted(singles[0]) and np.all(np.diff(ranges["range"].astype(np.float32)) <= 0) and np.all(ranges["error"] > 0)
    missed = 0
    for i, of in enumerate(ranges["of"]):
        angle, stress = singles[0][of][0], np.concatenate([each[of][1] for each in singles])
        scale, at = np.abs(stress).max(), np.argsort(np.abs((angle - ranges["angle"][i] + 180) % 360 - 180))[:2]
        for name, most in (("largest", stress[:, at].max(axis=0)), ("smallest", stress[:, at].min(axis=0))):
            value, its = ranges[name][i], stress[ranges[f"{name}_at"][i], at]
            missed = max(missed, (value - most.max()) / scale, (most.min() - value) / scale, np.abs(its - most).min() / scale)
        assert ranges["range"][i] == ranges["largest"][i] - ranges["smallest"][i]
        beyond = np.ptp(stress, axis=0).max() - ranges["range"][i]
        missed = max(missed, 0 if with_jumps else beyond / scale)
    near(f"{kind}: stress ranges by brute force", missed, 0, 0.02 if with_jumps else 0.002, absolute=True)


def against_single_runs(folder):
    """Forty cases of a linear joint and twelve of one with gaps: rows, envelope, stress ranges and governing cases are those of as many runs."""
    random = np.random.default_rng(3)
    for kind, more, n in (("linear", {}, 40), ("with contact", {"gap": 0.01, "friction": 0.1}, 12)):
        sheets(folder, contact=bool(more))
        cases = [{"name": f"case {i}", "loads": loads(*random.uniform(-5000, 5000, 2)), "increments": int(random.integers(1, 4))} for i in range(n)]
        cases[1]["loads"] = loads(0, 0)
        scene = joint(cases)
        for fastener in scene["fasteners"]:
            fastener |= more
        run(folder, scene, "--csv", "all.csv", "--envelope", "envelope.csv")
        with h5py.File(folder / "out.h5") as file:
            rows, of, envelope = tables(file), file["case/of"][:], file["envelope"]
            assert list(file["case/name"].asstr()) == [case["name"] for case in cases]
            largest = {quantity: [envelope[f"{quantity}/{each}"][:] for each in ("largest", "largest_at", "smallest", "smallest_at")]
                       for quantity in envelope["quantity"].asstr()[:]}
            ranges = {key: item.asstr()[:] if key == "of" else item[:] for key, item in file["stress_range"].items()}
        worst, singles = 0, []
        for i in range(n):
            single = {key: value for key, value in scene.items() if key != "cases"} | {key: cases[i][key] for key in ("loads", "increments")}
            run(folder, single, "--rim-stresses", output="one.h5")
            with h5py.File(folder / "one.h5") as file:
                singles.append(hoop(file))
                for path, table in tables(file).items():
                    if "/sigma_" in path:
                        continue
                    worst = max(worst, np.abs(rows[path][of == i] - table).max(initial=0) / max(np.abs(table).max(initial=0), 1e-9))
        ranges_by_brute_force(kind, ranges, singles, with_jumps=bool(more))
        near(f"{kind}: rows of a case against its own run", worst, 0, 1e-7, absolute=True)
        for quantity, path, of_column in (("transferred_first", "transferred", lambda t: t[:, :, 0]), ("displacement", "plates/upper/De", lambda t: t),
                                          ("delta", "delta", lambda t: t)):
            table = of_column(rows[path])
            assert np.array_equal(largest[quantity][0], table.max(axis=0)) and np.array_equal(largest[quantity][1], table.argmax(axis=0)), quantity
            assert np.array_equal(largest[quantity][2], table.min(axis=0)) and np.array_equal(largest[quantity][3], table.argmin(axis=0)), quantity
        holes = [row for plate in ("lower", "upper") for row in rows[f"plates/{plate}/rim/peak_hoop"].T]
        assert np.array_equal(largest["peak_hoop"][0], np.max(holes, axis=1))
        assert ranges["range"].max() >= np.max(holes) * (1 - 1e-9), "one case has no load"
        lines = list(csv.DictReader(open(folder / "all.csv")))
        assert len(lines) == N * len(of) and all(line["joint"] == "lap" for line in lines)
        assert [line["case"] for line in lines[::N]] == [f"case {i}" for i in of]
        named = {(line[1], line[2]): line for line in list(csv.reader(open(folder / "envelope.csv")))[1:]}
        at = largest["transferred_first"][1][0]
        line = named["transferred_first", "bolt 0"]
        assert (float(line[4]), line[5]) == (largest["transferred_first"][0][0], f"case {of[at]}") and int(line[6]) == 1 + np.sum(of[:at] == of[at]), line
        backwards = run(folder, scene | {"cases": cases[::-1]})
        assert f'of case "case {of[at]}"' in backwards.stdout
        with h5py.File(folder / "out.h5") as file:
            turned = {quantity: file[f"envelope/{quantity}/largest"][:] for quantity in largest}
        near(f"{kind}: envelope of the cases in reverse order", max(np.abs(turned[q] - largest[q][0]).max() / max(np.abs(largest[q][0]).max(), 1e-9) for q in largest),
             0, 1e-7, absolute=True)


def tabled(folder):
    """Cases of a table, 1000 of them, are those of single runs to 1e-9 of their scale, in another order too; what is wrong is named by line and column."""
    random = np.random.default_rng(66)
    sheets(folder, contact=True)
    scene = joint() | {"cases": {"table": "loads.csv"}, "bending": "none"}
    for fastener in scene["fasteners"]:
        fastener |= {"gap": 0.01}
    forces = random.uniform(-5000, 5000, (1000, 2)).round(3)
    line = lambda i: f"flight {i},{forces[i, 0]},{forces[i, 1]}"
    heading = "case,upper:P,upper:T"

    def solve(order):
        (folder / "loads.csv").write_text("\n".join([heading, *map(line, order)]) + "\n")
        done = run(folder, scene)
        with h5py.File(folder / "out.h5") as file:
            assert list(file["case/name"].asstr()) == [f"flight {i}" for i in order]
            return done.stdout, tables(file)

    printed, rows = solve(range(1000))
    assert len(printed.splitlines()) < 200 and "more cases" in printed, printed
    picked = random.permutation(1000)[:20]
    again = solve(picked)[1]
    worst = 0
    for at, i in enumerate(picked):
        run(folder, joint(**{"loads": loads(*map(float, forces[i])), "bending": "none", "fasteners": scene["fasteners"]}))
        with h5py.File(folder / "out.h5") as file:
            single = tables(file)
        for name, values in single.items():
            if name not in rows or values.shape[1:] != rows[name].shape[1:]:
                continue
            scale = np.nanmax(np.abs(rows[name]), initial=0, where=np.isfinite(rows[name])) or 1
            for found in (rows[name][i], again[name][at]):
                apart = np.abs(np.where(np.isfinite(values[0]), found - values[0], 0)).max(initial=0) / scale
                worst = max(worst, apart if "error" not in name and "angle" not in name else 0)
    near("cases of a table against single runs, and in another order", worst, 0, 1e-9, absolute=True)

    for text, message in (("case,upper:P\na,1\na,2\n", 'loads.csv:3: "a" stands twice'), ("case,upper:P\na,x\n", 'loads.csv:2: "x" in column "upper:P"'),
                          ("name,upper:P\na,1\n", 'loads.csv:1: no column "case"'), ("case,upper:P\n", "loads.csv: no case"), ("case,side:P\na,1\n", 'loads.csv:1: column "side:P"'),
                          ("case,upper:Q\na,1\n", 'column "upper:Q": external "Q" does not exist'), ("case,upper:P\na\n", "loads.csv:2: 1 cell, and 2 of names"),
                          ("case,upper:P moment\na,1\n", 'takes no moment'), ("case,upper:P,upper:P displacement\na,1,1\n", "a second column of this external")):
        (folder / "loads.csv").write_text(text)
        said = run(folder, scene, status=2).stderr
        assert message in said, (message, said)


def superposition(folder):
    sheets(folder)
    run(folder, joint([{"name": "P", "loads": loads(1000)}, {"name": "T", "loads": loads(0, 500)}, {"name": "both", "loads": loads(-2000, 250)},
                       {"name": "after", "after": "P", "loads": loads(-3000, 250)}]))
    with h5py.File(folder / "out.h5") as file:
        for path, table in tables(file).items():
            if "bending/" not in path and path.split("/")[-1] in ("F", "transferred", "D", "De", "Pe", "F_vector", "bearing_load") and table.size:
                signed = table if path not in ("F", "transferred") else file["F_vector"][:]
                scale = np.abs(signed).max()
                near(f"{path}: P and T superposed", np.abs(-2 * signed[0] + 0.5 * signed[1] - signed[2]).max() / scale, 0, 1e-12, absolute=True)
                near(f"{path}: one case after another", np.abs(signed[3] - signed[2]).max() / scale, 0, 1e-12, absolute=True)


def one_after_another(folder):
    """A joint is assembled with interference, loaded, and loaded further: the state is that of all loads at once, which has no memory yet."""
    sheets(folder, contact=True)
    scene = joint([{"name": "pull more", "after": "pull", "loads": loads(2000, 300), "increments": 2}, {"name": "assembly", "loads": []},
                   {"name": "pull", "after": "assembly", "loads": loads(1000)}])
    for fastener in scene["fasteners"]:
        fastener |= {"gap": -0.005}
    run(folder, scene)
    with h5py.File(folder / "out.h5") as file:
        of, found, pressure = file["case/of"][:], file["F_vector"][:], file["plates/upper/contact/peak_pressure"][:]
        assert list(of) == [0, 0, 1, 2] and pressure[2].min() > 50 and np.abs(found[2]).max() < 0.2 * np.abs(found[3]).max(), (of, found)
    run(folder, {key: value for key, value in scene.items() if key != "cases"} | {"loads": loads(3000, 300)})
    with h5py.File(folder / "out.h5") as file:
        near("assembly, pull and pull more: forces", np.abs(found[1] - file["F_vector"][-1]).max() / 3000, 0, 1e-8, absolute=True)
    done = run(folder, scene, "--case", "pull more")
    assert "increment 2 of 2: load factor 1" in done.stdout and done.stdout.count("increment 1 of 2") == 1


def totals(folder):
    """Rows, sections and edges: each sum is that of its fasteners, tension grows row by row to the load, and the CSV holds what the file holds."""
    sheets(folder, contact=True)
    cases = [{"name": "pull", "loads": loads(900), "increments": 2}, {"name": "both", "loads": loads(-500, 70)}]
    run(folder, joint(cases), "--totals", "totals.csv")
    lines = list(csv.DictReader(open(folder / "totals.csv", encoding="utf-8")))
    key = lambda line: (line["case"], int(line["increment"]), line["plate"], line["direction"], line["of"], line["at"], line["quantity"])
    found = {key(line): float(line["value"]) for line in lines}
    assert len(found) == len(lines), "each number once"
    n = 0
    with h5py.File(folder / "out.h5") as file:
        for row, (case, step) in enumerate((("pull", 1), ("pull", 2), ("both", 1))):
            T = 70 * (case == "both")
            for name in ("upper", "lower"):
                plate = file[f"plates/{name}"]
                at = lambda direction, of, place, quantity: found.get((case, step, name, direction, of, place, quantity))
                for axis in (0, 1):
                    parts = [plate[f"total/{each}"][row, axis] for each in ("applied", "by_fasteners", "by_supports")]
                    assert parts == [at("xy"[axis], "sheet", "", each) for each in ("applied", "by fasteners", "by supports")]
                    assert abs(sum(parts)) < 1e-9
                rows = plate["row"]
                for i, direction in enumerate(rows["direction"].asstr()):
                    for each, quantity in (("force", "by fasteners"), ("before", "in sheet before"), ("after", "in sheet after")):
                        value = rows[each][row, i]
                        assert at(direction, "row", f"{rows['at'][i]:g}", quantity) == (value if np.isfinite(value) else None), (name, i, each)
                        n += np.isfinite(value)
                along = [i for i, direction in enumerate(rows["direction"].asstr()) if direction == "x"]
                assert list(rows["at"][along]) == [5, 15, 25] and list(rows["holes"][along]) == [1, 1, 1]
                force, before, after = (rows[each][row][along] for each in ("force", "before", "after"))
                near("tension past a row", np.abs(before - after - force).max(), 0, 1e-8, absolute=True)
                near("tension between rows", np.abs(after[:-1] - before[1:]).max(), 0, 1e-8, absolute=True)
                P = file["plates/upper/Pe"][row, 0]
                near("tension at the ends", np.abs([before[0] - (name == "lower") * P, after[-1] - (name == "upper") * P]).max(), 0, 1e-8, absolute=True)
                near("forces of rows", abs(force.sum() - plate["total/by_fasteners"][row, 0]), 0, 1e-9, absolute=True)
            assert found[case, step, "upper", "", "P", "", "displacement"] == file["plates/upper/De"][row, 0]
            moved = file["plates/upper/traction/displacement"][row, 0]
            assert np.isfinite(moved) and found[case, step, "upper", "", "T", "", "displacement"] == moved and found[case, step, "upper", "", "T", "", "force"] == T
    # Three rows along x and one along y, whose section crosses the support of the lower sheet where that reacts along y.
    assert n == 3 * 2 * 3 * (N + 1) - 2, ("rows with their sections", n)
    # The mean displacement under a traction is that by which its work is that of the joint: by a linear joint without gaps, Maxwell's theorem.
    sheets(folder)
    moved = []
    for one, other in ((1, 0), (0, 1)):
        run(folder, joint(loads=loads(one, other)))
        with h5py.File(folder / "out.h5") as file:
            moved.append([file["plates/upper/De"][-1, 0], file["plates/upper/traction/displacement"][-1, 0]])
    near("Maxwell's theorem of an edge that moves as one and one under traction", abs(moved[0][1] / moved[1][0] - 1), 0, 1e-9, absolute=True)
    assert moved[1][1] > 0


def failures(folder):
    sheets(folder)
    weak = {"type": "bilinear", "k": 3e4, "F_yield": 100, "k_yield": 0}
    scene = joint([{"name": "small", "loads": loads(200)}, {"name": "large", "loads": loads(1000), "increments": [0.1, 0.2, 1]},
                   {"name": "larger", "after": "large", "loads": loads(100)}], law=weak)
    done = run(folder, scene, status=4)
    assert 'case "large": limit load reached' in done.stderr and 'case "larger" comes after "large", which was not solved' in done.stderr \
        and "(2 of 3 cases were not solved)" in done.stderr, done.stderr
    with h5py.File(folder / "out.h5") as file:
        assert list(file["case/of"][:]) == [0, 1, 1] and file.attrs["complete"] == 0
    good = {"name": "a", "loads": loads(100)}
    moved = [{"external": "upper:P", "displacement": 0.1}]
    for cases, words, message in (
            ([good, good], [], '/cases/1/name: "a" stands twice; allowed: each name once'),
            ([good | {"after": "b"}], [], '/cases/0/after: "b" is no case; allowed: a'),
            ([good | {"after": "b"}, {"name": "b", "loads": [], "after": "a"}], [], '/cases/0/after: "a" comes after itself'),
            ([good, {"name": "b", "after": "a", "loads": moved}], [], '/cases/1/loads: displaces or ties other externals than "a"'),
            ([good], ["--case", "c"], '--case: "c"; allowed: a'),
            ([good, good | {"name": "b"}], ["--sensitivities"], "--sensitivities: given for 2 cases; allowed: together with --case NAME"),
            ([good | {"loads": loads(1)[:1] * 2}], [], '"upper:P" is loaded already')):
        done = run(folder, joint(cases), *words, status=2)
        assert message in done.stderr, (message, done.stderr)
    done = run(folder, joint([good], loads=loads(1)), status=2)
    assert '/loads: given together with "cases"; allowed: one of them' in done.stderr, done.stderr
    done = run(folder, joint(loads=loads(1)), "--envelope", "x.csv", status=2)
    assert "--envelope: given for a joint without cases" in done.stderr, done.stderr
    run(folder, joint([good, {"name": "moved", "loads": moved}]))  # which needs another condensed joint
    with h5py.File(folder / "out.h5") as file:
        near("a given displacement after a given force", file["plates/upper/De"][1, 0], 0.1, 1e-12)


def ties(folder):
    """Two lugs pulled as one: they move alike, share the force by their stiffness, and are what equal given displacements make of them."""
    sheets(folder)
    for name in ("one", "two"):
        spring = {"modulus": 1e5 if name == "one" else 3e4}
        scene = {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"}, "analysis": "plane stress", "p": [4, 5],
                 "materials": {"m": {"E": 7e4, "nu": 0.3}}, "geometry": {"grid": {"x": [0, 10, 20], "y": [0, 10], "thickness": 2}},
                 "holes": [{"id": "h", "center": [5, 5], "radius": 2, "spring": spring}], "supports": [{"on": "bottom", "fix": ["y"]}],
                 "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}
        matrices(folder, scene, name)
    lugs = {"format": "joint", "version": 1, "plates": {name: f"{name}.h5" for name in ("one", "two")}, "laws": {"pin": {"type": "power", "A": 2e4, "n": 0.8}},
            "fasteners": [{"id": name, "between": [f"{name}:h", "ground"], "law": "pin", "clearance": 0.01 if name == "one" else 0} for name in ("one", "two")]}
    both = [{"external": ["one:P", "two:P"], "force": 3000}]
    run(folder, lugs | {"loads": both, "increments": 3})
    with h5py.File(folder / "out.h5") as file:
        moved = [file[f"plates/{name}/De"][-1, 0] for name in ("one", "two")]
        forces, found = [file[f"plates/{name}/Pe"][-1, 0] for name in ("one", "two")], file["F"][-1]
        assert list(file["stiffness/external"].asstr()) == ["one:P"] and file["stiffness/tangent"][-1, 0] > 0
    near("tied lugs: displacement", moved[1], moved[0], 1e-12)
    near("tied lugs: force", sum(forces), 3000, 1e-9)
    assert 1.05 * forces[0] < forces[1], forces
    run(folder, lugs | {"cases": [{"name": "moved", "loads": [{"external": f"{name}:P", "displacement": moved[0]} for name in ("one", "two")]},
                                  {"name": "tied", "loads": both}, {"name": "free", "loads": [{"external": "one:P", "force": 1000}]}]})
    with h5py.File(folder / "out.h5") as file:
        near("tied lugs: loads by given displacements", np.abs(file["F"][0] - found).max() / 3000, 0, 1e-8, absolute=True)
        near("tied lugs: among other cases", np.abs(file["F"][1] - found).max() / 3000, 0, 1e-8, absolute=True)
        near("one lug alone", abs(file["F_vector"][2, 0, 0]), 1000, 1e-9)
    for load, message in (({"external": ["one:P"], "force": 1}, "/loads/0/external"), ({"external": ["one:P", "one:P"], "force": 1}, "is loaded already"),
                          ({"external": ["one:P", "two:P"], "displacement": 1}, "given for tied externals"),
                          ({"external": ["one:P", "two:Q"], "force": 1}, '"two:Q" is no rigid external')):
        assert message in run(folder, lugs | {"loads": [load]}, status=2).stderr, load


def studies(folder):
    """The numbers of a sample are the largest of all cases' runs; a study can name cases, and vary their loads."""
    sheets(folder, contact=True)
    scene = joint([{"name": "pull", "loads": loads(1000)}, {"name": "push", "loads": loads(-1500, 200)}, {"name": "on top", "after": "pull", "loads": loads(500, 100)}])
    variables = [{"name": "gap", "at": "/fasteners/*/gap", "each": True, "distribution": {"type": "uniform", "from": 0, "to": 0.02}},
                 {"name": "load", "at": "/cases/1/loads/0/force", "use": "factor", "distribution": {"type": "uniform", "from": 0.5, "to": 1.5}}]
    for chosen in (None, ["on top"], ["pull", "push"]):
        study = {"format": "study", "version": 1, "samples": 6, "seed": 2, "variables": variables, "outputs": ["peaks", "displacements"]}
        (folder / "study.json").write_text(json.dumps(study | ({"cases": chosen} if chosen else {})))
        run(folder, scene, "--study", "study.json", output="study.h5")
        run(folder, scene, "--study", "study.json", "--sample", "4", output="sample.json")
        run(folder, json.loads((folder / "sample.json").read_text()))
        with h5py.File(folder / "study.h5") as made, h5py.File(folder / "out.h5") as one:
            keep = np.isin(one["case/name"].asstr()[:][one["case/of"][:]], chosen or ["pull", "push", "on top"])
            moved = one["plates/upper/De"][:][keep, 0]
            for name, found, truth in (("force", made["samples/force"][4], np.abs(one["transferred"][:, :, 0])[keep].max(axis=0)),
                                       ("peak", made["samples/peak"][4][-N:], one["plates/upper/rim/peak_hoop"][:][keep].max(axis=0)),
                                       ("displacement", made["samples/displacement"][4], moved[[np.abs(moved).argmax()]])):
                near(f"study of {chosen or 'all cases'}: {name}", np.abs(found - truth).max() / np.abs(truth).max(), 0, 1e-7, absolute=True)
    checks = [{"check": "fastener shear", "name": name, "P_su": 900} | more for name, more in (("all", {}), ("pushed", {"cases": ["push"]}))]
    (folder / "study.json").write_text(json.dumps(study | {"cases": ["pull"], "outputs": ["margins"]}))
    done = run(folder, scene | {"margins": {"checks": checks}}, "--study", "study.json", output="study.h5").stderr
    assert '[check-left-out]' in done and 'check "pushed"' in done and "the study has none of its cases" in done, done
    with h5py.File(folder / "study.h5") as made:
        assert [of.split(":")[0] for of in made["statistics/utilisation/of"].asstr()] == ["all"] * N
    (folder / "study.json").write_text(json.dumps(study | {"cases": ["x"]}))
    done = run(folder, scene, "--study", "study.json", output="study.h5", status=2)
    assert 'study.json: /cases: "x" is no case of the joint; allowed: pull, push, on top' in done.stderr, done.stderr


def main():
    with tempfile.TemporaryDirectory() as name:
        for each in (against_single_runs, tabled, superposition, one_after_another, totals, failures, ties, studies):
            each(Path(name))
    end_if_missed()


if __name__ == "__main__":
    main()
