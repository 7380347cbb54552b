# SPDX-License-Identifier: GPL-3.0-or-later
"""The h-version: the mesh of a solved plate with every element cut, as "geometry" of a PLATE.json."""
import numpy as np

SIDES = np.array([[0, 1], [1, 2], [2, 3], [3, 0]])  # of an element, counter-clockwise from xi = -1, eta = -1


def curve(a, b, center, s):
    """Points of the complex plane at 0 <= s <= 1 from a to b: on a line, or on the shorter arc about center."""
    if center is None:
        return a + (b - a) * s
    sweep = np.angle((b - center) / (a - center))
    return center + (a - center) * np.exp(1j * sweep * s)


def blend(corners, bottom, right, top, left, s):
    """Points (i, j) inside a quadrilateral between its sides, each (cut + 1) points along xi or eta: transfinite."""
    xi, eta = s[:, None], s[None, :]
    c = corners
    bilinear = (1 - xi) * (1 - eta) * c[0] + xi * (1 - eta) * c[1] + xi * eta * c[2] + (1 - xi) * eta * c[3]
    return ((1 - eta) * bottom[:, None] + eta * top[:, None] + (1 - xi) * left[None, :] + xi * right[None, :]
            - bilinear)[1:-1, 1:-1]


class Cut:
    """Nodes of a mesh whose elements are cut into cut x cut: its vertices, then those on edges, then those inside."""

    def __init__(self, nodes, quads, arcs, cut):
        self.cut, self.vertices, self.quads = cut, nodes @ [1, 1j], quads
        ends = np.sort(quads[:, SIDES], axis=2).reshape(-1, 2)
        self.edges, which, self.n_elements = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
        self.of_element = which.reshape(-1, 4)
        s = np.linspace(0, 1, cut + 1)
        self.center = [arcs.get((a, b)) for a, b in self.edges.tolist()]
        self.curves = np.array([curve(self.vertices[a], self.vertices[b], c, s)
                                for (a, b), c in zip(self.edges, self.center)])
        inside = [blend(self.vertices[quad], *(self.side(element, k)[1] for k in range(4)), s)
                  for element, quad in enumerate(quads)]
        at = np.concatenate([self.vertices, self.curves[:, 1:-1].ravel(), np.ravel(inside)])
        self.nodes = np.column_stack([at.real, at.imag])

    def along(self, edge):
        """Numbers of the nodes of an edge, from its lower vertex."""
        low, high = self.edges[edge]
        first = len(self.vertices) + edge * (self.cut - 1)
        return np.array([low, *range(first, first + self.cut - 1), high])

    def side(self, element, k):
        """Numbers and places of the nodes of a side, along xi or eta."""
        edge = self.of_element[element, k]
        start = self.quads[element, SIDES[k][0 if k < 2 else 1]]
        step = 1 if start == self.edges[edge, 0] else -1
        return self.along(edge)[::step], self.curves[edge][::step]

    def elements(self):
        """The four nodes of each part of each element, counter-clockwise."""
        n = self.cut - 1
        inside = len(self.vertices) + len(self.edges) * n
        for element in range(len(self.quads)):
            at = np.empty((n + 2, n + 2), dtype=int)
            at[1:-1, 1:-1] = inside + n * n * element + np.arange(n * n).reshape(n, n)
            at[:, 0], at[-1], at[:, -1], at[0] = (self.side(element, k)[0] for k in range(4))
            yield np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], axis=-1).reshape(-1, 4)


def pairs(mesh, edge):
    numbers = mesh.along(edge)
    return np.column_stack([numbers[:-1], numbers[1:]]).tolist()


def refined(plate, cut):
    """The mesh of a rectangular plate (PLATE.h5, open by h5py), every element cut into cut x cut along its own
    coordinates; arcs stay arcs. Edges: left, right, bottom, top."""
    arcs = {tuple(sorted(ends)): complex(*center)
            for ends, center in zip(plate["mesh/arc_nodes"][:].tolist(), plate["mesh/arc_center"][:])}
    nodes, quads = plate["mesh/nodes"][:], plate["mesh/quads"][:]
    mesh = Cut(nodes, quads, arcs, cut)
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    named = {}
    for name, axis, line in (("left", 0, low), ("right", 0, high), ("bottom", 1, low), ("top", 1, high)):
        on_line = (nodes[mesh.edges, axis] == line[axis]).all(axis=1)
        named[name] = [pair for edge in np.flatnonzero(on_line) for pair in pairs(mesh, edge)]
    return {"mesh": {
        "nodes": mesh.nodes.tolist(), "quads": np.concatenate(list(mesh.elements())).tolist(),
        "arcs": [{"edge": pair, "center": [center.real, center.imag]} for edge, center in enumerate(mesh.center)
                 if center is not None for pair in pairs(mesh, edge)],
        "thickness": np.repeat(plate["mesh/thickness"][:], cut * cut).tolist(), "edges": named}}
