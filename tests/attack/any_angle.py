# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes turned by any angle: of meshes, since grids lie along x and y, with loads that can be turned with them."""
import copy
import math

from guises import Guise, externals
from wild_joints import Scene


def turned(scene, degrees):
    """A scene of meshes whose loads are tractions in pairs along x and y (loads_in_pairs) turned by any angle."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def point(p):
        return [c * p[0] - s * p[1], s * p[0] + c * p[1]]

    plates, joint = copy.deepcopy(scene.plates), copy.deepcopy(scene.joint)
    for plate in plates.values():
        mesh = plate["geometry"]["mesh"]
        mesh["nodes"] = [point(p) for p in mesh["nodes"]]
        for arc in mesh["arcs"]:
            arc["center"] = point(arc["center"])
        for hole in plate["holes"]:
            hole["center"] = point(hole["center"])
        for material in plate["materials"].values():
            if "E1" in material:
                material["angle"] = material.get("angle", 0) + degrees
            for ply in material.get("plies", []):
                ply["angles"] = [a + degrees for a in ply["angles"]]
    for fastener in joint["fasteners"]:
        fastener["offset"] = {plate: point(offset) for plate, offset in fastener.get("offset", {}).items()}
    for case in joint.get("cases", [joint]):
        forces = {load["external"]: load["force"] for load in case["loads"]}
        pairs = {name[:-1] for name in forces}
        case["loads"] = [{"external": name + axis, "force": value} for name in sorted(pairs)
                         for axis, value in zip("xy", point([forces.get(name + "x", 0.0), forces.get(name + "y", 0.0)]))]

    def image(key):
        plus = {"x": {"x": c, "y": s}, "y": {"x": -s, "y": c}}[key[3]]
        return {(*key[:3], axis): value for axis, value in plus.items()}

    return Guise(f"turned by {degrees:.3f} degrees", Scene(plates, joint), image=image)


def loads_in_pairs(scene):
    """The scene with its loads made tractions along x and y on the same edges, and supports that fix both directions, so that
    it can be turned by any angle. None if it has what cannot."""
    scene = copy.deepcopy(scene)
    for plate in scene.plates.values():
        if "mesh" not in plate["geometry"] or plate["disc_directions"] != ["x", "y"] or plate.get("points"):
            return None
        if any("open" == hole["id"] for hole in plate["holes"]):
            return None
        edges = dict.fromkeys(each["on"] for each in plate["external"])
        for support in plate["supports"]:
            support["fix"] = ["x", "y"]
            edges.pop(support["on"], None)
        plate["external"] = [{"id": f"{on} {axis}", "on": on, "direction": axis, "kind": "traction"}
                             for on in edges for axis in "xy"]
    of = externals(scene)
    for fastener in scene.joint["fasteners"]:
        fastener.pop("friction", None)
    for k, case in enumerate(scene.cases()):
        old = [load.get("force", 100.0) for load in case["loads"]] or [100.0]
        case["loads"] = [{"external": f"{name}:{id}", "force": old[i % len(old)]} for i, (name, id) in enumerate(of)]
    return scene if of else None
