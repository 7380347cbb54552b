# SPDX-License-Identifier: GPL-3.0-or-later
"""Stresses of a joint's states, solved at once, are those by influence rows: joint_stresses_test.py BIN_FOLDER."""
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
QUANTITIES = ("bearing_load", "bearing_load_y", "bearing_stress", "bypass_load", "bypass_error", "peak_hoop", "peak_angle",
              "peak_error", "gross_concentration", "net_concentration")


def run(*words):
    return subprocess.run(words, capture_output=True, text=True)


def done(*words):
    result = run(*words)
    assert result.returncode == 0, result
    return result.stdout


def example(name):
    return json.loads((ROOT / f"{name}.json").read_text())


def make_sheets(scenes, degrees):
    """PLATE.h5 of each sheet, matrices with stresses in every unit case and, in `loads`, without."""
    Path("loads").mkdir(exist_ok=True)
    for name, scene in scenes.items():
        Path(f"{name}.json").write_text(json.dumps(scene))
        done("stage1_plate", f"{name}.json", "-o", f"{name}.h5", "--p", degrees)
        done("stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5")
        done("stage2_extract", f"{name}.h5", "-o", f"loads/{name}.matrices.h5", "--loads-only")


def solve(joint, *options):
    """RESULT.h5 by both kinds of matrices; what stage 3 prints by those without stresses."""
    for folder in (".", "loads"):
        Path(folder, "joint.json").write_text(json.dumps(joint))
        printed = done("stage3_nonlinear", f"{folder}/joint.json", "-o", f"{folder}/result.h5", *options)
    return printed


def add_stresses(joint, options=lambda _: ()):
    """Chained, in place: each run sets one sheet and leaves the others."""
    for name, matrices in joint["plates"].items():
        sheet = matrices.split(".")[0]
        summary = done("stage2_extract", f"{sheet}.h5", "--stresses", "loads/result.h5", "--plate", name, "-o",
                       "loads/result.h5", *options(name))
        check_summary(summary, name)


def check_summary(summary, name):
    with h5py.File("loads/result.h5") as result:
        rim = result[f"plates/{name}/rim"]
        step, hole = np.unravel_index(rim["peak_hoop"][:].argmax(), rim["peak_hoop"].shape)
        unit = rim["peak_hoop"].attrs["unit"]
        told = (f"  largest hoop stress {rim['peak_hoop'][step, hole]:.6g} +- {rim['peak_error'][step, hole]:.1g} {unit} at "
                f"{rim['peak_angle'][step, hole]:.1f} deg of hole \"{rim['hole'].asstr()[hole]}\", increment {step + 1}\n")
        assert told in summary, (told, summary)


def compare(joint, apart=1e-10):
    """All quantities of all holes, relative to the largest of their kind on the sheet."""
    with h5py.File("result.h5") as rows, h5py.File("loads/result.h5") as states:
        for name in joint["plates"]:
            a, b = rows[f"plates/{name}/rim"], states[f"plates/{name}/rim"]
            assert set(a) == set(b) == {"hole", "sections", *QUANTITIES}
            assert (a["hole"][:] == b["hole"][:]).all() and (a["sections"][:] == b["sections"][:]).all() and len(a["hole"])
            for each in QUANTITIES:
                x, y = a[each][:], b[each][:]
                known = np.isfinite(x)
                assert (known == np.isfinite(y)).all(), (name, each)
                x, y = x[known], y[known]
                worst = np.abs(x - y).max(initial=0) / max(np.abs(x).max(initial=0), 1e-300)
                print(f"{name} {each}: {worst:.1e}")
                assert worst <= apart, (name, each, worst)
            assert np.ptp(a["peak_hoop"][:]) > 0 and (a["bypass_load"][:] != 0).any()


def check_kept(before):
    """All else is as stage 3 wrote it."""
    def names(file):
        found = []
        file.visititems(lambda name, each: found.append(name) if isinstance(each, h5py.Dataset) and "/rim/" not in name else None)
        return sorted(found)
    with h5py.File(before) as a, h5py.File("loads/result.h5") as b:
        assert names(a) == names(b) and dict(a.attrs).keys() == dict(b.attrs).keys()
        assert all(str(a.attrs[each]) == str(b.attrs[each]) for each in a.attrs)
        for name in names(a):
            np.testing.assert_array_equal(a[name][()], b[name][()], name)


def check(joint, *options):
    printed = solve(joint, *options)
    for name, matrices in joint["plates"].items():
        assert (f"loads/{matrices} holds no stresses of {name} at p = 5; stage2_extract PLATE.h5 --stresses RESULT.h5 "
                f"-o RESULT.h5 --plate {name} finds them\n") in printed, printed
    before = Path("before.h5")
    before.write_bytes(Path("loads/result.h5").read_bytes())
    with h5py.File(before) as result:
        assert all(len(result[f"plates/{name}/rim/hole"]) == 0 for name in joint["plates"])
    add_stresses(joint)
    compare(joint)
    check_kept(before)


def lap_joint():
    """Discs along x, an open hole, a traction, unlike friction of a fastener's holes."""
    scenes = {name: example(f"tests/pipeline/scenes/lap_joint/{name}") for name in ("upper", "lower")}
    scenes["upper"]["holes"].append({"id": "open", "center": [100, 10], "radius": 3})
    scenes["upper"]["external"].append({"id": "T", "on": "left", "direction": "x", "kind": "traction"})
    joint = example("tests/pipeline/scenes/lap_joint/joint")
    joint["fasteners"][2]["friction"] = {"upper": 0.1, "lower": 0.3}
    joint["loads"].append({"external": "upper:T", "force": -700})
    return scenes, joint


def bolt_group():
    """Discs along x and y, sheets that float, three to a fastener."""
    joint = example("examples/bolt_group/joint")
    for fastener in joint["fasteners"]:
        fastener["friction"] = 0.2
    return {name: example(f"examples/bolt_group/{name}") for name in ("bracket", "web")}, joint


def check_disc_forces():
    """Along one direction bearing and friction of a hole are what its shear plane transfers, with the sign of the side."""
    with h5py.File("loads/result.h5") as result:
        for side, sign in (0, -1), (1, 1):
            for plane, name in enumerate(result[("fastener/first", "fastener/second")[side]].asstr()):
                sheet, hole = name.split(":")
                disc = result[f"plates/{sheet}/disc"]
                at = list(disc["hole"].asstr()).index(hole)
                np.testing.assert_allclose(disc["bearing"][:, at] + disc["friction"][:, at],
                                           sign * result["transferred"][:, plane, side], rtol=1e-12)
                assert disc["friction"][-1, at] != 0


def check_degrees(joint):
    """At a degree below the sheet's highest, rows know no error or nothing at all; a solve has the degree below it."""
    solve(joint, "--p", "4")
    add_stresses(joint)
    with h5py.File("result.h5") as rows, h5py.File("loads/result.h5") as states:
        a, b = rows["plates/upper/rim"], states["plates/upper/rim"]
        assert np.isinf(a["peak_error"][:]).all() and np.isfinite(b["peak_error"][:]).all()
        np.testing.assert_allclose(a["peak_hoop"], b["peak_hoop"], rtol=0, atol=1e-10 * np.abs(a["peak_hoop"][:]).max())
    solve(joint, "--p", "3")
    add_stresses(joint)
    with h5py.File("result.h5") as rows, h5py.File("loads/result.h5") as states:
        assert len(rows["plates/upper/rim/hole"]) == 0 and len(states["plates/upper/rim/hole"]) == 5
        assert np.isinf(states["plates/upper/rim/peak_error"][:]).all()


def check_refusals(joint):
    solve(joint, "--p", "5")
    Path("kept.h5").write_bytes(Path("loads/result.h5").read_bytes())
    done("stage1_plate", "upper.json", "-o", "p4.h5", "--p", "4")
    scene = json.loads(Path("upper.json").read_text())
    scene["geometry"]["grid"]["thickness"] *= 2
    Path("thick.json").write_text(json.dumps(scene))
    done("stage1_plate", "thick.json", "-o", "thick.h5", "--p", "3..5")
    with h5py.File("kept.h5", "r+") as result:
        del result["plates/upper/disc/bearing"]
        for name in ("upper", "lower"):
            result["plate/plate_digest"][...] = ""
    stresses = ("--stresses", "loads/result.h5")
    for status, message, plate, *words in (
            (2, "'middle' is not a sheet of loads/result.h5; allowed: lower, upper", "upper.h5", *stresses, "--plate", "middle"),
            (2, "'lower' of loads/result.h5 is not the sheet of upper.h5: its cases are", "upper.h5", *stresses, "--plate", "lower"),
            (2, "loads/result.h5: sheet 'upper' was made of a PLATE.h5 with the digest ", "thick.h5", *stresses),
            (2, "kept.h5: is of degree p = 5, which p4.h5 does not have; allowed: 4", "p4.h5", "--stresses", "kept.h5"),
            (2, "kept.h5:plates/upper/disc/bearing: is missing; allowed: a file of version 1.5", "upper.h5", "--stresses",
             "kept.h5"),
            (3, "upper.h5: is a 'plate-solution' file, expected 'joint-result'", "upper.h5", "--stresses", "upper.h5"),
            (2, "--stresses: goes neither with --field nor with --loads-only", "upper.h5", *stresses, "--loads-only"),
            (2, "--stresses: goes neither with --field nor with --loads-only", "upper.h5", *stresses, "--field", "loads"),
            (2, "--p: goes with --field only", "upper.h5", *stresses, "--p", "5"),
            (2, "--increment: goes with --field RESULT.h5 only", "upper.h5", *stresses, "--increment", "1"),
            (2, "--timings loads/result.h5: is the file of --stresses", "upper.h5", *stresses, "--timings", "loads/result.h5")):
        before = Path("loads/result.h5").read_bytes()
        result = run("stage2_extract", plate, *words, "-o", "no.h5")
        assert result.returncode == status and message in result.stderr and not Path("no.h5").exists(), (words, result)
        assert Path("loads/result.h5").read_bytes() == before


def check_rows_left_out():
    """Above 512 MB of rows MATRICES.h5 goes without them, and the summary says how to get the stresses of a joint."""
    for n, left_out in (("16", True), ("5", False)):
        Path("panel.json").write_text(done(ROOT / "scripts/make_panel", n, n))
        done("stage1_plate", "panel.json", "-o", "panel.h5", "--p", "1..2")
        summary = done("stage2_extract", "panel.h5", "-o", "panel.matrices.h5")
        assert ("  stresses in every unit case, 680 MB, are left out; those of a joint: stage2_extract panel.h5 --stresses "
                "RESULT.h5 -o RESULT.h5\n" in summary) == left_out, summary
        with h5py.File("panel.matrices.h5") as matrices:
            assert (len(matrices["stress/p"]) == 0) == left_out and len(matrices["rim/hole"]) == int(n)**2


def main(folder):
    os.environ["PATH"] = str(Path(folder).resolve()) + os.pathsep + os.environ["PATH"]
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        scenes, joint = lap_joint()
        make_sheets(scenes, "3..5")
        check(joint)
        check_disc_forces()
        check(joint | {"solver": {"method": "damped newton"}, "increments": 70})  # two blocks of right-hand sides
        check(joint | {"laws": {"rivet": {"type": "linear", "k": 9000}}, "solver": {"method": "exact path"}, "increments": "events"})
        check_degrees(joint)
        check_refusals(joint)
        make_sheets(scenes, "5")
        check(joint)
        scenes, joint = bolt_group()
        make_sheets(scenes, "4..5")
        check(joint)
        check_rows_left_out()
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
