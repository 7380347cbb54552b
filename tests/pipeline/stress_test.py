# SPDX-License-Identifier: GPL-3.0-or-later
"""What RESULT.h5 and its CSV say of the holes is what the matrices and the joint's state give: stress_test.py BIN_FOLDER."""
import csv
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
from examples import copy_example  # noqa: E402


def amounts(plate, step):
    """Of the unit cases, in the order of the matrices' columns; no rim is in contact."""
    return np.concatenate([plate[name][step] for name in ("De", "D", "Lambda", "traction/force")])


def around(rim, kind, i, step):
    """Angles, and stresses there, around a hole."""
    points = slice(*rim["start"][i:i + 2])
    return rim["angle"][points], rim[f"sigma_{kind}"][step, points]


def check_hole(matrices, plate, i, step):
    state = amounts(plate, step)
    angle, hoop = around(plate["rim"], "tt", i, step)
    load = plate["rim/bearing_load"][step, i]
    area = matrices["rim/bearing_area"][i, 0]
    assert np.isclose(plate["rim/bearing_stress"][step, i], abs(load) / area)
    jump = 0 if load > 0 else 180
    away = np.abs((angle - jump + 180) % 360 - 180) > 7.5
    peak = plate["rim/peak_hoop"][step, i]
    assert np.isclose(hoop[away].max(), peak, rtol=1e-3)
    near = np.abs((angle - plate["rim/peak_angle"][step, i] + 180) % 360 - 180) < 1
    assert np.isclose(hoop[near].max(), peak, rtol=1e-3), "beside the place that RESULT.h5 says, which may be a kink"

    hole = matrices["rim/hole"].asstr()[i]
    beside = {side: n for n, (name, side) in enumerate(zip(matrices["section/hole"].asstr(), matrices["section/side"].asstr()))
              if name == hole}
    force = matrices["section/force"][-1] @ state
    area, net = (matrices[f"section/{name}_area"][:] for name in ("gross", "net"))
    of = lambda values, axis: [(values / area)[beside[side + axis]] for side in "+-" if side + axis in beside] or [0]  # noqa: E731
    shear = max((np.mean(of(matrices["section/shear"][-1] @ state, axis)) for axis in "xy"), key=abs)
    across = of(force, "y")
    friction = plate["disc/friction"][step][list(plate["disc/hole"].asstr()).index(hole)]
    passing, bypass = principal((force / area)[beside["+x" if load + friction > 0 else "-x"]], np.mean(across), shear)
    assert np.isclose(plate["rim/bypass_stress"][step, i], bypass) and np.isclose(plate["rim/bypass_direction"][step, i], passing, atol=1e-6)
    angle, stress = principal(max(of(force, "x"), key=abs), max(across, key=abs), shear)
    assert np.isclose(plate["rim/gross_concentration"][step, i], peak / abs(stress))
    share = [net[beside["+" + axis]] / area[beside["+" + axis]] for axis in "xy" if "+" + axis in beside]
    assert min(share) * 0.999 <= plate["rim/net_concentration"][step, i] / plate["rim/gross_concentration"][step, i] <= max(share) * 1.001
    if abs(angle) < 1e-3:
        assert np.isclose(plate["rim/net_concentration"][step, i], peak / abs(stress) * share[0])


def principal(x, y, xy):
    """Direction, degrees, and value of the principal stress of larger magnitude."""
    values, vectors = np.linalg.eigh([[x, xy], [xy, y]])
    at = np.abs(values).argmax()
    return (np.degrees(np.arctan2(*vectors[::-1, at])) + 90) % 180 - 90, values[at]


def resultant(matrices, plate, i, step, axis):
    """Force on the disc of a rim along an axis by the pressure around it."""
    angle, radial = around(plate["rim"], "rr", i, step)
    along = np.cos(np.radians(angle - 90 * axis))
    return -(radial * along).mean() * np.pi * matrices["rim/bearing_area"][i, axis]


def check_pressure(matrices, plate, step):
    """The pressure around each whole rim has the bearing force that the fastener has."""
    for i, load in enumerate(plate["rim/bearing_load"][step]):
        force = resultant(matrices, plate, i, step, 0)
        assert np.isclose(force, load, rtol=1e-6), (i, force)


def check_csv(path, result):
    rows = list(csv.DictReader(path.open()))
    for row in rows:
        step = int(row["increment"]) - 1
        for end, plate in (("first", "upper"), ("second", "lower")):
            rim = result[f"plates/{plate}/rim"]
            i = list(rim["hole"].asstr()).index(row["fastener"])
            for name in ("bearing_load", "bearing_stress", "bypass_load", "bypass_error", "peak_hoop", "peak_angle", "peak_error",
                         "gross_concentration", "net_concentration"):
                (value,) = (text for head, text in row.items() if head.split(" [")[0] == f"{name}_{end}")
                assert float(value) == rim[name][step, i], (row["fastener"], name)


def across(folder, plate, i):
    """Force on the disc of a rim along y at every increment, and the bearing force along x."""
    with h5py.File(folder / f"{plate}.matrices.h5") as matrices, h5py.File(folder / "joint.h5") as result:
        found = result[f"plates/{plate}"]
        loads = found["rim/bearing_load"][:, i]
        return np.array([resultant(matrices, found, i, step, 1) for step in range(len(loads))]), loads


def check_default(folder):
    """Default settings of the lap joint: each doubt is told once, with its worst hole, increment and numbers."""
    run = subprocess.run(["stage3_nonlinear", folder / "joint.json", "-o", folder / "joint.h5", "--rim-stresses"], check=True,
                         capture_output=True, text=True)
    said = [line for line in run.stderr.splitlines() if line]
    assert len(said) == 4 and all("warning [" in line for line in said), run.stderr
    for line, words in zip(said, (r'\[springs-pull\]: .*hole "upper:d" \(increment 4; 7 other holes too\) .* [\d.]+ N/mm\^2, .* [\d.]+: ',
                                  r'\[hole-filled\]: .*hole "lower:b" \(increment 4; 1 other hole too\)',
                                  r'\[kt-below-one\]: .*Kt net is 0\.7\d+ at hole "upper:b" \(increment 1\)',
                                  r'\[disc-held-across\]: .*hole "lower:b" \(increment 4; 7 other holes too\)')):
        assert re.search(words, line), (words, line)
    forces, bearing = across(folder, "lower", 1)
    told = re.search(r"y displacement of the disc .* is fixed, with a reaction of ([\d.]+) N next to a bearing force of ([\d.]+),", said[3])
    assert np.isclose(float(told[1]), abs(forces[-1]), rtol=1e-3), (told, forces)
    assert np.isclose(float(told[2]), abs(bearing[-1]), rtol=1e-3), (told, forces, bearing)
    column = re.search(r"lower:b .* ([\d.-]+)$", run.stdout, re.M)
    assert np.isclose(float(column[1]), forces[-1], rtol=1e-4), (column, forces)


def check_without_peaks(folder):
    """Holes that want no stresses have no peaks, and nothing is said of those."""
    plate = json.loads((folder / "upper.json").read_text())
    for hole in plate["holes"]:
        hole["stresses"] = False
    (folder / "silent.json").write_text(json.dumps(plate))
    joint = json.loads((folder / "joint.json").read_text())
    joint["plates"]["upper"] = "silent.matrices.h5"
    (folder / "silent.joint.json").write_text(json.dumps(joint))
    subprocess.run(["stage1_plate", "silent.json", "-o", "silent.h5", "--quiet"], check=True, cwd=folder)
    subprocess.run(["stage2_extract", "silent.h5", "-o", "silent.matrices.h5", "--quiet"], check=True, cwd=folder)
    run = subprocess.run(["stage3_nonlinear", "silent.joint.json", "-o", "silent.result.h5"], cwd=folder, check=True, capture_output=True, text=True)
    assert "kt-below-one" not in run.stderr, run.stderr
    with h5py.File(folder / "silent.result.h5") as result:
        rim = result["plates/upper/rim"]
        assert np.all(np.isnan(rim["peak_hoop"][:])) and np.all(np.isinf(rim["peak_error"][:]))


def check_filled(folder):
    """The highest peaks that the limits and the example tell of, by the command that they name."""
    folder = copy_example("lap_joint", folder)
    limits, example = ((ROOT / page).read_text().replace("\n", " ") for page in ("docs/limits.md", "examples/lap_joint/README.md"))
    for words in ([], ["filled"]):
        run = subprocess.run(["make", "-s", *words], cwd=folder, check=True, capture_output=True, text=True)
        peak = max(float(row) for row in re.findall(r"^  (?:upper|lower):\w(?: +[\d.-]+){2} +([\d.-]+)", run.stdout.split("contact ")[0], re.M))
        assert f"{peak:.0f} N/mm²" in limits and f"{peak:.0f} N/mm²" in example, peak
        assert ("[springs-pull]" in run.stderr) == (words != []), run.stderr


def check_loads_only(folder):
    """Without stresses the summary says what it does not know."""
    for plate in ("upper", "lower"):
        subprocess.run(["stage1_plate", folder / f"{plate}.json", "-o", folder / f"{plate}.h5", "--quiet"], check=True)
        subprocess.run(["stage2_extract", folder / f"{plate}.h5", "-o", folder / f"{plate}.matrices.h5", "--quiet", "--loads-only"],
                       check=True)
    run = subprocess.run(["stage3_nonlinear", folder / "joint.json", "-o", folder / "joint.h5"], check=True,
                         capture_output=True, text=True)
    assert run.stdout.count(" is fixed; the reaction is not known without stresses") == 2, run.stdout
    assert "the y displacement of the discs of upper is fixed; the reaction is not known without stresses\n" in run.stdout, run.stdout


def check_free(folder):
    """Discs that move along x and y, and half holes on a line of symmetry, are held by nothing that wants a warning."""
    for name, change in (("plane", lambda scene: scene.update(disc_directions=["x", "y"])), ("half", None)):
        case = folder / name
        case.mkdir()
        joint = json.loads((folder / "joint.json").read_text())
        for plate in ("upper", "lower"):
            scene = json.loads((folder / f"{plate}.json").read_text())
            if change:
                change(scene)
            else:  # one row of rivets on the lower border, where symmetry holds the sheet
                scene["geometry"]["grid"]["y"] = [10, 25]
                scene["holes"] = [hole for hole in scene["holes"] if hole["center"][1] == 10]
                joint["fasteners"] = [each for each in joint["fasteners"] if each["id"] in "ac"]
            (case / f"{plate}.json").write_text(json.dumps(scene))
            subprocess.run(["stage1_plate", case / f"{plate}.json", "-o", case / f"{plate}.h5", "--quiet"], check=True)
            subprocess.run(["stage2_extract", case / f"{plate}.h5", "-o", case / f"{plate}.matrices.h5", "--quiet"], check=True)
        (case / "joint.json").write_text(json.dumps(joint))
        run = subprocess.run(["stage3_nonlinear", case / "joint.json", "-o", case / "joint.h5"], check=True,
                             capture_output=True, text=True)
        assert "[disc-held-across]" not in run.stderr, run.stderr
        assert re.search(r"upper:a .* -$", run.stdout, re.M), run.stdout


def check_warning(folder):
    """Springs on the arc that does not bear are noticed; on the one that does, nothing is said of them."""
    for name, arcs, warned in (("right", {"upper": [90, 270], "lower": [-90, 90]}, False),
                               ("wrong", {"upper": [-90, 90], "lower": [-90, 90]}, True)):
        case = folder / name
        case.mkdir()
        shutil.copy(folder / "joint.json", case)
        for plate, arc in arcs.items():
            scene = json.loads((folder / f"{plate}.json").read_text())
            for hole in scene["holes"]:
                hole["spring"]["arc"] = arc
            (case / f"{plate}.json").write_text(json.dumps(scene))
            subprocess.run(["stage1_plate", case / f"{plate}.json", "-o", case / f"{plate}.h5", "--quiet"], check=True)
            subprocess.run(["stage2_extract", case / f"{plate}.h5", "-o", case / f"{plate}.matrices.h5", "--quiet"], check=True)
        run = subprocess.run(["stage3_nonlinear", case / "joint.json", "-o", case / "joint.h5", "--quiet"], check=True,
                             capture_output=True, text=True)
        assert (re.search(r"\[springs-wrong-arc\]: .*3 other holes too", run.stderr) is not None) == warned, \
            run.stderr
        assert warned or "[disc-held-across]" in run.stderr and len(run.stderr.splitlines()) == 1, run.stderr


def main(bin_folder):
    os.environ["PATH"] = os.path.abspath(bin_folder) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "lap_joint"
        shutil.copytree(ROOT / "tests/pipeline/scenes/lap_joint", folder)
        shutil.copy(ROOT / "examples/lap_joint/Makefile", folder)
        subprocess.run(["make", "-s", "joint.h5"], cwd=folder, check=True, capture_output=True)
        subprocess.run(["stage3_nonlinear", "joint.json", "-o", "joint.h5", "--rim-stresses", "--quiet"], cwd=folder, check=True,
                       capture_output=True)
        with h5py.File(folder / "joint.h5") as result:
            for plate in ("upper", "lower"):
                with h5py.File(folder / f"{plate}.matrices.h5") as matrices:
                    state = result[f"plates/{plate}"]
                    assert list(state["rim/hole"].asstr()) == ["a", "b", "c", "d"]
                    for step in range(len(result["load_factor"])):
                        for i in range(4):
                            check_hole(matrices, state, i, step)
                        check_pressure(matrices, state, step)
            check_csv(folder / "joint.csv", result)
        check_default(folder)
        check_without_peaks(folder)
        check_filled(name)
        check_free(folder)
        check_warning(folder)
        check_loads_only(folder)


if __name__ == "__main__":
    main(*sys.argv[1:])
