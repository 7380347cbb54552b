# SPDX-License-Identifier: GPL-3.0-or-later
"""Fine meshes for stresses at holes: the programs' own mesh of a grid with all elements beside a hole cut along the rim.

Rings of elements alone leave sides of 45 degrees, which follow few waves. Elements in other cells are cut both ways. It is as good as the
cells are: they should be about as wide as high.
"""
import copy
import json
import subprocess

import h5py
import numpy as np


def cut_mesh(folder, programs, scene, pieces, waves, rings=3):
    """A scene with a mesh of its own for the scene of a grid, of degree 8 alone: each side in `pieces`, holes with as many `waves`."""
    scene = copy.deepcopy(scene)
    for hole in scene["holes"]:
        hole["rings"] = rings
        if hole.get("spring", {}).get("compression_only"):
            hole["spring"]["harmonics"] = 64
    mesh = _Cut(*_mesh_of(folder, programs, scene), scene, pieces)
    for hole in scene["holes"]:
        del hole["rings"]
        hole["waves"] = waves
    grid = scene["geometry"]["grid"]
    return {**scene, "p": 8, "geometry": {"mesh": {**mesh.text(), "thickness": grid["thickness"]}}}


def _mesh_of(folder, programs, scene):
    """Nodes as complex numbers, quadrilaterals (n, 4), and the centre of each edge that is an arc."""
    (folder / "coarse.json").write_text(json.dumps({**scene, "p": 1}))
    subprocess.run([programs / "stage1_plate", "coarse.json", "-o", "coarse.h5", "--quiet"], cwd=folder, check=True, capture_output=True)
    with h5py.File(folder / "coarse.h5") as f:
        arcs = {tuple(sorted(edge)): complex(*center) for edge, center in zip(f["mesh/arc_nodes"][:].tolist(), f["mesh/arc_center"][:])}
        return f["mesh/nodes"][:] @ [1, 1j], f["mesh/quads"][:], arcs


class _Cut:
    def __init__(self, nodes, quads, arcs, scene, pieces):
        self.coarse, self.coarse_arcs, self.pieces = nodes, arcs, pieces
        self.nodes, self.quads, self.arcs, self.sides = list(nodes), [], {}, {}
        self.x, self.y = scene["geometry"]["grid"]["x"], scene["geometry"]["grid"]["y"]
        centers = {self._cell(complex(*hole["center"])): complex(*hole["center"]) for hole in scene["holes"]}
        for quad in quads.tolist():
            center = centers.get(self._cell(nodes[quad].mean()))
            if center is None:
                self._cut_both_ways(quad)
            else:
                self._cut_along_the_rim(quad, center)

    def _cell(self, z):
        return np.searchsorted(self.x, z.real), np.searchsorted(self.y, z.imag)

    def _side(self, a, b):
        """Nodes of an edge from a to b, made once."""
        key = (min(a, b), max(a, b))
        if key not in self.sides:
            at = np.arange(1, self.pieces) / self.pieces
            start, end, center = self.coarse[key[0]], self.coarse[key[1]], self.coarse_arcs.get(key)
            if center is None:
                between = start + (end - start) * at
            else:
                between = center + (start - center) * np.exp(1j * np.angle((end - center) / (start - center)) * at)
            self.sides[key] = [key[0], *range(len(self.nodes), len(self.nodes) + self.pieces - 1), key[1]]
            self.nodes.extend(between)
            if center is not None:
                self.arcs.update(dict.fromkeys(zip(self.sides[key], self.sides[key][1:]), center))
        return self.sides[key] if a < b else self.sides[key][::-1]

    def _cut_along_the_rim(self, quad, center):
        angle = np.angle((self.coarse[quad] - center) / (self.coarse[quad].mean() - center))
        first = 0 if abs(angle[0] - angle[1]) < 1e-6 else 1
        a, b, c, d = quad[first:] + quad[:first]  # from a to b along a ray
        low, high = self._side(a, d), self._side(b, c)
        self.quads += [[low[i], high[i], high[i + 1], low[i + 1]] for i in range(self.pieces)]

    def _cut_both_ways(self, quad):
        n, (a, b, c, d) = self.pieces, quad
        index = np.zeros((n + 1, n + 1), int)
        index[:, 0], index[n], index[:, n], index[0] = self._side(a, b), self._side(b, c), self._side(d, c), self._side(a, d)
        z = np.array(self.nodes)
        A, B, C, D = self.coarse[quad]
        for i in range(1, n):
            for j in range(1, n):
                u, v = i / n, j / n
                index[i, j] = len(self.nodes)
                self.nodes.append((1 - v) * z[index[i, 0]] + v * z[index[i, n]] + (1 - u) * z[index[0, j]] + u * z[index[n, j]]
                                  - ((1 - u) * (1 - v) * A + u * (1 - v) * B + u * v * C + (1 - u) * v * D))
        self.quads += [[int(index[i, j]), int(index[i + 1, j]), int(index[i + 1, j + 1]), int(index[i, j + 1])]
                       for i in range(n) for j in range(n)]

    def text(self):
        nodes = np.array(self.nodes)
        edges = [tuple(sorted(edge)) for quad in self.quads for edge in zip(quad, quad[1:] + quad[:1])]
        near = 1e-9 * (self.x[-1] - self.x[0])
        border = {"left": nodes.real - self.x[0], "right": nodes.real - self.x[-1], "bottom": nodes.imag - self.y[0],
                  "top": nodes.imag - self.y[-1]}
        return {"nodes": [[z.real, z.imag] for z in nodes], "quads": self.quads,
                "arcs": [{"edge": [int(node) for node in edge], "center": [z.real, z.imag]} for edge, z in self.arcs.items()],
                "edges": {name: [[int(a), int(b)] for a, b in sorted(set(edges)) if abs(away[a]) < near and abs(away[b]) < near]
                          for name, away in border.items()}}
