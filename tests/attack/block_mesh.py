# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of its own for a sheet given as a grid: each cell one element, or those around its hole.

Made apart from stage 1's mesher, so that a mistake of that one shows. Whole holes inside cells only.
"""
import numpy as np


class _Nodes:
    """Nodes by place, each once; places of cell lines are exactly equal, so that equal means the same number."""

    def __init__(self):
        self.at, self.number = [], {}

    def __call__(self, point):
        key = (float(point[0]), float(point[1]))
        if key not in self.number:
            self.number[key] = len(self.at)
            self.at.append(list(key))
        return self.number[key]


def _cell_border(x, y):
    """Eight points around a cell, counter-clockwise from its lower left corner: corners and middles of sides."""
    middle_x, middle_y = (x[0] + x[1]) / 2, (y[0] + y[1]) / 2
    return [(x[0], y[0]), (middle_x, y[0]), (x[1], y[0]), (x[1], middle_y), (x[1], y[1]), (middle_x, y[1]), (x[0], y[1]),
            (x[0], middle_y)]


def _around_hole(nodes, border, hole, quads, arcs):
    """Eight elements between a rim and the border of its cell."""
    center, radius = np.array(hole["center"]), hole["radius"]
    outer = [nodes(point) for point in border]
    rays = [np.array(point) - center for point in border]
    rim = [nodes(center + radius * ray / np.hypot(*ray)) for ray in rays]
    for i in range(8):
        j = (i + 1) % 8
        quads.append([rim[i], outer[i], outer[j], rim[j]])
        arcs.append({"edge": [rim[i], rim[j]], "center": list(hole["center"])})


def _plain(nodes, border, quads):
    """Four elements that meet in the middle of a cell, so that its sides have the middles that neighbours with holes have."""
    middle = nodes(((border[0][0] + border[2][0]) / 2, (border[0][1] + border[4][1]) / 2))
    ring = [nodes(point) for point in border]
    for corner in (0, 2, 4, 6):
        quads.append([ring[corner], ring[(corner + 1) % 8], middle, ring[corner - 1]])


def _edges(nodes, x, y):
    """Edges of the four sides of the sheet, each cell's in two halves."""
    def along(points):
        numbers = [nodes(point) for point in points]
        return [[a, b] for a, b in zip(numbers, numbers[1:])]

    def with_middles(lines):
        return [value for a, b in zip(lines, lines[1:]) for value in (a, (a + b) / 2)] + [lines[-1]]

    xs, ys = with_middles(x), with_middles(y)
    return {"bottom": along([(v, y[0]) for v in xs]), "top": along([(v, y[-1]) for v in xs]),
            "left": along([(x[0], v) for v in ys]), "right": along([(x[-1], v) for v in ys])}


def as_mesh(sheet, random):
    """The same sheet with a mesh of its own in place of its grid. Inner corners of cells without holes around them may be
    moved a little, so that elements are not all rectangles."""
    grid = sheet["geometry"]["grid"]
    x, y = grid["x"], grid["y"]
    nodes, quads, arcs, thickness, material = _Nodes(), [], [], [], []
    for j in range(len(y) - 1):
        for i in range(len(x) - 1):
            border, first = _cell_border(x[i:i + 2], y[j:j + 2]), len(quads)
            inside = [hole for hole in sheet["holes"]
                      if x[i] < hole["center"][0] < x[i + 1] and y[j] < hole["center"][1] < y[j + 1]]
            if inside:
                _around_hole(nodes, border, inside[0], quads, arcs)
            else:
                _plain(nodes, border, quads)
                if random.random() < 0.5:
                    middle, size = nodes.at[quads[first][2]], min(x[i + 1] - x[i], y[j + 1] - y[j])
                    middle[0] += 0.1 * size * random.uniform(-1, 1)
                    middle[1] += 0.1 * size * random.uniform(-1, 1)
            for table, values in (grid["thickness"], thickness), (grid.get("material", "a"), material):
                values += [table[j][i] if isinstance(table, list) else table] * (len(quads) - first)
    used = {name for support in sheet["supports"] for name in [support["on"]]} | {e["on"] for e in sheet["external"]}
    edges = {name: found for name, found in _edges(nodes, x, y).items() if name in used}
    mesh = {"nodes": nodes.at, "quads": quads, "arcs": arcs, "thickness": thickness, "material": material, "edges": edges}
    return sheet | {"geometry": {"mesh": mesh}}
