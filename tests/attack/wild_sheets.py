# SPDX-License-Identifier: GPL-3.0-or-later
"""Random valid PLATE.json: grids and meshes of all kinds that stage1_plate takes, small so that a sheet takes 0.1 s.

All lengths are about those of a joint in mm and N, with the pitch of fasteners 20 and moduli of 1e3 to 1e6. All sheets of a
joint share a Layout, the places and radii of its fasteners and the line of symmetry, so that their holes lie on each other.
"""
import math
from dataclasses import dataclass

import block_mesh

PITCH = 20.0


def power(random, low, high):
    """10 to a power between low and high."""
    return 10 ** random.uniform(low, high)


def chance(random, probability):
    return random.random() < probability


@dataclass
class Layout:
    """What the sheets of a joint share. `x` and `y` are the columns and rows of fasteners, `radius` by (column, row);
    `half`: the first row lies on the line of symmetry y = y[0]; `quarter`: and the first column on x = x[0]."""
    x: list
    y: list
    radius: dict
    directions: list
    half: bool
    quarter: bool
    contact: bool
    expands: bool
    meshes: bool
    p: int

    def fasteners(self):
        return sorted(self.radius)

    def is_on_symmetry(self, at):
        return self.half and at[1] == 0 or self.quarter and at[0] == 0


def random_layout(random):
    n_x, n_y = random.choice([(1, 1), (2, 1), (2, 1), (3, 1), (1, 2), (2, 2)])
    half = chance(random, 0.3)
    quarter = half and n_x > 1 and chance(random, 0.3)
    if not half and chance(random, 0.1):
        n_x, n_y, half, quarter = 2, 2, True, False
    x0, y0 = (0, 0) if chance(random, 0.7) else (random.uniform(-1000, 1000), random.uniform(-1000, 1000))
    x = [x0 + i * PITCH * random.uniform(0.9, 1.1) for i in range(n_x)]
    y = [y0 + j * PITCH * random.uniform(0.9, 1.1) for j in range(n_y)]
    radius = {(i, j): PITCH * random.uniform(0.08, 0.35) for i in range(n_x) for j in range(n_y)}
    directions = random.choice([["x"], ["x", "y"], ["x", "y"]])
    if half and any(j > 0 for _, j in radius) or quarter:
        directions = ["x"]  # half holes keep the direction of their line, and all holes of a joint must have the same
    return Layout(x, y, radius, directions, half, quarter, chance(random, 0.45), chance(random, 0.25),
                  not half and chance(random, 0.3), random.choice([1, 2, 2, 3, 3, 4]))


def random_material(random, layout, plane_strain, E):
    """A material about as stiff as E, with the keys that an analysis wants."""
    expansion = layout.expands and not plane_strain
    if chance(random, 0.65):
        nu = random.choice([0.3, 0.33, random.uniform(-0.5, 0.49), 0.499, 0.0])
        return {"E": E, "nu": nu} | ({"alpha": 2.3e-5} if expansion else {})
    E1, E2 = E * power(random, 0, 0.6), E * power(random, -0.6, 0)
    most = 0.8 * math.sqrt(E1 / E2)
    material = {"E1": E1, "E2": E2, "nu12": random.uniform(0, min(0.4, most)), "G12": E * power(random, -1, -0.3)}
    if chance(random, 0.5):
        material["angle"] = random.choice([0, 90, random.uniform(-90, 90)])
    if plane_strain:
        material |= {"E3": E2, "nu13": material["nu12"], "nu23": random.uniform(0.1, 0.4)}
    elif expansion:
        material |= {"alpha1": 1e-6, "alpha2": 3e-5}
    return material


def random_plies(random, layout, E, thickness):
    """A laminate as thick as the sheet, symmetric or not."""
    n = random.choice([1, 2, 4])
    angles = [random.choice([0, 45, -45, 90, 30]) for _ in range(n)]
    if chance(random, 0.8):
        angles += angles[::-1]
    ply = {"E1": 2 * E, "E2": 0.2 * E, "nu12": 0.3, "G12": 0.1 * E, "angles": angles, "thickness": thickness / len(angles)}
    return {"plies": [ply | ({"alpha1": -9e-7, "alpha2": 2.7e-5} if layout.expands else {})]}


def _lines(random, places, radii, on_symmetry, more_low, more_high, tame):
    """Cell lines of one axis: one between neighbours, one on either end (the first place itself on a line of symmetry), and
    sometimes more in the margins. Gaps between rims and lines may be small, but not less than a tenth of a radius or so;
    those of `tame` ones, which block_mesh.py can mesh, are about alike on both sides."""
    def margin(radius):
        return radius * (1 + random.choice([1, 2] if tame else [0.15, 0.4, 1, 2, 4]) * random.uniform(0.8, 1.2))

    lines = [places[0] if on_symmetry else places[0] - margin(radii[0])]
    for i in range(len(places) - 1):
        free_low, free_high = places[i] + 1.1 * radii[i], places[i + 1] - 1.1 * radii[i + 1]
        share = random.uniform(0.4, 0.6) if tame else random.random()
        lines.append(free_low + share * (free_high - free_low))
    lines.append(places[-1] + margin(radii[-1]))
    if more_low and not on_symmetry:
        lines.insert(0, lines[0] - PITCH * power(random, -1.5, 0.7))
    if more_high:
        lines.append(lines[-1] + PITCH * power(random, -1.5, 0.7))
    return lines


def _spring(random, layout, at, E, thickness, radius, contact):
    ratio = power(random, -3, 3)
    kind = random.choice(["disk", "disk", "disk", "modulus", "links", "arc"])
    law = random.choice(["plane stress", "plane strain", "second harmonic"])
    if contact:
        more = {"compression_only": True} | ({"harmonics": random.choice([4, 4, 8, 8, 16, 32])} if chance(random, 0.9) else {})
        if chance(random, 0.3):
            law = "elastic"
        if kind == "modulus" and law != "elastic":
            return {"modulus": ratio * E / radius} | more
        return {"disk": {"E": ratio * E, "nu": random.uniform(0, 0.45), "law": law}} | more
    if kind == "modulus":
        return {"modulus": ratio * E / radius}
    if kind == "links" and chance(random, 0.5):
        return {"links": ratio * E * thickness}
    spring = {"disk": {"E": ratio * E, "nu": random.uniform(0, 0.45), "law": law}}
    if kind == "arc" and not layout.is_on_symmetry(at) and layout.directions == ["x"]:
        spring["arc"] = random.choice([[-90, 90], [90, 270], [-60, 100]])
    return spring


def _holes(random, layout, E, thickness, left_out):
    holes = []
    for at in layout.fasteners():
        if at in left_out:
            continue
        radius = layout.radius[at] * (1 if chance(random, 0.7) else random.uniform(0.97, 1))
        hole = {"id": f"{at[0]}{at[1]}", "center": [layout.x[at[0]], layout.y[at[1]]], "radius": radius}
        contact = layout.contact and chance(random, 0.8)
        hole["spring"] = _spring(random, layout, at, E, thickness, radius, contact)
        if not layout.meshes and chance(random, 0.3):
            hole["rings"] = random.choice([0, 1, 2]) if not contact else random.choice([1, 2])
        if chance(random, 0.3):
            hole["waves"] = random.choice([4, 5, 6][:max(1, layout.p - 1)])  # no more than the elements follow
        if chance(random, 0.15):
            hole["stresses"] = False
        holes.append(hole)
    return holes


def _supports_and_externals(random, layout, sheet, floats):
    """Edges that hold and that load the sheet. No two of them prescribe the same displacement at a corner."""
    supports, externals = [], []
    if layout.half:
        supports.append({"on": "bottom", "fix": ["y"]})
    if layout.quarter:
        supports.append({"on": "left", "fix": ["x"]})
    n_discs = len(sheet["holes"])
    alone = n_discs == 1 and not layout.half
    if not floats and not layout.quarter:
        supports.append({"on": "left", "fix": ["x"] if layout.half else ["x", "y"]})
    elif alone or n_discs == 0:
        supports.append({"on": "bottom", "fix": ["y"]})
    fixed_y = any("y" in support["fix"] for support in supports)
    right = random.choice(["rigid", "rigid", "traction", "traction", None])
    if right:
        externals.append({"id": "P", "on": "right", "direction": "x", "kind": right})
    if chance(random, 0.3):
        across = random.choice(["rigid", "traction"]) if not fixed_y else "traction"
        externals.append({"id": "Q", "on": random.choice(["right", "top"]), "direction": "y", "kind": across})
    if chance(random, 0.15) and not any(e["on"] == "right" and e["kind"] == "rigid" for e in externals):
        externals.append({"id": "M", "on": "right", "kind": "moment"})
    sheet["supports"], sheet["external"] = supports, externals


def _open_hole(random, layout, sheet, lines_x, lines_y):
    """An open hole in the last cell of the first row, where no fastener is; sometimes a bearing load in it."""
    low_x, high_x, low_y, high_y = lines_x[-2], lines_x[-1], lines_y[0], lines_y[1]
    radius = 0.3 * min(high_x - low_x, high_y - low_y)
    if radius < 0.5 or layout.half:
        return
    sheet["holes"].append({"id": "open", "center": [(low_x + high_x) / 2, (low_y + high_y) / 2], "radius": radius})
    if chance(random, 0.6):
        sheet["external"].append({"id": "B", "on": "open", "direction": random.choice(["x", "y"]), "kind": "bearing"})


def _cracks(random, sheet, lines_x, lines_y, more_high):
    """A crack from a hole inside its cell, or from the upper edge in the cell without holes at the right end."""
    cracks = []
    hole = random.choice(sheet["holes"])
    (x, y), radius = hole["center"], hole["radius"]
    room = min([abs(x - line) for line in lines_x if abs(x - line) > 1e-9] + [abs(y - line) for line in lines_y
                                                                             if abs(y - line) > 1e-9]) - radius
    on_line = any(abs(x - line) < 1e-9 for line in lines_x) or any(abs(y - line) < 1e-9 for line in lines_y)
    spring = hole.get("spring", {})
    if room > 0.5 * radius and "links" not in spring and spring.get("disk", {}).get("law") != "elastic":
        angle = 45 if on_line else random.choice([45, 135, 225, 315])
        cracks.append({"id": "c", "from": "hole:" + hole["id"], "angle": angle, "length": room * random.uniform(0.3, 0.6)})
    if more_high and not any(h["id"] == "open" for h in sheet["holes"]) and chance(random, 0.5):
        width, height = lines_x[-1] - lines_x[-2], lines_y[-1] - lines_y[-2]
        cracks.append({"id": "e", "from": "top", "at": (lines_x[-1] + lines_x[-2]) / 2, "length": 0.5 * min(width, height)})
    sheet["cracks"] = cracks


def random_sheet(random, layout, floats, left_out=()):
    """PLATE.json of a sheet that has holes at all fasteners of the layout but those left out.

    floats: whether supports may leave it to its fasteners, and to the lines of symmetry, along x.
    """
    plane_strain = chance(random, 0.12) and not layout.expands
    E, thickness = 7e4 * power(random, -1, 1), power(random, -0.5, 0.8)
    sheet = {"format": "plate", "version": 1, "units": {"length": "mm", "force": "N"},
             "analysis": "plane strain" if plane_strain else "plane stress"}
    used = [at for at in layout.fasteners() if at not in left_out]
    widest = {axis: [max(layout.radius[at] for at in layout.fasteners() if at[axis] == i)
                     for i in range(len(layout.x if axis == 0 else layout.y))] for axis in (0, 1)}
    more = [chance(random, 0.35) for _ in range(4)]
    lines_x = _lines(random, layout.x, widest[0], layout.quarter, more[0], more[1], layout.meshes)
    lines_y = _lines(random, layout.y, widest[1], layout.half, more[2], more[3], layout.meshes)
    plies = chance(random, 0.15) and not plane_strain
    materials = {"a": random_plies(random, layout, E, thickness) if plies
                 else random_material(random, layout, plane_strain, E)}
    grid = {"x": lines_x, "y": lines_y, "thickness": thickness}
    shape = (len(lines_y) - 1, len(lines_x) - 1)
    if not plies and chance(random, 0.25):
        grid["thickness"] = [[thickness * random.choice([1, 1, 1.5, 0.3]) for _ in range(shape[1])]
                             for _ in range(shape[0])]
    if not plies and not layout.expands and chance(random, 0.2):
        materials["b"] = random_material(random, layout, plane_strain, E * power(random, -1, 1))
        grid["material"] = [[random.choice("ab") for _ in range(shape[1])] for _ in range(shape[0])]
    sheet |= {"materials": materials, "geometry": {"grid": grid}, "disc_directions": layout.directions}
    sheet["holes"] = _holes(random, layout, E, thickness, left_out)
    _supports_and_externals(random, layout, sheet, floats)
    if more[1] and chance(random, 0.4):
        _open_hole(random, layout, sheet, lines_x, lines_y)
    uniform = len(materials) == 1 and not isinstance(grid["thickness"], list)
    if not layout.meshes and uniform and "E" in materials["a"] and chance(random, 0.25) and used:
        _cracks(random, sheet, lines_x, lines_y, more[1])
    if chance(random, 0.08) and not layout.half and not layout.meshes and not sheet.get("cracks"):
        stiffness = E * thickness * power(random, -2, random.choice([2, 2, 10]))  # the stiffest leaves rounding in S
        sheet["points"] = [{"id": "point", "at": [lines_x[-1], lines_y[-1]], "stiffness": stiffness}]
        sheet["external"] = [e for e in sheet["external"] if e["kind"] != "rigid"]
    if chance(random, 0.4):
        sheet["space"] = random.choice(["trunk", "product"])
    sheet["p"] = [max(1, layout.p - random.choice([0, 1, 2])), layout.p]
    return block_mesh.as_mesh(sheet, random) if layout.meshes else sheet
