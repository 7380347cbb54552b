# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets without fasteners against closed forms and ASTM E399; free bodies against held ones; what is refused. Argument: folder of the programs."""
import csv
import json
import math
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

PROGRAMS = Path(sys.argv[1]).resolve()
FORCE = 250.0


def run(program, *words, status=0):
    done = subprocess.run([PROGRAMS / program, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == status, (done.returncode, done.stderr)
    return done.stdout + done.stderr


def traction(name, edge, direction):
    return {"id": name, "on": edge, "direction": direction, "kind": "traction"}


def sheet(x, y, thickness=1, **more):
    return {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": {"E": 70000, "nu": 0.33}},
            "geometry": {"grid": {"x": x, "y": y, "thickness": thickness}}, **more}


def joint(**more):
    return {"format": "joint", "version": 1, "plates": {"s": "s.m.h5"}, "laws": {}, "fasteners": [], **more}


def load(name, force):
    return {"external": f"s:{name}", "force": force}


def solve(folder, scene, its_joint, *words, status=0):
    """What stage 3 prints; the result is in r.h5."""
    for name, content in (("s", scene), ("j", its_joint)):
        (folder / f"{name}.json").write_text(json.dumps(content))
    run("stage1_plate", folder / "s.json", "-o", folder / "s.h5", "--quiet")
    run("stage2_extract", folder / "s.h5", "-o", folder / "s.m.h5", "--quiet")
    return run("stage3_nonlinear", folder / "j.json", "-o", folder / "r.h5", *words, status=status)


def results(folder, *names):
    with h5py.File(folder / "r.h5") as f:
        return [f[f"plates/s/{name}"][:] for name in names]


def holes(folder):
    """Kirsch: 3 times the far stress in a sheet of 200 radii. Howland 1930 for strips, by the polynomial that handbooks give, good to 0.5 %."""
    howland = lambda r: (2 + 0.284 * (1 - r) - 0.6 * (1 - r) ** 2 + 1.32 * (1 - r) ** 3) / (1 - r)  # over the gross stress, r = d / W
    half = {"supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}], "external": [traction("P", "right", "x")]}
    wide = [0, 2.5, 8, 30, 200]
    for x, y, kt, allowed in ((wide, wide, 3.0, 5e-4), ([0, 2.5, 12.5], [0, 2.5], howland(0.4), 5e-3), ([0, 4, 20], [0, 4], howland(0.25), 5e-3)):
        printed = solve(folder, sheet(x, y, holes=[{"id": "h", "center": [0, 0], "radius": 1}], **half), joint(loads=[load("P", FORCE)]))
        (peak,), (angle,), (bar,) = (values[-1] for values in results(folder, "rim/peak_hoop", "rim/peak_angle", "rim/peak_error"))
        found = peak / (FORCE / y[-1])
        assert abs(found / kt - 1) < allowed and abs(angle - 90) < 0.5 and 0 <= bar < 1e-2 * peak, (y, found, angle, bar)
        assert "joint: 1 plate, 0 fasteners, p = 8\n" in printed and "delta" not in printed, printed


def compact_specimen(folder):
    """ASTM E399, whose polynomial is good to 0.5 % for 0.2 < a / W < 1: a free body, pulled by its pins."""
    W, B = 50.0, 25.0
    for a in (0.45, 0.5, 0.55):
        scene = sheet([-W / 4, W / 4, W], [-0.6 * W, 0, 0.6 * W], B, cracks=[{"id": "c", "from": "left", "at": 0, "length": W / 4 + a * W}],
                      holes=[{"id": name, "center": [0, y], "radius": W / 8} for name, y in (("up", 0.275 * W), ("down", -0.275 * W))],
                      external=[{"id": name, "on": name, "direction": "y", "kind": "bearing"} for name in ("up", "down")])
        printed = solve(folder, scene, joint(loads=[load("up", FORCE), load("down", -FORCE)]))
        assert "s has no support: its loads are in balance" in printed, printed
        exact = FORCE / B / math.sqrt(W) * (2 + a) / (1 - a) ** 1.5 * (0.886 + 4.64 * a - 13.32 * a**2 + 14.72 * a**3 - 5.6 * a**4)
        K_I, K_II = (values[-1, 0] for values in results(folder, "crack/K_I", "crack/K_II"))
        assert abs(K_I / exact - 1) < 5e-3 and abs(K_II) < 1e-6 * K_I, (a, K_I, exact, K_II)


def free_body(folder):
    """Stresses, K and bypass loads are those of the sheet when springs hold it that are a hundred millionth as stiff: forces off the middle, a moment."""
    free = sheet([-70, 20, 70], [-50, 50], 2, holes=[{"id": "h", "center": [-20, 10], "radius": 12}, {"id": "g", "center": [45, -15], "radius": 6}],
                 cracks=[{"from": "hole:h", "angle": 200, "length": 5}],
                 external=[traction("P", "right", "x"), traction("Q", "left", "x"), traction("U", "top", "y"), traction("D", "bottom", "y"),
                           traction("V", "right", "y"), {"id": "M", "on": "left", "kind": "moment"}])
    held = dict(free, points=[{"id": "a", "at": [-70, -50], "stiffness": 1e3}, {"id": "b", "at": [70, -50], "stiffness": 1e3}],
                disc_directions=["x", "y"])
    on_ground = [{"id": each, "between": [f"s:{each}", "ground"], "law": "k"} for each in "ab"]
    names = ("rim/peak_hoop", "rim/peak_angle", "crack/K_I", "crack/K_II", "rim/bypass_load", "rim/net_stress")
    for loads in ([load("P", FORCE), load("Q", -FORCE)], [load("U", 30.0), load("D", -30.0)],
                  [load("V", 40.0), load("D", -40.0), {"external": "s:M", "moment": -40.0 * 70}]):
        solve(folder, free, joint(loads=loads))
        found = results(folder, *names)
        solve(folder, held, dict(joint(loads=loads), laws={"k": {"type": "linear", "k": 1e-3}}, fasteners=on_ground))
        for name, one, other in zip(names, found, results(folder, *names)):
            assert np.allclose(one, other, rtol=1e-6, atol=1e-6 * np.nanmax(abs(other)), equal_nan=True), (name, one, other)


def refused(folder):
    free = sheet([-6, 6], [-5, 5], holes=[{"id": "h", "center": [0, 0], "radius": 1}],
                 external=[traction("P", "right", "x"), traction("Q", "left", "x"), traction("U", "top", "x")])
    said = solve(folder, free, joint(loads=[load("P", 5), load("Q", -4)]), status=2)
    assert '/loads: the loads on "s", which has no support, have a resultant: force (1, 0), moment' in said, said
    said = solve(folder, free, joint(loads=[load("U", 5), load("Q", -5)]), status=2)
    assert "force (0, 0), moment -25" in said, said
    cases = [{"name": name, "loads": [load("P", force), load("Q", -force)]} for name, force in (("one", 1), ("two", -2))]
    solve(folder, free, joint(cases=cases), "--envelope", folder / "e.csv")
    peaks = results(folder, "rim/peak_hoop")[0][:, 0]
    assert 0 < peaks[1] < peaks[0], peaks  # pushed, the largest tension is that of the place with a third of it
    rows = list(csv.DictReader((folder / "e.csv").open()))
    assert any("two" in row.values() for row in rows), rows
    field = folder / "s.h5", "--field", folder / "r.h5", "-o", folder / "f.vtu", "--case"
    assert 'increment 2 of 2 in all, of case "two"' in run("stage2_extract", *field, "two"), "the field of a case"
    said = run("stage2_extract", *field, "three", status=2)
    assert '--case: "three" is no case in' in said and "allowed: one, two" in said, said
    done = run_script("report", folder / "r.h5", "-o", folder / "r.html")
    assert done.returncode == 0 and "Load cases" in (folder / "r.html").read_text(), done


def study(folder):
    """Samples of a sheet alone are linear in the load, and increments at events are the full load."""
    (folder / "study.json").write_text(json.dumps({"format": "study", "version": 1, "variables": [
        {"name": "P", "at": "/loads/0/force", "values": [1.0, 2.0, 5.0]}]}))
    held = sheet([-6, 6], [-5, 5], holes=[{"id": "h", "center": [0, 0], "radius": 1}], supports=[{"on": "left", "fix": ["x", "y"]}],
                 external=[traction("P", "right", "x")])
    solve(folder, held, joint(loads=[load("P", 1.0)], increments="events"))
    (peak,), = results(folder, "rim/peak_hoop")
    run("stage3_nonlinear", folder / "j.json", "--study", folder / "study.json", "-o", folder / "study.h5")
    with h5py.File(folder / "study.h5") as f:
        found = f["samples/peak"][:]
    assert np.allclose(found.ravel(), peak * np.array([1, 2, 5]), rtol=1e-9), (found, peak)


def main():
    for check in (holes, compact_specimen, free_body, refused, study):
        with tempfile.TemporaryDirectory() as name:
            check(Path(name))


if __name__ == "__main__":
    main()
