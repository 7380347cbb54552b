# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of a square sheet around a hole of radius 1 at the origin, as "geometry" of a PLATE.json."""
import numpy as np


def polar_mesh(radii, half_width, degrees):
    """Rings of quadrilaterals at the given radii (the first is the hole's, 1), and one from the last ring to the border.

    degrees: angles of the rays, from 0 to 90 (the quarter x, y >= 0) or to 180 (the half y >= 0), 45 and 135 among them.
    Edges: right, top, left (the border, or x = 0 of a quarter), bottom.
    """
    theta = np.radians(degrees)
    ray = np.column_stack([np.cos(theta), np.sin(theta)])
    ray[np.abs(ray) < 1e-15] = 0
    square = ray / np.abs(ray).max(axis=1)[:, None] * half_width
    square[np.isclose(square, half_width, rtol=1e-12)] = half_width
    square[np.isclose(square, -half_width, rtol=1e-12)] = -half_width
    nodes = np.vstack([r * ray for r in radii] + [square])
    m, n_layers = len(theta), len(radii)
    inner = [layer * m + i for layer in range(n_layers) for i in range(m - 1)]
    last = n_layers * m
    border = [[last + i, last + i + 1] for i in range(m - 1)]

    def on(axis, value):
        return [edge for edge in border if np.all(nodes[edge, axis] == value)]

    def ray_edges(i):
        return [[layer * m + i, (layer + 1) * m + i] for layer in range(n_layers)]

    edges = {"right": on(0, half_width), "top": on(1, half_width), "bottom": ray_edges(0)}
    if degrees[-1] == 90:
        edges["left"] = ray_edges(m - 1)
    else:
        edges["left"] = on(0, -half_width)
        edges["bottom"] += ray_edges(m - 1)
    return {"mesh": {"nodes": nodes.tolist(), "quads": [[a, a + m, a + m + 1, a + 1] for a in inner],
                     "arcs": [{"edge": [a, a + 1], "center": [0, 0]} for a in inner], "thickness": 1, "edges": edges}}


def graded_radii(first_step, growth, outer):
    """1 = r0 < r1 < ... < outer: the first step is first_step * r, each next one `growth` times larger in proportion."""
    radii, step = [1.0], first_step
    while radii[-1] * (1 + step) < outer / 1.3:
        radii.append(radii[-1] * (1 + step))
        step = min(step * growth, 1.0)
    return radii


def graded_degrees(smallest, largest, end):
    """Rays from 0 to 90 that draw together towards 90, doubling from there, and the mirror image up to an end of 180."""
    steps = [smallest]
    while 45 - sum(steps) > 2 * largest:
        steps.append(min(2 * steps[-1], largest))
    n = int(np.ceil((45 - sum(steps)) / largest))
    near = 90 - np.concatenate([[0], np.cumsum(steps)])
    quarter = np.unique(np.round(np.concatenate([near, np.linspace(45, near[-1], n + 1), np.linspace(0, 45, 3)]), 9))
    return quarter if end == 90 else np.concatenate([quarter, 180 - quarter[-2::-1]])
