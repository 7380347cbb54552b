# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/import_mesh: S of Gmsh's mesh is that of the grid, files of other tools give the same sheet, bad meshes are refused by
place and distance: import_mesh_test.py FOLDER_OF_PROGRAMS."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import meshio
import numpy as np
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/support"))
sys.dont_write_bytecode = True
from scripts import run_script  # noqa: E402

DISK = {"E": 71000, "nu": 0.33}
STRIP = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"al": {"E": 72400, "nu": 0.33}},
         "geometry": {"mesh": {"thickness": 1.6}},
         "holes": [{"id": "1", "center": [20, 10], "radius": 3, "spring": {"compression_only": True, "disk": DISK}},
                   {"id": "2", "center": [40, 10], "radius": 3, "spring": {"disk": DISK}}],
         "external": [{"id": end, "on": end, "direction": "x", "kind": "rigid"} for end in ("left", "right")]}
MESH = ROOT / "tests/pipeline/meshes/strip.msh"


def imported(mesh, plate=STRIP, *words):
    """The sheet that import_mesh makes, or what it says against it."""
    Path("plate.json").write_text("// comments as in other input\n" + json.dumps(plate))
    Path("sheet.json").unlink(missing_ok=True)
    done = run_script("import_mesh", mesh, "--plate", "plate.json", "-o", "sheet.json", *words)
    if done.returncode:
        assert done.returncode == 2 and not Path("sheet.json").exists(), done
        return done.stderr
    return json.loads(Path("sheet.json").read_text())


def refused(mesh, *messages, plate=STRIP, words=()):
    said = imported(mesh, plate, *words)
    assert isinstance(said, str) and all(message in said for message in messages), (messages, said)


def matrices(scene, name):
    Path(f"{name}.json").write_text(json.dumps(scene))
    subprocess.run(["stage1_plate", f"{name}.json", "-o", f"{name}.h5", "--quiet"], check=True)
    subprocess.run(["stage2_extract", f"{name}.h5", "-o", f"{name}.matrices.h5", "--quiet"], check=True)
    return h5py.File(f"{name}.matrices.h5")


def check_matrices():
    """S by Gmsh's mesh and by the grid of the same sheet differ by less than their estimated errors, and these are small."""
    with matrices(imported(MESH), "gmsh") as ours, matrices(STRIP | {"geometry": {"grid": {"x": [0, 30, 60], "y": [0, 20], "thickness": 1.6}}}, "grid") as grid:
        for name in ("S_ee", "S_ed", "S_dd"):
            a, b = ours[name][-1], grid[name][-1]
            allowed = ours[f"{name}_error"][:].max() + grid[f"{name}_error"][:].max()
            assert np.abs(a - b).max() < allowed < 1e-5 * np.abs(b).max(), (name, np.abs(a - b).max(), allowed)


def write(mesh, name, points=None, cells=None, **parts):
    """A file of another mesh tool, by meshio. Returns its name."""
    meshio.Mesh(mesh.points if points is None else points, mesh.cells if cells is None else cells, **parts).write(name)
    return name


def quads_of(mesh):
    return next(block.data for block in mesh.cells if block.type == "quad")


def check_formats():
    """The same sheet from Abaqus, Nastran, MED and VTK, with sets where the format has them; clockwise elements and other numbers of nodes."""
    mesh, sheet = meshio.read(MESH), imported(MESH)
    geometry = sheet["geometry"]["mesh"]
    assert len(geometry["arcs"]) == 16 and all(arc["center"] in ([20, 10], [40, 10]) for arc in geometry["arcs"])
    assert {name: len(edges) for name, edges in geometry["edges"].items()} == {"left": 4, "right": 4}
    quads = quads_of(mesh)
    ends = {end: np.flatnonzero(mesh.points[:, 0] == x) for end, x in (("left", 0), ("right", 60))}
    free = STRIP | {"external": []}
    for name in ("sheet.inp", "sheet.bdf", "sheet.med", "sheet.vtk"):
        named = {"cell_sets": {"skin": [np.arange(len(quads))]}, "point_sets": ends} if name == "sheet.inp" else {}
        path = write(mesh, name, cells=[("quad", quads[:, ::-1])], **named)
        plate = STRIP | {"geometry": {"mesh": {"thickness": {"skin": 1.6}}}} if named else free
        other = imported(path, plate)["geometry"]["mesh"]
        for key in ("nodes", "arcs"):
            assert len(other[key]) == len(geometry[key]), (name, key)
        apart, at = cKDTree(geometry["nodes"]).query(other["nodes"])
        assert apart.max() < 1e-4 and len(set(at)) == len(at), (name, apart.max())
        if named:
            assert other["thickness"] == [1.6] * len(quads)
            assert {end: len(edges) for end, edges in other["edges"].items()} == {"left": 4, "right": 4}, other["edges"]
    turned = np.random.default_rng(1).permutation(len(mesh.points))
    points = np.empty_like(mesh.points)
    points[turned] = mesh.points
    with matrices(imported(write(mesh, "turned.vtk", points, [("quad", turned[quads])]), free), "turned") as one, \
         matrices(imported(write(mesh, "same.vtk", cells=[("quad", quads)]), free), "same") as other:
        assert np.allclose(one["S_dd"][-1], other["S_dd"][-1], rtol=0, atol=1e-9 * np.abs(other["S_dd"][-1]).max())


def check_curves():
    """Quadratic elements: the lug's round end and the slot's ends are arcs about their centres, straight edges stay straight."""
    sheet = json.loads((ROOT / "examples/lug/lug.plate.json").read_text())
    geometry = imported(ROOT / "examples/lug/lug.msh", sheet)["geometry"]["mesh"]
    nodes = np.array(geometry["nodes"])
    centers = {}
    for arc in geometry["arcs"]:
        radii = np.hypot(*(nodes[arc["edge"]] - arc["center"]).T)
        assert np.ptp(radii) < 1e-9, arc
        key = tuple(np.round(arc["center"], 6) + 0.0), round(radii[0], 6)
        centers[key] = centers.get(key, 0) + 1
    assert centers == {((15, 0), 4): 8, ((40, 0), 4): 8, ((100, 0), 8): 8, ((100, 0), 20): 6, ((62, 0), 5): 4, ((72, 0), 5): 4}, centers


def check_crack():
    """A named curve inside the sheet is a crack: K of collinear cracks is exact to 1e-6, on elements that know nothing of it."""
    sides = [{"on": side, "fix": ["x"]} for side in ("left", "right")] + [{"on": "bottom", "fix": ["y"]}]
    plate = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": {"E": 1000, "nu": 0.3}}, "geometry": {"mesh": {"thickness": 1}},
             "cracks": [{"id": "c", "on": "slit"}], "supports": sides, "external": [{"id": "P", "on": "top", "direction": "y", "kind": "rigid"}]}
    slit = MESH.with_name("slit.msh")
    with matrices(imported(slit, plate), "slit") as file:
        K = file["crack/K_I"][-1, 0, 0] / file["S_ee"][-1, 0, 0]
    exact = np.sqrt(2 * np.tan(np.pi / 4))
    assert abs(K / exact - 1) < 1e-6, K / exact - 1
    refused(slit, 'has no curve "cut", which plate.json: /cracks/0/on names', plate=plate | {"cracks": [{"on": "cut"}]})


def check_refusals():
    mesh = meshio.read(MESH)
    quads, points = quads_of(mesh), mesh.points
    free = STRIP | {"external": []}

    def moved(node, step):
        changed = points.copy()
        changed[node] += step
        return write(mesh, "moved.vtk", changed, [("quad", quads)])

    on_rim = np.flatnonzero(np.abs(np.hypot(*(points[:, :2] - [20, 10]).T) - 3) < 1e-9)
    on_rim = on_rim[np.isin(on_rim, quads)]
    ray = np.append((points[on_rim[0], :2] - [20, 10]) / 3, 0)
    refused(moved(on_rim[0], 0.01 * ray), 'hole "1": the node at (', "is off its circle by 0.01; allowed: 0.001 of the radius, 0.003 (--tolerance)", plate=free)
    assert imported(moved(on_rim[0], 0.01 * ray), free, "--tolerance", 0.01)["geometry"]["mesh"]["nodes"]
    fine = imported(moved(on_rim[0], 1e-3 * ray), free)["geometry"]["mesh"]
    rim = np.array([fine["nodes"][node] for arc in fine["arcs"] for node in arc["edge"] if arc["center"] == [20, 10]])
    assert np.abs(np.hypot(*(rim - [20, 10]).T) - 3).max() < 1e-12, "moved onto the circle"
    at_rim = np.flatnonzero(np.isin(quads, on_rim).any(axis=1))
    triangles = [("quad", quads[1:]), ("triangle", np.array([quads[0][:3], quads[0][[0, 2, 3]]]))]
    refused(write(mesh, "triangles.vtk", cells=triangles), "has 2 elements that are no quadrilaterals; the first is a triangle about (", "SubdivisionAlgorithm", plate=free)
    refused(write(mesh, "gone.vtk", cells=[("quad", np.delete(quads, at_rim[0], axis=0))]), 'hole "1": its rim covers ', "allowed: 360", plate=free)
    bent = points.copy()
    bent[0, 2] = 0.5
    refused(write(mesh, "bent.vtk", bent, [("quad", quads)]), "its z goes from 0 to 0.5", plate=free)
    inner = next(node for node in np.unique(quads) if (quads == node).sum() == 4)
    neighbour = quads[(quads == inner).any(axis=1)][0]
    refused(moved(inner, 1.5 * (points[neighbour].mean(axis=0) - points[inner])), "is inverted or degenerate: its Jacobian falls to -", plate=free)
    single = quads.copy()
    doubled = np.vstack([points, points[inner]])
    single[np.flatnonzero((quads == inner).any(axis=1))[0]][single[np.flatnonzero((quads == inner).any(axis=1))[0]] == inner] = len(points)
    refused(write(mesh, "doubled.vtk", doubled, [("quad", single)]), "1 pairs of nodes stand at one place, the first at (", plate=free)
    plain = STRIP | {"external": [], "holes": []}
    two = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [2, 1, 0], [4, 0, 0], [4, 1, 0], [4, 2, 0]], float)
    refused(write(mesh, "hanging.vtk", two, [("quad", np.array([[0, 1, 2, 3], [1, 5, 6, 4], [4, 6, 7, 2]]))]),
            "a node hangs at (2, 1) on the edge from (2, 0) to (2, 2)", plate=plain)
    refused(write(mesh, "three.vtk", two, [("quad", np.array([[0, 1, 2, 3], [1, 5, 7, 2], [1, 6, 7, 2]]))]), "3 elements share the edge from (2, 0) to (2, 2)", plate=plain)
    refused(MESH, 'has no curve "top", which plate.json: /external/0/on names; allowed: "left", "right"',
            plate=STRIP | {"external": [STRIP["external"][0] | {"on": "top"}]})
    refused(MESH, 'has no surface "pad", which plate.json: /geometry/mesh/thickness names; allowed: "skin"', plate=STRIP | {"geometry": {"mesh": {"thickness": {"pad": 1}}}})
    far = STRIP | {"holes": [STRIP["holes"][0] | {"center": [30, 10]}]}
    refused(MESH, 'hole "1": no edge of the border is on its circle about (30, 10) with radius 3; the nearest node is off it by ', plate=far)
    refused(MESH, "plate.json: /geometry/mesh: must be an object without nodes and quads", plate=STRIP | {"geometry": {"grid": {}}})
    refused("none.msh", "none.msh: cannot be read: ", plate=free)
    Path("text.msh").write_text("no mesh")
    refused("text.msh", "text.msh: cannot be read: ", plate=free)


def check_remeshed():
    """Where Gmsh is installed, it makes the meshes of the repository from their outlines."""
    if not shutil.which("gmsh"):
        print("gmsh is not installed; its meshes were not made again")
        return
    for outline in (MESH.with_suffix(".geo"), MESH.with_name("slit.geo"), ROOT / "examples/lug/lug.geo"):
        subprocess.run(["gmsh", "-2", "-v", "1", "-format", "msh41", "-o", "again.msh", outline], check=True)
        again, kept = meshio.read("again.msh"), meshio.read(outline.with_suffix(".msh"))
        assert {block.type for block in again.cells} == {block.type for block in kept.cells}
        assert np.isclose(len(again.points), len(kept.points), rtol=0.2), (outline, len(again.points), len(kept.points))


def main(programs):
    os.environ["PATH"] = f"{Path(programs).resolve()}:{os.environ['PATH']}"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        check_formats()
        check_curves()
        check_crack()
        check_refusals()
        check_matrices()
        check_remeshed()
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
