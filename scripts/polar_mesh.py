# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of a square sheet around a hole of radius 1 at the origin, as "geometry" of a PLATE.json."""
import numpy as np


def polar_mesh(radii, half_width, n_sectors, n_quarters):
    """Rings of quadrilaterals at the given radii (the first is the hole's, 1), and one from the last ring to the border.

    n_sectors of equal angle in each of the first n_quarters (1: x, y >= 0; 2: y >= 0). Edges: right, top, left (the
    border, or x = 0 of a quarter), bottom.
    """
    theta = np.linspace(0, np.pi / 2 * n_quarters, n_sectors * n_quarters + 1)
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
    if n_quarters == 1:
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
