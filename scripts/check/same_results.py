# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares RESULT.h5, STUDY.h5 and the tables of two builds of stage3_nonlinear on random joints of the attack, by dataset:
same_results OLD NEW NUMBER [SEED], or OLD NEW kept on the joints of the examples and of the kept cases.

Sheets are solved and extracted once, by the new build. Each number may be off by 1e-12 of the largest with its unit in the file;
names, units, meanings and the lines of tables must be equal; there may be more of them. Not compared: iterations, residuals, which follow from rounding, and
places that are told of two equal numbers."""
import csv
import json
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/attack"), str(ROOT / "tests/support"), str(ROOT / "scripts/python")]
sys.dont_write_bytecode = True
from wild_joints import random_scene  # noqa: E402

SAME = 1e-12
NOT_COMPARED = ("_at", "iterations", "residual", "peak_angle", "peak_angle/largest", "peak_angle/smallest")
TABLES = ["csv", "totals"]


def run(folder, program, *words):
    start = time.perf_counter()
    done = subprocess.run([program, *words, "--quiet"], cwd=folder, capture_output=True, text=True, timeout=600)
    return done.returncode, done.stderr, time.perf_counter() - start


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: (value_of(item), dict(item.attrs))}) if isinstance(item, h5py.Dataset) else None)
    return found


def value_of(item):
    """Warnings name the file that is written."""
    value = item[()]
    return np.array([re.sub(r"\b(old|new)\.", "", str(each)) for each in np.ravel(value)]) if item.dtype == object else value


def differences(old, new):
    """Lines that say what differs."""
    a, b = datasets(old), datasets(new)
    scales = {}
    for x, its in a.values():
        if np.asarray(x).dtype.kind == "f":
            known = np.abs(np.ravel(x)[np.isfinite(np.ravel(x))]).max(initial=1e-300)
            scales[its.get("unit")] = max(known, scales.get(its.get("unit"), 0))
    for name in sorted(a.keys() - b.keys()):
        yield f"{name}: only in the old file"
    for name in sorted(a.keys() & b.keys()):
        if name.endswith(NOT_COMPARED):
            continue
        (x, its), (y, other) = a[name], b[name]
        if its != other:
            yield f"{name}: attributes {its} and {other}"
        if np.shape(x) != np.shape(y):
            yield f"{name}: shapes {np.shape(x)} and {np.shape(y)}"
        elif np.asarray(x).dtype.kind != "f":
            if not np.array_equal(x, y) and name != "generator":
                yield f"{name}: {x} and {y}"
        elif not np.array_equal(np.isfinite(x), np.isfinite(y)):
            yield f"{name}: not known at other places"
        else:
            known = np.isfinite(x)
            off = np.abs(np.asarray(x)[known] - np.asarray(y)[known]).max(initial=0) / scales[its.get("unit")]
            if off > SAME:
                yield f"{name}: off by {off:.1e}"


def differences_of_tables(old, new):
    if not old.exists():
        return
    tables = [list(csv.reader(path.open())) for path in (old, new)]
    place = {heading: i for i, heading in enumerate(tables[1][0])}
    if len(tables[0]) != len(tables[1]) or not set(tables[0][0]) <= set(place):
        yield "has other lines or lacks columns"
        return
    for x, y in zip(*tables):
        for heading, a in zip(tables[0][0], x):
            b = y[place[heading]]
            if a != b and heading.split("_")[0] not in ("largest in case", "at increment", "smallest in case", "iterations", "residual") and "peak_angle" not in heading + x[1] and not close(a, b):
                yield f"{heading}: {a} and {b}"


def close(a, b):
    try:
        return abs(float(a) - float(b)) <= 1e-9 * abs(float(a)) + 1e-12
    except ValueError:
        return False


def options(random, joint):
    words = [["--rim-stresses"], ["--distance", "0.5"], ["--sensitivities"]]
    chosen = [word for word in words if random.random() < 0.4 and not (word[0] == "--sensitivities" and "cases" in joint)]
    words = sum(chosen, []) + sum((["--" + table, f"OUT.{table}"] for table in TABLES), [])
    if "cases" in joint:
        words += ["--envelope", "OUT.envelope"]
    if "margins" in joint:
        words += ["--margins", "OUT.margins"]
    return words


def study_of(random, joint):
    outputs = [each for each in ("peaks", "displacements", "cracks") if random.random() < (0.2 if each == "cracks" else 0.6)]
    return {"format": "study", "version": 1, "seed": 7, "samples": 12, "outputs": ["forces", *outputs], "limits": {"force": 100} if random.random() < 0.5 else {},
            "variables": [{"name": "load", "at": "/loads/0/force" if "loads" in joint else "/cases/0/loads/0/force", "use": "factor",
                           "distribution": {"type": "normal", "mean": 1, "deviation": 0.05}}]}


def random_joint(seed, folder):
    """Files of a random joint with its study. @returns options of stage 3."""
    choice = random.Random(seed)
    scene = random_scene(choice)
    (folder / "joint.json").write_text(json.dumps(scene.joint))
    (folder / "study.json").write_text(json.dumps(study_of(choice, scene.joint)))
    for sheet, plate in scene.plates.items():
        (folder / f"{sheet}.json").write_text(json.dumps(plate))
    return options(choice, scene.joint)


def files_of(joint):
    return {name: plate["file"] if isinstance(plate, dict) else plate for name, plate in joint["plates"].items()}


def sheet_of(file):
    return Path(file).name.split(".")[0]


def solve_sheets(folder, programs, joint):
    """True if all sheets of the joint could be solved and extracted, whose files are named after their matrices; those of examples that
    take the sheet of another stand there."""
    for file in set(files_of(joint).values()):
        sheet = sheet_of(file)
        (folder / file).parent.mkdir(exist_ok=True)
        found = [path for path in (folder / f"{sheet}.json", folder / f"{sheet}.plate.json", *ROOT.glob(f"examples/*/{sheet}.json")) if path.exists()]
        if not found:
            return False
        for words in (["stage1_plate", found[0], "-o", f"{sheet}.plate.h5"], ["stage2_extract", f"{sheet}.plate.h5", "-o", file]):
            if run(folder, programs / words[0], *words[1:])[0]:
                return False
    return True


def compare(folder, joint, builds, words, seconds):
    """Lines that say what differs, and whether the joint and its study, if it has one, were solved."""
    said, lines, has_study = {}, [], (folder / "study.json").exists()
    for which, program in builds.items():
        status, text, time_of = run(folder, program, joint, "-o", f"{which}.h5", *(word.replace("OUT", which) for word in words))
        seconds[which] += time_of
        of_study, of_text = run(folder, program, joint, "--study", "study.json", "-o", f"{which}.study.h5", "--threads", "1")[:2] if has_study else (None, "")
        said[which] = (status, of_study, text.replace(f"{which}.", ""), of_text.replace(f"{which}.", ""))
    if said["old"] != said["new"]:
        lines.append(f"said {said}")
    for file in ("h5", "study.h5"):
        if all((folder / f"{which}.{file}").exists() for which in builds):
            lines += [f"{file}: {line}" for line in differences(folder / f"old.{file}", folder / f"new.{file}")]
    for table in ("csv", "totals", "envelope", "margins"):
        lines += [f"{table}: {line}" for line in differences_of_tables(folder / f"old.{table}", folder / f"new.{table}")]
    return lines, said["new"][0] == 0, said["new"][1] == 0


def kept_joints():
    """Joints of the examples and of the kept cases of the attack."""
    for path in sorted((*ROOT.glob("examples/*/*.json"), *ROOT.glob("tests/attack/cases/*/*.json"))):
        try:
            joint = json.loads(path.read_text())
        except ValueError:
            continue
        if isinstance(joint, dict) and joint.get("format") == "joint" and isinstance(joint.get("plates"), dict):
            yield path


def main():
    builds = {"old": Path(sys.argv[1]).resolve() / "stage3_nonlinear", "new": Path(sys.argv[2]).resolve() / "stage3_nonlinear"}
    kept = sys.argv[3] == "kept"
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    joints = list(kept_joints()) if kept else range(first, first + int(sys.argv[3]))
    bad, ran, studies, seconds = 0, 0, 0, {"old": 0.0, "new": 0.0}
    for each in joints:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name) / "joint"
            if kept:
                shutil.copytree(each.parent, folder, ignore=shutil.ignore_patterns("*.h5", "out", "study.json"))
                words = ["--csv", "OUT.csv"]
            else:
                folder.mkdir()
                words = random_joint(each, folder)
            joint = each.name if kept else "joint.json"
            if not solve_sheets(folder, builds["new"].parent, json.loads((folder / joint).read_text())):
                print(f"joint {each}: its sheets are not solved", flush=True) if kept else None
                continue
            lines, solved, studied = compare(folder, joint, builds, words, seconds)
            ran, studies, bad = ran + solved, studies + studied, bad + bool(lines)
            for line in lines[:6]:
                print(f"joint {each}: {line[:300]}", flush=True)
    print(f"{len(joints)} joints, {ran} and {studies} studies solved, {bad} differ; stage 3 took {seconds['old']:.1f} s and {seconds['new']:.1f} s")
    sys.exit(bool(bad))


main()
