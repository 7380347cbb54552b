# SPDX-License-Identifier: GPL-3.0-or-later
"""Random joints of one sheet whose peaks of hoop stress are to be found: the sheet as a user may have it, and in well shaped cells."""
import copy

import numpy as np


def random_joint(seed):
    """A sheet with one to three holes in a row, ligaments from 0.15 diameters, half of them in contact: its scene, the same with other
    lines of the grid for fine meshes, and the joint's fasteners, laws and loads."""
    rng = np.random.default_rng(seed)
    material, E = _material(rng)
    n, in_contact = int(rng.integers(1, 4)), rng.random() < 0.5
    r = rng.uniform(2, 3, n)
    x, y, border = _places(rng, r)
    load = 1000.0 * n
    kinds = [("contact" if rng.random() < 0.75 else "open") if in_contact else ("sprung" if rng.random() < 0.5 else "open")
             for _ in r]
    if in_contact and "contact" not in kinds:
        kinds[0] = "contact"
    holes, fasteners = [], []
    for i, kind in enumerate(kinds):
        hole = {"id": str(i), "center": [float(x[i]), float(y[i])], "radius": float(r[i])}
        if kind != "open":
            hole["spring"] = {"modulus": float(rng.uniform(1, 6) * E / r[i]), "compression_only": kind == "contact"}
            fasteners.append({"id": str(i), "between": [f"sheet:{i}", "ground"], "law": "law"})
        if kind == "contact":
            fasteners[-1]["gap"] = float(rng.choice([0, 0, rng.uniform(0, 4), -rng.uniform(0, 0.6)]) * 1000 / (2 * E))
        holes.append(hole)
    along = str(rng.choice(["x", "y"]))
    across = "y" if along == "x" else "x"
    scene = {"format": "plate", "version": 1, "analysis": "plane stress", "materials": {"m": material}, "holes": holes,
             "geometry": {"grid": {"x": _lines(rng, x - r, x + r, border["x"]), "y": _lines(rng, y - r, y + r, border["y"]), "thickness": 2.0}},
             "supports": [{"on": "left", "fix": [across]}], "external": [{"id": "P", "on": "left", "direction": along, "kind": "rigid"}]}
    loads = [{"external": "sheet:P", "force": float(load * rng.choice([-1, 1]))}]
    laws = {"law": {"type": "linear", "k": 1e5}}
    if not fasteners:  # a joint wants one: it sits in a corner and bears nothing
        scene["supports"].append({"on": "right", "fix": ["x", "y"]})
        scene["points"] = [{"id": "corner", "at": [border["x"][0], border["y"][0]], "stiffness": 1e5}]
        scene["disc_directions"] = [along]
        fasteners, laws["law"]["k"] = [{"id": "corner", "between": ["sheet:corner", "ground"], "law": "law"}], 1e-3
    elif rng.random() < 0.5:
        scene["external"].append({"id": "Q", "on": "right", "direction": "x", "kind": "traction"})
        loads.append({"external": "sheet:Q", "force": float(load * rng.uniform(-1, 1))})
    fine = copy.deepcopy(scene)
    fine["geometry"]["grid"].update(x=_fine_lines(x, r, border["x"]), y=_fine_lines([y.mean()], [r.max()], border["y"]))
    return scene, fine, {"fasteners": fasteners, "laws": laws, "loads": loads}


def _material(rng):
    """Isotropic or a laminate, and a modulus of its size."""
    if rng.random() < 0.35:
        return {"E": 70e3, "nu": rng.uniform(0.2, 0.35)}, 70e3
    E1 = 100e3
    E2 = E1 / np.exp(rng.uniform(0, np.log(20)))
    G = np.sqrt(E1 * E2) / 1.3 * rng.uniform(0.12, 0.6)
    angle = float(rng.choice([0, 90, rng.uniform(-90, 90)]))
    return {"E1": E1, "E2": float(E2), "G12": float(G), "nu12": rng.uniform(0.05, 0.3), "angle": angle}, np.sqrt(E1 * E2)


def _places(rng, r):
    """Centres of holes in a row along x, and the borders of the sheet."""
    def ligament():
        return np.exp(rng.uniform(np.log(0.15), np.log(3)))

    x = np.zeros(len(r))
    for i in range(1, len(r)):
        x[i] = x[i - 1] + (r[i - 1] + r[i]) * (1 + ligament())
    y = np.zeros(len(r)) if rng.random() < 0.6 else rng.uniform(-0.5, 0.5, len(r)) * r
    border = {"x": (-rng.uniform(8, 16) * r[0], x[-1] + r[-1] * (1 + 2 * ligament())),
              "y": (np.min(y - r - 2 * r * ligament()), np.max(y + r * (1 + 2 * rng.uniform(1, 5))))}
    return x, y, {axis: [round(float(line), 6) for line in lines] for axis, lines in border.items()}


def _lines(rng, low, high, border):
    """Lines of a grid that a user may choose: between holes, and some at a distance from the first and last."""
    size = np.max(high - low) / 2
    lines = list(border)
    if low[0] - border[0] > 3 * size and rng.random() < 0.7:
        lines.append(np.min(low) - rng.uniform(0.3, 2.5) * size)
    if border[1] - np.max(high) > 3 * size and rng.random() < 0.7:
        lines.append(np.max(high) + rng.uniform(0.3, 2.5) * size)
    lines += [(a + b) / 2 for a, b in zip(high, low[1:]) if b > a]  # holes beside each other
    return sorted(float(line) for line in lines)


def _fine_lines(centers, radii, border):
    """Lines that leave cells about as wide as high around holes, and cells that grow away from them."""
    lines = list(border)
    for i, (center, radius) in enumerate(zip(centers, radii)):
        before = border[0] if i == 0 else (centers[i - 1] + radii[i - 1] + center - radius) / 2
        after = border[1] if i == len(centers) - 1 else (center + radius + centers[i + 1] - radii[i + 1]) / 2
        for end in (before, after):
            distance = 2.5 * radius
            while distance < 0.6 * abs(end - center):
                lines.append(center + distance * np.sign(end - center))
                distance *= 2.6
            lines.append(end)
    return sorted({round(float(line), 6) for line in lines})
