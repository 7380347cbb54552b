# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene in another guise: other units, turned, mirrored, in another order. Its answers must be the same.

A guise has the scene, the factors by which its forces and lengths are larger, and `image`: which displacements of it stand for
one displacement of the original, {key: coefficient}. Keys are (sheet, "disc", hole, axis) and (sheet, "external", id).
"""
import copy
from dataclasses import dataclass, field
from typing import Callable

from wild_joints import Scene


@dataclass
class Guise:
    name: str
    scene: Scene
    force: float = 1.0
    length: float = 1.0
    image: Callable = field(default=lambda key: {key: 1.0})
    sign: float = 1.0  # of all displacements and forces of a result; that of matrices is 1


# Exponents of force and length of the numbers under each key; of a key that means two things, the second by its parent.
STRESS, LENGTH, FORCE, STIFFNESS = (1, -2), (0, 1), (1, 0), (1, -1)
PLATE = {"E": STRESS, "E1": STRESS, "E2": STRESS, "E3": STRESS, "G12": STRESS, "thickness": LENGTH, "x": LENGTH, "y": LENGTH,
         "nodes": LENGTH, "center": LENGTH, "radius": LENGTH, "modulus": (1, -3), "links": STIFFNESS, "at": LENGTH,
         "stiffness": STIFFNESS, "length": LENGTH, "to": LENGTH, "from": LENGTH}
JOINT = {"k": STIFFNESS, "k_yield": STIFFNESS, "k_stick": STIFFNESS, "k_bearing": STIFFNESS, "F": FORCE, "F_yield": FORCE,
         "F_slip": FORCE, "slip": LENGTH, "delta0": LENGTH, "delta": LENGTH, "t": LENGTH, "E": STRESS, "d": LENGTH, "E_f": STRESS,
         "E_z": STRESS, "d_head": LENGTH, "pitch": LENGTH, "row_pitch": LENGTH, "clearance": LENGTH, "gap": LENGTH,
         "force": FORCE, "displacement": LENGTH, "moment": (1, 1), "linear": STIFFNESS, "F_br": STRESS, "F_su": STRESS,
         "limit": STRESS, "offset": LENGTH}
SYSTEMS = {"N/m": (1, 1e-3), "lbf/in": (1 / 4.4482216152605, 1 / 25.4), "kN/m": (1e-3, 1e-3), "N/um": (1, 1e3),
           "MN/mm": (1e-6, 1)}


def _scaled(value, exponents, force, length, key=None):
    """All numbers under known keys times their factors. Names stay, and what is given by the names of sheets."""
    if key in ("temperatures", "friction"):
        return value
    if isinstance(value, dict):
        inner = {name: _scaled(item, exponents, force, length, key if key == "offset" else name)
                 for name, item in value.items()}
        if value.get("type") == "power":
            inner["A"] = value["A"] * force / length ** value["n"]
        return inner
    if isinstance(value, list):
        return [_scaled(item, exponents, force, length, key) for item in value]
    if isinstance(value, (int, float)) and not isinstance(value, bool) and key in exponents:
        of_force, of_length = exponents[key]
        return value * force ** of_force * length ** of_length
    return value


def in_units(scene, system):
    """The scene in another system of units. Labels of units are left out."""
    force, length = SYSTEMS[system]
    plates = {name: _scaled(plate | {"units": None}, PLATE, force, length) for name, plate in scene.plates.items()}
    joint = _scaled(scene.joint | {"units": None}, JOINT, force, length)
    for text in [joint, *plates.values()]:
        del text["units"]
    return Guise("units " + system, Scene(plates, joint), force, length)


@dataclass
class Motion:
    """What turns or mirrors a plane: the images of x and y as (axis, sign), the angle that is added, whether it mirrors, and
    what becomes of the sides of a grid."""
    name: str
    axis: dict
    turn: float
    mirrors: bool
    side: dict

    def point(self, p):
        result = [0.0, 0.0]
        for value, axis in zip(p, "xy"):
            to, sign = self.axis[axis]
            result["xy".index(to)] = sign * value + 0.0
        return result

    def angle(self, a):
        return self.turn - a if self.mirrors else self.turn + a

    def material_angle(self, a):
        return -a if self.mirrors else a + self.turn

    def arc(self, arc):
        a = sorted(self.angle(v) for v in arc)
        shift = -360.0 if a[0] >= 180 else 0.0
        return [v + shift for v in a]


QUARTER_TURN = Motion("turned by 90 degrees", {"x": ("y", 1), "y": ("x", -1)}, 90, False,
                      {"left": "bottom", "right": "top", "bottom": "right", "top": "left"})
MIRROR = Motion("mirrored", {"x": ("x", -1), "y": ("y", 1)}, 180, True,
                {"left": "right", "right": "left", "bottom": "bottom", "top": "top"})


def _moved_grid(grid, motion):
    lines = {"x": grid["x"], "y": grid["y"]}
    result = {}
    for axis in "xy":
        to, sign = motion.axis[axis]
        result[to] = list(lines[axis]) if sign > 0 else [-v + 0.0 for v in reversed(lines[axis])]
    for key in ("thickness", "material"):
        table = grid.get(key)
        if isinstance(table, list):
            if motion.mirrors:
                table = [row[::-1] for row in table]
            else:
                table = [[table[j][i] for j in reversed(range(len(table)))] for i in range(len(table[0]))]
        if table is not None:
            result[key] = table
    return result


def _moved_material(material, motion):
    material = copy.deepcopy(material)
    if "E1" in material:
        material["angle"] = motion.material_angle(material.get("angle", 0))
    for ply in material.get("plies", []):
        ply["angles"] = [motion.material_angle(a) for a in ply["angles"]]
    return material


def _moved_crack(crack, motion):
    crack = dict(crack)
    if "angle" in crack:
        crack["angle"] = motion.angle(crack["angle"])
    elif crack["from"] in motion.side:
        along = "y" if crack["from"] in ("left", "right") else "x"
        crack["at"] *= motion.axis[along][1]
        crack["from"] = motion.side[crack["from"]]
    return crack


def _moved_plate(plate, motion):
    plate = copy.deepcopy(plate)
    plate["materials"] = {name: _moved_material(material, motion) for name, material in plate["materials"].items()}
    geometry = plate["geometry"]
    if "grid" in geometry:
        plate["geometry"] = {"grid": _moved_grid(geometry["grid"], motion)}
    else:
        mesh = geometry["mesh"]
        mesh["nodes"] = [motion.point(p) for p in mesh["nodes"]]
        mesh["quads"] = [quad[::-1] if motion.mirrors else quad for quad in mesh["quads"]]
        for arc in mesh["arcs"]:
            arc["center"] = motion.point(arc["center"])
        mesh["edges"] = {motion.side[name]: edges for name, edges in mesh["edges"].items()}
    for hole in plate["holes"]:
        hole["center"] = motion.point(hole["center"])
        if "arc" in hole.get("spring", {}):
            hole["spring"]["arc"] = motion.arc(hole["spring"]["arc"])
    for point in plate.get("points", []):
        point["at"] = motion.point(point["at"])
    plate["disc_directions"] = [motion.axis[axis][0] for axis in plate["disc_directions"]]
    for item in plate["supports"] + plate["external"]:
        item["on"] = motion.side.get(item["on"], item["on"])
        if "fix" in item:
            item["fix"] = [motion.axis[axis][0] for axis in item["fix"]]
        if "direction" in item:
            item["direction"] = motion.axis[item["direction"]][0]
    if plate.get("cracks"):
        plate["cracks"] = [_moved_crack(crack, motion) for crack in plate["cracks"]]
    return plate


def externals(scene):
    """All external boundaries by (sheet, id)."""
    return {(name, each["id"]): each for name, plate in scene.plates.items() for each in plate["external"]}


def moved(scene, motion):
    """The scene turned or mirrored with its loads."""
    of, joint = externals(scene), copy.deepcopy(scene.joint)
    for case in joint.get("cases", [joint]):
        for load in case.get("loads", []):
            external = of[tuple(load["external"].split(":"))]
            sign = (-1 if motion.mirrors else 1) if external["kind"] == "moment" else motion.axis[external["direction"]][1]
            for key in {"force", "displacement", "moment"} & load.keys():
                load[key] *= sign
    for fastener in joint["fasteners"]:
        for plate, offset in fastener.get("offset", {}).items():
            fastener["offset"][plate] = motion.point(offset)

    def image(key):
        if key[1] == "external":
            return {key: motion.axis[of[key[0], key[2]]["direction"]][1]}
        axis, sign = motion.axis[key[3]]
        return {(*key[:3], axis): sign}

    plates = {name: _moved_plate(plate, motion) for name, plate in scene.plates.items()}
    return Guise(motion.name, Scene(plates, joint), image=image)


def _shuffled(random, items):
    items = list(items)
    random.shuffle(items)
    return items


def renumbered(scene, random):
    """Everything in another order, sheets and laws by other names."""
    plates = {"sheet " + name: copy.deepcopy(scene.plates[name]) for name in _shuffled(random, scene.plates)}
    for plate in plates.values():
        for key in ("holes", "external", "supports"):
            plate[key] = _shuffled(random, plate[key])
        plate["materials"] = {name: plate["materials"][name] for name in _shuffled(random, plate["materials"])}

    def hole(text):
        return text if text == "ground" else "sheet " + text

    joint = copy.deepcopy(scene.joint)
    joint["plates"] = {name: f"{name}.matrices.h5" for name in plates}
    joint["laws"] = {"the " + name: joint["laws"][name] for name in _shuffled(random, joint["laws"])}
    joint["fasteners"] = _shuffled(random, joint["fasteners"])
    for fastener in joint["fasteners"]:
        fastener["between"] = [hole(text) for text in fastener["between"]]
        law = fastener["law"]
        fastener["law"] = "the " + law if isinstance(law, str) else ["the " + name for name in law]
        for key in ("friction", "offset"):
            if isinstance(fastener.get(key), dict):
                fastener[key] = {"sheet " + name: value for name, value in fastener[key].items()}
    for case in joint.get("cases", [joint]):
        case["loads"] = _shuffled(random, case.get("loads", []))
        for load in case["loads"]:
            load["external"] = hole(load["external"])
        if "temperatures" in case:
            case["temperatures"] = {"sheet " + name: value for name, value in case["temperatures"].items()}
    return Guise("renumbered", Scene(plates, joint), image=lambda key: {("sheet " + key[0], *key[1:]): 1.0})


def reordered_cases(scene, random):
    joint = copy.deepcopy(scene.joint)
    joint["cases"] = _shuffled(random, joint["cases"])
    return Guise("cases in another order", Scene(scene.plates, joint))


def reversed_loads(scene):
    joint = copy.deepcopy(scene.joint)
    for case in joint.get("cases", [joint]):
        for load in case.get("loads", []):
            for key in {"force", "displacement", "moment"} & load.keys():
                load[key] *= -1
    return Guise("loads reversed", Scene(scene.plates, joint), sign=-1.0)


def halved_increments(scene):
    joint = copy.deepcopy(scene.joint)
    for case in joint.get("cases", [joint]):
        given = case.get("increments", 1)
        if isinstance(given, list):
            case["increments"] = [v for a, b in zip([0.0, *given], given) for v in ((a + b) / 2, b)]
        elif given != "events":
            case["increments"] = 2 * given
    return Guise("increments halved", Scene(scene.plates, joint))
