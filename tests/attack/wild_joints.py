# SPDX-License-Identifier: GPL-3.0-or-later
"""Random valid JOINT.json over one to four sheets of a common layout (wild_sheets.py).

Stiffnesses and lengths are drawn about those of the sheets: a law about E t, a gap about the stretch F / (E t) of the load,
each up to many orders of magnitude off, so that scenes are wild but have a solution.
"""
from dataclasses import dataclass

from wild_sheets import chance, power, random_layout, random_sheet

FORMULAS = ["huth bolt", "huth rivet", "huth composite", "swift", "boeing", "grumman", "tate-rosenfeld", "morris"]


@dataclass
class Scene:
    """PLATE.json by the name of the sheet, and JOINT.json, which refers to NAME.matrices.h5."""
    plates: dict
    joint: dict

    def holes(self):
        """All holes and points with springs, by "plate:hole"."""
        return {f"{name}:{hole['id']}": hole for name, plate in self.plates.items()
                for hole in plate["holes"] + plate.get("points", []) if "spring" in hole or "at" in hole}

    def cases(self):
        return self.joint.get("cases", [self.joint])


def is_contact(hole):
    return hole.get("spring", {}).get("compression_only", False)


def thickness_of(plate):
    geometry = plate["geometry"].get("grid") or plate["geometry"]["mesh"]
    value = geometry["thickness"]
    while isinstance(value, list):
        value = value[0]
    return value


def modulus_of(plate):
    material = next(iter(plate["materials"].values()))
    material = material["plies"][0] if "plies" in material else material
    return material.get("E", material.get("E1"))


def remembers(law):
    return law["type"] in ("bilinear", "four stage") and not law.get("reversible") or "F_yield" in law and law["type"] == "table"


def random_law(random, one_direction, k, F, radius):
    """A law whose stiffness is about k and whose corners are about the force F."""
    k, F = k * power(random, -2, 1.5), F * power(random, -1, 1)
    kind = random.choice(["linear", "linear", "power", "bilinear", "four stage", "table", "cubic", "formula", "rigid"])
    law = {"type": kind}
    if kind == "linear":
        law |= {"k": k}
    elif kind == "power":
        n = random.choice([0.4, 0.7, 1, random.uniform(0.3, 1)])
        law |= {"A": F / (F / k) ** n, "n": n} | ({"delta0": F / k * power(random, -3, 0)} if chance(random, 0.3) else {})
    elif kind == "bilinear":
        law |= {"k": k, "F_yield": F, "k_yield": k * random.choice([0.01, 0.1, 0.5, 1.0])}
    elif kind == "four stage":
        law |= {"k_stick": k * power(random, 0, 1), "F_slip": 0.2 * F, "slip": F / k * random.choice([0, 0.1, 1]),
                "k_bearing": k, "F_yield": F, "k_yield": k * random.choice([0.01, 0.1])}
    elif kind == "table":
        n = random.randint(2, 5)
        at = [(i + 1) / n * F / k for i in range(n)]
        law |= {"delta": at, "F": [F * (d * k / F) ** random.uniform(0.5, 0.6) for d in at]}
        law["F"].sort()
        if chance(random, 0.3):
            law["F_yield"] = 0.6 * law["F"][-1]
    elif kind == "cubic":
        top = random.choice([1.0, 1.2, 1.5, 0.8])
        law |= {"delta": [F / k, 2 * F / k, 3 * F / k], "F": [5 * F, 7 * F, 7 * F * top]}
    elif kind == "formula":
        law |= {"formula": random.choice(FORMULAS), "mode": random.choice(["total", "fastener only"]), "shear": "single",
                "t": [2, 3], "E": [7e4, 7e4], "d": 2 * radius, "E_f": 1.1e5}
        if law["formula"] == "tate-rosenfeld":
            law["nu_f"] = 0.3
        if law["formula"] == "morris":
            law |= {"E_z": [7e4, 7e4], "d_head": 3 * radius, "pitch": 20, "row_pitch": 20, "rows": 2, "c_f": 1}
    if kind in ("bilinear", "four stage") and chance(random, 0.5):
        law["reversible"] = True
    if one_direction and chance(random, 0.1):
        law["one_sided"] = True
    return law


def _gaps(random, fastener, holes, stretch):
    """Gaps and interference of 1e-6 to 1e2 of the load's stretch in holes in contact, clearances of others."""
    mine = [holes[at] for at in fastener["between"] if at != "ground"]
    if any(is_contact(hole) for hole in mine):
        if chance(random, 0.75):
            sign = random.choice([1, 1, -1])
            most = min(hole["radius"] for hole in mine) * 0.1
            gap = sign * min(stretch * power(random, -6, 2), most)
            fastener["gap"] = [gap * random.choice([1, 1, 0, 0.5]) if is_contact(hole) else 0 for hole in mine]
    elif chance(random, 0.3):
        fastener["clearance"] = stretch * power(random, -6, 2)


def _friction(random, fastener, holes):
    """Friction of all holes of a fastener alike or of some; none at points, quarters and springs along arcs or at nodes."""
    mine = [at for at in fastener["between"] if at != "ground"]
    plain = all("radius" in holes[at] and not {"arc", "links"} & holes[at]["spring"].keys() for at in mine)
    if not plain or not chance(random, 0.35):
        return
    mu = random.choice([0.05, 0.15, 0.3])
    fastener["friction"] = mu if chance(random, 0.6) else {random.choice(mine).split(":")[0]: mu}
    if chance(random, 0.2):
        fastener["law_includes_friction"] = True


def _fasteners(random, layout, plates, laws, to_ground, stretch):
    """One fastener at each place: through all sheets that have a hole there, in the order of the stack, and sometimes on to
    the ground."""
    scene = Scene(plates, {})
    holes, fasteners, stack = scene.holes(), [], list(plates)
    if chance(random, 0.3):
        random.shuffle(stack)
    for i, j in layout.fasteners():
        order = [name for name in stack if f"{name}:{i}{j}" in holes]
        between = [f"{name}:{i}{j}" for name in order]
        if to_ground or len(between) == 1:
            between.append("ground")
        if len(between) < 2:
            continue
        names = list(laws)
        law = random.choice(names) if chance(random, 0.7) else [random.choice(names) for _ in between[1:]]
        fastener = {"id": f"f{i}{j}", "between": between, "law": law}
        _gaps(random, fastener, holes, stretch)
        if not (layout.quarter and i == 0):
            _friction(random, fastener, holes)
        if chance(random, 0.1):
            off = {"x": stretch * random.uniform(-1, 1), "y": stretch * random.uniform(-1, 1)}
            fastener["offset"] = {order[0]: [off["x"], off["y"] if layout.directions == ["x", "y"] and not layout.half else 0]}
        if layout.expands and chance(random, 0.3):
            fastener["expansion"] = 1.2e-5
        fasteners.append(fastener)
    return fasteners


def _loads(random, plates, F, stretch, may_displace):
    loads = []
    for name, plate in plates.items():
        for external in plate["external"]:
            if not chance(random, 0.75):
                continue
            load = {"external": f"{name}:{external['id']}"}
            size = random.choice([1, -1]) * power(random, -1, 0)
            if external["kind"] == "moment":
                load["moment"] = size * F * 5
            elif external["kind"] == "rigid" and may_displace and chance(random, 0.2):
                load["displacement"] = size * stretch
            else:
                load["force"] = size * F * (0.1 if external["direction"] == "y" else 1)
            loads.append(load)
    return loads


def _increments(random, remembering_past):
    kinds = [1, 2, 3, [0.5, 1], [1, 0.5, 1], [0.3, 1, 0, -0.6, 1], [-1, 1],
             [1, -0.5, 10 ** random.uniform(-17, -3), 0.7]] + ([] if remembering_past else ["events"])
    return random.choice(kinds)


def _cases(random, layout, plates, joint, F, stretch):
    """"loads", or "cases" one after another or each from the unloaded joint, some of temperature."""
    remembering = any(remembers(law) for law in joint["laws"].values())
    temperatures = {name: random.uniform(-80, 80) for name in plates if layout.expands and chance(random, 0.7)}
    first = _loads(random, plates, F, stretch, not layout.expands)
    displaced = any("displacement" in load for load in first)
    if first and chance(random, 0.7):
        joint |= {"loads": first, "increments": _increments(random, False)}
        if temperatures:
            joint["temperatures"] = temperatures
        return
    cases = [{"name": "a", "loads": first, "increments": _increments(random, False)}]
    for name in "bc"[:random.randint(0, 2)]:
        case = {"name": name, "loads": _loads(random, plates, F, stretch, False)}
        if not displaced and chance(random, 0.4):
            case["after"] = cases[-1]["name"]
        case["increments"] = _increments(random, remembering and "after" in case)
        cases.append(case)
    if temperatures:
        cases[-1]["temperatures"] = temperatures
        if chance(random, 0.3):
            cases[-1]["fastener_temperature"] = random.uniform(-80, 80)
    joint["cases"] = cases


def random_scene(random):
    """A joint of one to four sheets. The first sheet is held along x, or fasteners go on to the ground."""
    layout = random_layout(random)
    n = random.choice([1, 2, 2, 2, 2, 3, 3, 4])
    to_ground = n == 1 or chance(random, 0.15)
    places = layout.fasteners()
    plates = {}
    for k in range(n):
        left_out = {random.choice(places)} if k > 1 and len(places) > 2 and chance(random, 0.4) else ()
        plates["abcd"[k]] = random_sheet(random, layout, k > 0 or to_ground, left_out)
    sheet = plates[random.choice(list(plates))]
    E, t = modulus_of(sheet), thickness_of(sheet)
    F = E * t * 20 * power(random, -5, -2.5)
    stretch = F / (E * t)
    radius = min(layout.radius.values())
    one_direction = len(layout.directions) == 1
    laws = {f"law {i}": random_law(random, one_direction, E * t, F / len(places), radius) for i in range(random.randint(1, 3))}
    joint = {"format": "joint", "version": 1, "units": {"length": "mm", "force": "N"},
             "plates": {name: f"{name}.matrices.h5" for name in plates}, "laws": laws}
    joint["fasteners"] = _fasteners(random, layout, plates, laws, to_ground, stretch)
    _cases(random, layout, plates, joint, F, stretch)
    if chance(random, 0.15):
        joint["solver"] = {"method": random.choice(["hybridsj", "damped newton"])}
    if chance(random, 0.1):
        joint["initial"] = random.choice(["rigid", "equal", {"linear": E * t}])
    if chance(random, 0.1):
        joint["margins"] = {"checks": [{"check": "bearing", "F_br": 500}, {"check": "peak", "limit": 300},
                                       {"check": "fastener shear", "F_su": 400}]}
    return Scene(plates, joint)
