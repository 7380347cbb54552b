# SPDX-License-Identifier: GPL-3.0-or-later
"""Plane strain, two materials and unloading through all three programs, on sheets of scenes/lap_joint:
materials_test.py BIN_FOLDER."""
import copy
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py
import numpy as np

EXAMPLE = Path(__file__).resolve().parent / "scenes/lap_joint"
SHEETS = ("upper", "lower")
FACTORS = [0.5, 1, 0.5, 0, -1]


def run(*words):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def solve(name, sheets):
    """S of the sheets, then F and peak hoop stresses of the joint without friction, whose load falls and is reversed."""
    S = {}
    joint = json.loads((EXAMPLE / "joint.json").read_text()) | {"increments": FACTORS}
    for sheet, scene in sheets.items():
        stem = f"{name}.{sheet}"
        Path(f"{stem}.json").write_text(json.dumps(scene))
        run("stage1_plate", f"{stem}.json", "-o", f"{stem}.h5")
        run("stage2_extract", f"{stem}.h5", "-o", f"{stem}.matrices.h5")
        joint["plates"][sheet] = f"{stem}.matrices.h5"
        with h5py.File(f"{stem}.matrices.h5") as f:
            S[sheet] = f["S_dd"][-1]
    for fastener in joint["fasteners"]:
        del fastener["friction"]
    Path(f"{name}.json").write_text(json.dumps(joint))
    run("stage3_nonlinear", f"{name}.json", "-o", f"{name}.h5")
    with h5py.File(f"{name}.h5") as f:
        assert f["load_factor"][:].tolist() == FACTORS, "all increments are there"
        return S, f["F"][:], np.hstack([f[f"plates/{sheet}/rim/peak_hoop"][:] for sheet in SHEETS])


def in_plane_strain(sheets):
    """A plate in plane strain, and the one in plane stress that is the same: E / (1 - nu^2), nu / (1 - nu)."""
    strain, stress = copy.deepcopy(sheets), copy.deepcopy(sheets)
    for scene in strain.values():
        scene["analysis"] = "plane strain"
        for hole in scene["holes"]:
            hole["spring"]["disk"]["law"] = "plane strain"
    for scene in stress.values():
        for solid in [*scene["materials"].values(), *(hole["spring"]["disk"] for hole in scene["holes"])]:
            nu = solid["nu"]
            solid["E"], solid["nu"] = solid["E"] / (1 - nu**2), nu / (1 - nu)
    return strain, stress


def check_plane_strain(sheets, plain):
    strain, stress = (solve(name, scenes) for name, scenes in zip(("strain", "stress"), in_plane_strain(sheets)))
    for sheet in SHEETS:
        assert np.allclose(strain[0][sheet], stress[0][sheet], rtol=1e-10), sheet
        assert np.linalg.norm(strain[0][sheet] - plain[0][sheet]) > 0.01 * np.linalg.norm(plain[0][sheet]), sheet
    largest = np.abs(plain[1]).max()
    assert np.allclose(strain[1], stress[1], rtol=0, atol=1e-8 * largest), strain[1] - stress[1]
    assert np.allclose(strain[2], stress[2], rtol=1e-7, atol=1e-7), strain[2] - stress[2]


def check_two_materials(sheets, plain):
    """What is far stiffer behind the fasteners is a wall there: it neither stretches nor, held below, contracts."""
    hard = copy.deepcopy(sheets)
    grid = hard["upper"]["geometry"]["grid"]
    (name, soft), = hard["upper"]["materials"].items()
    hard["upper"]["materials"]["hard"] = {"E": 1e7 * soft["E"], "nu": 0.2}
    rows, columns = len(grid["y"]) - 1, len(grid["x"]) - 1
    grid["material"] = [[name] * (columns - 1) + ["hard"]] * rows
    wall = copy.deepcopy(sheets)
    wall["upper"]["geometry"]["grid"]["x"].pop()
    wall["upper"]["supports"].append({"on": "right", "fix": ["y"]})
    of_hard, of_wall = solve("hard", hard), solve("wall", wall)
    S, reference = of_hard[0]["upper"], of_wall[0]["upper"]
    assert np.linalg.norm(S - reference) < 1e-5 * np.linalg.norm(reference), S - reference
    assert np.linalg.norm(S - plain[0]["upper"]) > 1e-3 * np.linalg.norm(S), "the material of the last column counts"
    largest = np.abs(plain[1]).max()
    assert np.allclose(of_hard[1], of_wall[1], rtol=0, atol=1e-4 * largest), of_hard[1] - of_wall[1]
    assert np.allclose(of_hard[2], of_wall[2], rtol=1e-3, atol=0.01), of_hard[2] - of_wall[2]


def check_unloading(plain):
    """Laws have no memory, and holes bear on both sides: forces go back the way they came, and change their signs."""
    _, F, peaks = plain
    largest = np.abs(F).max()
    assert np.abs(F[1] / F[0] - 2).max() > 0.02, "the joint is not a linear one"
    for there, back, sign in ((0, 2, 1), (1, 4, -1)):
        assert np.allclose(F[back], sign * F[there], rtol=0, atol=1e-8 * largest), (F[there], F[back])
    assert np.abs(F[3]).max() < 1e-8 * largest, F[3]
    assert np.allclose(peaks[2], peaks[0], rtol=1e-7) and np.abs(peaks[3]).max() < 1e-6 * np.abs(peaks[1]).max()


def turned(angle):
    """Rotation of stresses (x, y, xy) from x and y to axes turned by an angle, radians."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c * c, s * s, 2 * c * s], [s * s, c * c, -2 * c * s], [-c * s, c * s, c * c - s * s]])


def by_plies(groups):
    """Membrane stiffness over the thickness, and free strain per degree, by rotating each ply's compliance."""
    A, held, t = np.zeros((3, 3)), np.zeros(3), 0
    for each in groups:
        compliance = np.array([[1 / each["E1"], -each["nu12"] / each["E1"], 0], [-each["nu12"] / each["E1"], 1 / each["E2"], 0], [0, 0, 1 / each["G12"]]])
        for angle in each["angles"]:
            T = turned(np.radians(angle))
            Q = np.linalg.inv(T.T @ compliance @ T)  # strains turn as the transpose of the inverse
            A += each["thickness"] * Q
            held += each["thickness"] * Q @ T.T @ np.array([each.get("alpha1", 0), each.get("alpha2", 0), 0])
            t += each["thickness"]
    return A / t, np.linalg.solve(A, held), t


def check_laminates(sheets):
    """Stacks of plies against classical laminate theory: quasi-isotropic, angle plies, hybrids; what is warned of and refused."""
    carbon = {"E1": 140e3, "E2": 10e3, "nu12": 0.3, "G12": 5e3, "thickness": 0.125, "alpha1": -0.9e-6, "alpha2": 27e-6}
    glass = {"E1": 45e3, "E2": 12e3, "nu12": 0.25, "G12": 4.5e3, "thickness": 0.2, "alpha1": 6e-6, "alpha2": 30e-6}
    quasi = [0, 45, -45, 90]
    def solved(groups, thickness=None, status=0, **more):
        _, _, t = by_plies(groups)
        scene = {"format": "plate", "version": 1, "analysis": "plane stress", "p": 1, "materials": {"stack": {"plies": groups}},
                 "geometry": {"grid": {"x": [0, 1], "y": [0, 1], "thickness": thickness or t}}, "supports": [{"on": "left", "fix": ["x", "y"]}],
                 "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}]} | more
        Path("stack.json").write_text(json.dumps(scene))
        done = subprocess.run(["stage1_plate", "stack.json", "-o", "stack.h5"], capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        return done.stderr
    for groups in ([carbon | {"angles": quasi + quasi[::-1]}], [carbon | {"angles": [30, -60, -60, 30]}],
                   [glass | {"angles": [0]}, carbon | {"angles": [20, 20]}, glass | {"angles": [0]}]):
        assert "laminate-couples" not in solved(groups)
        elasticity, strain, _ = by_plies(groups)
        with h5py.File("stack.h5") as f:
            assert np.allclose(f["elasticity"][0], elasticity, rtol=1e-12, atol=1e-9 * elasticity.max()), (f["elasticity"][0], elasticity)
            assert np.allclose(f["expansion"][:], [strain[0], strain[1], strain[2] / 2], rtol=1e-10, atol=1e-18), (f["expansion"][:], strain)
    elasticity, strain, t = by_plies([carbon | {"angles": quasi}])
    assert np.isclose(elasticity[0, 0], elasticity[1, 1]) and np.isclose(2 * elasticity[2, 2], elasticity[0, 0] - elasticity[0, 1]), "quasi-isotropic"
    assert "[laminate-couples]" in solved([carbon | {"angles": quasi}]) and '"stack" is not symmetric' in solved([carbon | {"angles": quasi}])
    plain = {key: value for key, value in carbon.items() if key[:5] != "alpha"}
    solved([plain | {"angles": [0]}, carbon | {"angles": [0]}])
    with h5py.File("stack.h5") as f:
        assert len(f["expansion"]) == 0, "not known of one ply"
    assert "/geometry: the thickness 1 of the material" in solved([carbon | {"angles": quasi}], thickness=1.0, status=2)
    assert "negative strain energy" in solved([carbon | {"angles": [0], "nu12": 5}], status=2)
    assert "a laminate in plane strain" in solved([carbon | {"angles": [0]}], status=2, analysis="plane strain")


def check_ply_strains():
    """An open hole in a wide quasi-isotropic sheet: fibres across the hole's side have the strain of the peak, those at 45 degrees and across follow."""
    carbon = {"E1": 140e3, "E2": 10e3, "nu12": 0.3, "G12": 5e3, "thickness": 0.125, "angles": [0, 45, -45, 90, 90, -45, 45, 0]}
    lines = [-200, -60, -20, 20, 60, 200]
    scene = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"q": {"plies": [carbon]}}, "p": [6, 7],
             "geometry": {"grid": {"x": lines, "y": lines, "thickness": 1}}, "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}],
             "holes": [{"id": "open", "center": [0, 0], "radius": 3}, {"id": "1", "center": [-130, 0], "radius": 3, "spring": {"modulus": 1e4}}],
             "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}]}
    Path("wide.json").write_text(json.dumps(scene))
    run("stage1_plate", "wide.json", "-o", "wide.plate.h5")
    run("stage2_extract", "wide.plate.h5", "-o", "wide.h5")
    joint = {"format": "joint", "version": 1, "plates": {"s": "wide.h5"}, "laws": {"k": {"type": "linear", "k": 1.0}},
             "fasteners": [{"id": "1", "between": ["s:1", "ground"], "law": "k"}], "loads": [{"external": "s:T", "force": 40000}]}
    Path("wide_joint.json").write_text(json.dumps(joint))
    run("stage3_nonlinear", "wide_joint.json", "-o", "result.h5", "--rim-stresses")
    script = Path(__file__).resolve().parents[2] / "scripts/ply_strains"
    printed = subprocess.run([script, "wide_joint.json", "result.h5", "s:open"], capture_output=True, text=True, check=True).stdout
    found = {tuple(line.split()[2:5:2]): [float(word) for word in line.split()[5:]] for line in printed.splitlines()[2:]}
    elasticity, _, _ = by_plies([carbon])
    compliance = np.linalg.inv(elasticity)
    E, nu = 1 / compliance[0, 0], -compliance[0, 1] / compliance[0, 0]
    with h5py.File("result.h5") as f:
        peak = f["plates/s/rim/peak_hoop"][-1][list(f["plates/s/rim/hole"].asstr()).index("open")]
    assert abs(peak / 300 - 1) < 0.01, peak
    strain = peak / E
    assert np.isclose(found["0", "1"][0], strain, rtol=1e-4) and abs(abs(found["0", "1"][1]) - 90) < 1.5, (found, strain)
    # There the strain along y is -nu of it, so a ply at 45 degrees sees the mean along both its axes and all of it in shear.
    assert np.isclose(found["45", "12"][0], strain * (1 + nu), rtol=1e-4), (found["45", "12"], strain * (1 + nu))
    assert np.isclose(found["90", "2"][0], strain, rtol=1e-4)
    for words, message in ((["wide_joint.json", "result.h5", "s:none"], "no hole s:none"), (["wide_joint.json", "result.h5", "t:open"], "no plate t"),
                           (["wide_joint.json", "result.h5", "s:open", "--increment", "9"], "allowed: 1 to 1")):
        done = subprocess.run([script, *words], capture_output=True, text=True)
        assert done.returncode == 2 and message in done.stderr, done.stderr


def main(folder):
    os.environ["PATH"] = os.path.abspath(folder) + os.pathsep + os.environ["PATH"]
    sheets = {sheet: json.loads((EXAMPLE / f"{sheet}.json").read_text()) for sheet in SHEETS}
    with tempfile.TemporaryDirectory() as work:
        os.chdir(work)
        plain = solve("plain", sheets)
        check_unloading(plain)
        check_plane_strain(sheets, plain)
        check_two_materials(sheets, plain)
        check_laminates(sheets)
        check_ply_strains()
        os.chdir("/")


if __name__ == "__main__":
    main(*sys.argv[1:])
