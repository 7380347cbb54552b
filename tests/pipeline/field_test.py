# SPDX-License-Identifier: GPL-3.0-or-later
"""From a solved joint to a picture of its stresses: field_test.py BIN_FOLDER. Files are read as VTK and users would."""
import json
import os
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import h5py
import meshio
import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scripts/python"), str(ROOT / "tests/support")]
sys.dont_write_bytecode = True
import stress_field  # noqa: E402
from scripts import run_script  # noqa: E402
DRAW = str(ROOT / "scripts/draw/draw_stress")
EXAMPLE = ROOT / "examples/three_fasteners"


def run(program, *words):
    if program == DRAW:
        return run_script("draw/draw_stress", *words)
    return subprocess.run([program, *words], capture_output=True, text=True)


def done(*words):
    result = run(*words)
    assert result.returncode == 0, result.stderr
    return result.stdout


def load_script():
    loader = SourceFileLoader("draw_stress", DRAW)
    module = module_from_spec(spec_from_loader("draw_stress", loader))
    loader.exec_module(module)
    return module


def make_joint():
    for name in ("center", "doubler"):
        done("stage1_plate", str(EXAMPLE / f"{name}.json"), "-o", f"{name}.h5", "--p", "7..8")
        os.makedirs("out", exist_ok=True)
        done("stage2_extract", f"{name}.h5", "-o", f"out/{name}.matrices.h5")
    Path("joint.json").write_text((EXAMPLE / "joint.json").read_text())
    done("stage3_nonlinear", "joint.json", "-o", "joint.h5")


def check_grid(path, p, n_cells):
    """Well-formed, every array as long as points and cells want it, every cell of type 70 with its own nodes."""
    root = xml.etree.ElementTree.parse(path).getroot()
    piece = root.find("UnstructuredGrid/Piece")
    n_nodes = (p + 1) ** 2
    n_points = int(piece.get("NumberOfPoints"))
    assert int(piece.get("NumberOfCells")) == n_cells and n_points == n_cells * n_nodes
    names = [a.get("Name") for a in piece.findall("PointData/DataArray")]
    assert names == ["displacement", "stress_xx", "stress_yy", "stress_xy", "von_mises", "principal_1", "principal_2"]
    for array in piece.findall("PointData/DataArray") + piece.findall("Points/DataArray"):
        values = np.array(array.text.split(), dtype=float)
        assert len(values) == n_points * int(array.get("NumberOfComponents")) and np.isfinite(values).all()
    cells = {a.get("Name"): np.array(a.text.split(), dtype=int) for a in piece.findall("Cells/DataArray")}
    assert (cells["connectivity"] == np.arange(n_points)).all()
    assert (cells["offsets"] == n_nodes * np.arange(1, n_cells + 1)).all()
    assert (cells["types"] == 70).all() and len(cells["types"]) == n_cells
    thickness = piece.find("CellData/DataArray")
    assert thickness.get("Name") == "thickness" and len(thickness.text.split()) == n_cells


def check_against_rims(field, plate, joint):
    """Hoop stress where a rim meets x: near that which stage 2 extracts in another way and stage 3 superposes."""
    with h5py.File(joint) as f:
        rim = f[f"plates/{plate}/rim"]
        holes, peaks = rim["hole"].asstr()[:], rim["peak_hoop"][-1]
    nodes = field.points["points"][..., :2].reshape(-1, 2)
    x, y, xy = (field.points[f"stress_{c}"].ravel() for c in ("xx", "yy", "xy"))
    for hole, peak in zip(holes, peaks):
        r = nodes - field.holes()[hole]
        on_rim = np.abs(np.hypot(*r.T) - 0.15) < 1e-7
        c, s = (r[on_rim] / 0.15).T
        hoop = s**2 * x[on_rim] + c**2 * y[on_rim] - 2 * c * s * xy[on_rim]
        assert abs(hoop.max() / peak - 1) < 0.01, (hole, hoop.max(), peak)


def check_refinement():
    """The fine patch reproduces a polynomial of the cell's degree."""
    p = 5
    refine, triangles = stress_field.fine_patch((p + 1) ** 2)
    n = int(np.sqrt(len(refine)))
    eta, xi = (a.ravel() for a in np.meshgrid(*2 * [np.linspace(-1, 1, n)], indexing="ij"))
    u, v = stress_field.lagrange_nodes(p).T
    assert np.abs(refine @ (u**5 * v**4 - v**5) - (xi**5 * eta**4 - eta**5)).max() < 1e-12
    a, b, c = (np.column_stack([xi, eta])[triangles[:, i]] for i in range(3))
    area = np.cross(b - a, c - a) / 2
    assert (area > 0).all() and abs(area.sum() - 4) < 1e-12


def check_provenance():
    """Another sheet with the same names is refused, by its digest: of --field as of a joint that names the digest."""
    scene = (EXAMPLE / "center.json").read_text()
    Path("other.json").write_text(scene.replace("0.005", "0.006"))
    assert Path("other.json").read_text() != scene
    done("stage1_plate", "other.json", "-o", "other.h5", "--p", "7..8")
    result = run("stage2_extract", "other.h5", "--field", "joint.h5", "-o", "no.vtu")
    assert result.returncode == 2 and not Path("no.vtu").exists(), result
    with h5py.File("joint.h5") as joint, h5py.File("out/center.matrices.h5") as matrices:
        names = list(joint["plate/name"].asstr())
        of_plate = joint["plate/plate_digest"].asstr()[names.index("center")]
        of_matrices = joint["plate/matrices_digest"].asstr()[names.index("center")]
        assert matrices.attrs["plate_digest"] == of_plate
    for path, digest in ("center.h5", of_plate), ("out/center.matrices.h5", of_matrices):
        assert Path(path).read_bytes()[-17:-1].decode() == digest, (path, digest)
    other = Path("other.h5").read_bytes()[-17:-1].decode()
    assert (f"joint.h5: sheet 'center' was made of a PLATE.h5 with the digest {of_plate}, other.h5 has {other}; "
            "allowed: the file that it was made of, or stage2_extract and stage3_nonlinear run again") in result.stderr, result
    summary = done("stage2_extract", "other.h5", "-o", "out/other.matrices.h5")
    printed = re.search(r"^  digest ([0-9a-f]{16})$", summary, re.MULTILINE)[1]
    joint = json.loads(Path("joint.json").read_text())
    for file, digest, status in (("center", of_matrices, 0), ("other", printed, 0), ("other", of_matrices, 2)):
        joint["plates"]["center"] = {"file": f"out/{file}.matrices.h5", "digest": digest}
        Path("named.json").write_text(json.dumps(joint))
        result = run("stage3_nonlinear", "named.json", "-o", "named.h5")
        assert result.returncode == status, result
    assert (f"named.json: /plates/center/digest: out/other.matrices.h5 has {printed}, not the digest {of_matrices}; allowed:"
            in result.stderr), result
    with h5py.File("out/other.matrices.h5", "r+") as edited:  # and so has no digest
        edited["S_dd"][-1] *= 1
    result = run("stage3_nonlinear", "named.json", "-o", "named.h5")
    assert result.returncode == 2 and "out/other.matrices.h5 has none, not the digest" in result.stderr, result
    del joint["plates"]["center"]["digest"]
    Path("named.json").write_text(json.dumps(joint))
    done("stage3_nonlinear", "named.json", "-o", "named.h5")
    done("stage2_extract", "other.h5", "--field", "named.h5", "-o", "named.vtu")


def check_meshio():
    """What others read, among them text as the codes of its bytes."""
    mesh = meshio.read("center.vtu")
    (cells,) = mesh.cells
    assert cells.type == "VTK_LAGRANGE_QUADRILATERAL" and cells.data.shape == (25, 81), cells
    assert mesh.points.shape == (25 * 81, 3) and mesh.point_data["displacement"].shape == (25 * 81, 3)
    words = bytes(mesh.field_data["stress_unit"]).decode()
    assert words == "lbf/in^2\0", words
    corners = mesh.points[cells.data[:, :4]]  # counter-clockwise, whatever else is in between
    sides = np.roll(corners, -1, axis=1) - corners
    assert (np.cross(sides[:, 0, :2], sides[:, 1, :2]) > 0).all()


def check_pictures():
    for i in range(2):
        done(DRAW, "center.vtu", "doubler.vtu", "--joint", "joint.h5", "-o", f"{i}.png")
    assert Path("0.png").read_bytes() == Path("1.png").read_bytes()
    done(DRAW, "center.vtu", "--quantity", "stress_xy", "-o", "xy.png")
    done(DRAW, "center.vtu", "doubler.vtu", "-o", "bare.png")
    assert len({Path(f"{name}.png").read_bytes() for name in ("0", "xy", "bare")}) == 3
    done("stage2_extract", "center.h5", "--field", "external:P", "-o", "unit.vtu")
    done(DRAW, "unit.vtu", "-o", "unit.png")


def check_arrows(script):
    """Forces of a file that holds nothing else, by the increment of the field unless another is asked for: friction included,
    those of two shear planes added up."""
    field = script.Field("center.vtu")
    with h5py.File("hand_made.h5", "w") as f:
        f["direction"] = ["x", "y"]
        f["fastener/id"] = ["1", "3", "3"]
        f["fastener/first"] = ["center:1", "other:3", "center:3"]
        f["fastener/second"] = ["other:1", "center:3", "ground"]
        f["F"] = [[1.0, 2, 0], [5, 2, 0], [5, 0, 1]]
        f["F"].attrs["unit"] = "lbf"
        f["F_vector"] = [[[1.0, 0], [2, 0], [0, 0]], [[3, 4], [0, -2], [0, 0]], [[5, 0], [0, 0], [1, 0]]]
        f["transferred"] = 1.1 * np.repeat(f["F"][:][:, :, None], 2, axis=2)
        f["plates/center/rim/hole"] = ["1", "3"]
        f["plates/center/rim/bearing_load"] = np.zeros((3, 2))
        f["plates/center/rim/peak_hoop"] = [[2.0, 1], [3, 4], [6, 5]]
        f["plates/center/rim/peak_angle"] = [[90.0, 0], [0, 180], [90, 0]]

        def drawn(increment):
            forces, unit = script.fastener_forces(field, f, increment)
            return {hole: tuple(np.round(force, 12)) for hole, force in forces.items()}, unit

        assert drawn(None) == ({"1": (-5.5, 0), "3": (-1.1, 0)}, "lbf"), drawn(None)
        assert drawn(2) == ({"1": (-3.3, -4.4), "3": (0, -2.2)}, "lbf"), drawn(2)
        assert script.highest_peak(field, f, 2) == (4, "3", np.pi) and script.highest_peak(field, f, None)[:2] == (6, "1")
    assert {hole: tuple(c) for hole, c in field.holes().items()} == {"1": (2.3, 0), "2": (1.3, 0), "3": (0.3, 0)}
    done(DRAW, "center.vtu", "--joint", "hand_made.h5", "--increment", "2", "-o", "hand_made.png")


def check_edges(script):
    """The load and what holds the sheet are found at their edges, symmetry's force across them; corners do not rule colours."""
    fine = script.FineField(script.Field("center.vtu"), "von_mises")
    forces = {tuple(normal): force for _, normal, force in fine.edge_forces()}
    with h5py.File("joint.h5") as joint:
        P, transferred = joint["plates/center/Pe"][-1, 0], joint["transferred"][-1, :, 0].sum()
    assert np.isclose(forces[1, 0][0], P, rtol=2e-3) and np.isclose(forces[-1, 0][0], transferred - P, rtol=2e-3), forces
    assert abs(forces[0, -1][1]) > 0.1 * P and abs(forces[0, 1][1]) < 1e-3 * P, forces
    field = script.Field("center.vtu")
    far = np.hypot(*(fine.mesh.x - 2.3, fine.mesh.y)) > 0.5
    fine.values[np.flatnonzero(far & (fine.mesh.x > 2.9))[0]] = 1e9
    scale, extend = script.color_scale([field], [fine], "von_mises")
    assert scale["vmax"] < 1e8 and extend == "max", (scale, extend)


def check_messages():
    for message, *words in (
            ("unit.vtu: is not the state of a joint", "unit.vtu", "--joint", "joint.h5"),
            ("joint.json: cannot be read as a file of stage2_extract --field", "joint.json"),
            ("none.vtu: cannot be read as a file of stage2_extract --field", "none.vtu"),
            ("none.h5: cannot be read", "center.vtu", "--joint", "none.h5"),
            ("center.h5:plates/center/rim: is missing", "center.vtu", "--joint", "center.h5"),
            ("joint.h5: has no increment 4; allowed: 1..3", "center.vtu", "--joint", "joint.h5", "--increment", "4"),
            ("--increment goes with --joint", "center.vtu", "--increment", "1")):
        result = run(DRAW, *words, "-o", "no.png")
        assert result.returncode != 0 and message in result.stderr, (words, result.stderr)
    joint = ("--field", "joint.h5")
    for status, message, *words in (
            (2, "'external:Q' is not a case of the plate", "--field", "external:Q"),
            (2, "--increment: 4 is not allowed; joint.h5 has the increments 1..3", *joint, "--increment", "4"),
            (2, "--p: '9' is not allowed", *joint, "--p", "9"),
            (2, "--plate: 'doubler' of joint.h5 is not the sheet of center.h5", *joint, "--plate", "doubler"),
            (2, "--p: goes with --field only", "--p", "8"),
            (3, "center.h5: is a 'plate-solution' file, expected 'joint-result'", "--field", "center.h5"),
            (3, "none.h5: cannot be opened", "--field", "none.h5")):
        result = run("stage2_extract", "center.h5", *words, "-o", "no.vtu")
        assert result.returncode == status and message in result.stderr, (words, result.stderr)
    assert not Path("no.png").exists() and not Path("no.vtu").exists()


def main(folder):
    os.environ["PATH"] = str(Path(folder).resolve()) + os.pathsep + os.environ["PATH"]
    script = load_script()
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        make_joint()
        for plate, n_cells in (("center", 25), ("doubler", 24)):
            summary = done("stage2_extract", f"{plate}.h5", "--field", "joint.h5", "-o", f"{plate}.vtu")
            assert f"{n_cells} cells of degree 8" in summary and "increment 3 of 3" in summary, summary
            check_grid(f"{plate}.vtu", 8, n_cells)
            check_against_rims(script.Field(f"{plate}.vtu"), plate, "joint.h5")
        assert done("stage2_extract", "center.h5", "--field", "external:P", "--p", "7", "-o", "p7.vtu", "--quiet") == ""
        check_grid("p7.vtu", 7, 25)
        check_refinement()
        check_meshio()
        check_pictures()
        check_arrows(script)
        check_edges(script)
        check_messages()
        check_provenance()
        os.chdir(ROOT)


if __name__ == "__main__":
    main(*sys.argv[1:])
