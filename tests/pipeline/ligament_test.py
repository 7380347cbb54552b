# SPDX-License-Identifier: GPL-3.0-or-later
"""Ligaments that have failed: cuts against a mesh whose edges are cut; a failed row against statics and a sheet that ends there; net areas and margins.

Argument: folder of the programs."""
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

PROGRAMS = Path(sys.argv[1]).resolve()
PITCH, RADIUS, THICKNESS = 20, 2.5, 2
LINES = [PITCH * i for i in range(4)]
NAMES = [f"{row}{column}" for row in range(3) for column in range(3)]
ROW = [{"from": "hole:00", "to": "bottom"}, {"from": "hole:00", "to": "hole:01"}, {"from": "hole:01", "to": "hole:02"}, {"from": "hole:02", "to": "top"}]
PULL = 10000.0


def run(program, *words):
    done = subprocess.run([PROGRAMS / program, *map(str, words)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


def sheet(is_held, contact=False, **more):
    """Three rows of three holes, held on the left or pulled on the right."""
    spring = {"disk": {"E": 1e5, "nu": 0.3}} | ({"compression_only": True} if contact else {})
    ends = {"supports": [{"on": "left", "fix": ["x", "y"]}]} if is_held else {"external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]}
    holes = [{"id": name, "center": [PITCH * (int(name[0]) + 0.5), PITCH * (int(name[1]) + 0.5)], "radius": RADIUS, "spring": dict(spring)} for name in NAMES]
    return {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"al": {"E": 72400, "nu": 0.33}}, "disc_directions": ["x", "y"],
            "geometry": {"grid": {"x": LINES, "y": LINES, "thickness": THICKNESS}}, "holes": holes, **ends, **more}


def matrices(folder, name, scene):
    (folder / f"{name}.json").write_text(json.dumps(scene))
    run("stage1_plate", folder / f"{name}.json", "-o", folder / f"{name}.plate.h5", "--quiet")
    run("stage2_extract", folder / f"{name}.plate.h5", "-o", folder / f"{name}.h5", "--quiet")


def solve(folder, pulled, names=NAMES, words=(), **more):
    """Loads along x and y of each fastener, the error bar of the largest, and what is printed."""
    (folder / "joint.json").write_text(json.dumps({
        "format": "joint", "version": 1, "plates": {"a": "a.h5", "b": f"{pulled}.h5"}, "laws": {"k": {"type": "linear", "k": 3e4}}, "bending": "none",
        "fasteners": [{"id": name, "between": [f"a:{name}", f"b:{name}"], "law": "k"} | more.get(name, {}) for name in names],
        "loads": [{"external": "b:P", "force": PULL}]} | {key: value for key, value in more.items() if key not in NAMES}))
    said = run("stage3_nonlinear", folder / "joint.json", "-o", folder / "result.h5", *words)
    with h5py.File(folder / "result.h5") as f:
        return f["F_vector"][-1].T, np.nanmax(f["F_error"][-1]), said


def meshed(folder, x, y):
    """The scene with the mesh of the uncut sheet, cut along the edges at x up to y."""
    with h5py.File(folder / "whole.plate.h5") as f:
        nodes, quads, arcs, centers = (f[f"mesh/{name}"][:] for name in ("nodes", "quads", "arc_nodes", "arc_center"))
    edges = np.unique(np.sort(np.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)])), axis=0)
    on = lambda axis, at: (nodes[edges, axis] == at).all(axis=1)
    cut = edges[on(0, x) & (nodes[edges, 1] <= y + 1e-9).all(axis=1)]
    scene = sheet(False, cracks=[{"on": "cut"}])
    scene["geometry"] = {"mesh": {"nodes": nodes.tolist(), "quads": quads.tolist(), "thickness": THICKNESS,
                                  "edges": {"right": edges[on(0, LINES[-1])].tolist(), "cut": cut.tolist()},
                                  "arcs": [{"edge": edge, "center": center} for edge, center in zip(arcs.tolist(), centers.tolist())]}}
    return scene


def against_a_cut_mesh(folder):
    matrices(folder, "a", sheet(True))
    matrices(folder, "whole", sheet(False))
    matrices(folder, "cut", sheet(False, cracks=ROW[:1]))
    matrices(folder, "by_hand", meshed(folder, PITCH / 2, PITCH / 2 - RADIUS))
    found, whole, exact = (solve(folder, name)[0] for name in ("cut", "whole", "by_hand"))
    assert abs(found - exact).max() < 1e-6 * abs(exact).max(), (found, exact)
    assert abs(whole - exact).max() > 1e-2 * abs(exact).max(), (whole, exact)


def failed_row(folder):
    """A loose first row whose net section has failed carries nothing; the others share the load as in a sheet that ends there, to the error bar."""
    matrices(folder, "a", sheet(True, True))
    matrices(folder, "cut", sheet(False, True, cracks=ROW))
    end = sheet(False, True)
    end["geometry"]["grid"]["x"] = [PITCH / 2, *LINES[1:]]
    for hole in end["holes"][:3]:
        del hole["spring"]
    matrices(folder, "end", end)
    loose = {name: {"gap": 0.1} for name in NAMES[:3]}
    margins = {"margins": {"checks": [{"check": "tension", "F_tu": 400}]}}
    found, bar, said = solve(folder, "cut", words=["--margins", folder / "margins.csv"], **loose, **margins)
    exact, own, _ = solve(folder, "end", NAMES[3:])
    assert (found[:, :3] == 0).all() and abs(found[0].sum() + PULL) < 1e-9 * PULL and abs(found[1].sum()) < 1e-9 * PULL, found
    assert abs(found[:, 3:] - exact).max() < max(bar + own, 1e-3 * abs(exact).max()), (found, exact, bar)
    assert 'check "tension" is not made for b:00, b:01, b:02: cracks cut its net section through' in said, said
    with (folder / "margins.csv").open() as file:
        checked = {row["of"] for row in csv.DictReader(file)}
    assert not checked & {f"b:{name}" for name in NAMES[:3]} and f"b:{NAMES[3]}" in checked, checked


def net_areas(folder):
    """Hole and cracks take their widths, behind the hole and twice over nothing, and along the load nothing."""
    crack = lambda angle, length: {"from": "hole:00", "angle": angle, "length": length}
    for cracks, taken in (([], 0), ([crack(90, 3)], 3), ([crack(90, 3), crack(-90, 1)], 4), ([crack(0, 3)], 0),
                          ([crack(60, 4)], (RADIUS + 4) * np.sin(np.pi / 3) - RADIUS), ([crack(60, 4), crack(120, 4)], (RADIUS + 4) * np.sin(np.pi / 3) - RADIUS),
                          ([crack(30, 1)], 0), (ROW[:1], PITCH / 2 - RADIUS), (ROW[:2], PITCH - 2 * RADIUS)):
        matrices(folder, "cut", sheet(False, cracks=cracks))
        with h5py.File(folder / "cut.h5") as f:
            across_x = (f["section/hole"].asstr()[:] == "00") & (np.char.endswith(f["section/side"].asstr()[:].astype(str), "x"))
            found = f["section/net_area"][:][across_x]
        assert np.allclose(found, THICKNESS * (PITCH - 2 * RADIUS - taken), atol=1e-9), (cracks, found, taken)


def main():
    for check in (against_a_cut_mesh, failed_row, net_areas):
        with tempfile.TemporaryDirectory() as name:
            check(Path(name))


if __name__ == "__main__":
    main()
