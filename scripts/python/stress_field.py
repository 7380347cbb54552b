# SPDX-License-Identifier: GPL-3.0-or-later
"""What a file of stage2_extract --field says, and its stresses between the nodes."""
import xml.etree.ElementTree

import numpy as np
from matplotlib.tri import Triangulation

QUANTITIES = {
    "von_mises": lambda x, y, xy: np.sqrt(x**2 - x * y + y**2 + 3 * xy**2),
    "principal_1": lambda x, y, xy: (x + y) / 2 + np.hypot((x - y) / 2, xy),
    "principal_2": lambda x, y, xy: (x + y) / 2 - np.hypot((x - y) / 2, xy),
    "stress_xx": lambda x, y, xy: x,
    "stress_yy": lambda x, y, xy: y,
    "stress_xy": lambda x, y, xy: xy,
}


class Field:
    """What a file of stage2_extract --field says; point arrays of shape (cells, nodes, components)."""

    def __init__(self, path):
        self.path = path
        try:
            root = xml.etree.ElementTree.parse(path).getroot()
            n_cells = int(root.find(".//Piece").get("NumberOfCells"))
            self.points = {a.get("Name"): self._numbers(a).reshape(n_cells, -1, int(a.get("NumberOfComponents")))
                           for where in ("PointData", "Points") for a in root.findall(f".//{where}/DataArray")}
            self.thickness = self._numbers(root.find(".//CellData/DataArray[@Name='thickness']"))
            self.words = {a.get("Name"): self._strings(a) for a in root.findall(".//FieldData/DataArray[@type='UInt8']")}
            self.whole = {a.get("Name"): self._numbers(a) for a in root.findall(".//FieldData/DataArray[@type!='UInt8']")}
            self.unit = self.words["stress_unit"][0]
        except (OSError, AttributeError, KeyError, TypeError, ValueError, xml.etree.ElementTree.ParseError) as error:
            raise SystemExit(f"draw_stress: error: {path}: cannot be read as a file of stage2_extract --field: "
                             f"{error}") from None

    @staticmethod
    def _numbers(array):
        return np.array((array.text or "").split(), dtype=float)

    @staticmethod
    def _strings(array):
        """Codes of bytes, each string ended by 0."""
        codes = bytes(int(code) for code in (array.text or "").split())
        return [part.decode() for part in codes.split(b"\0")[:-1]]

    def holes(self):
        """Centre of each hole."""
        centers = self.whole.get("hole_center", np.zeros(0)).reshape(-1, 3)
        return dict(zip(self.words.get("hole_id", []), centers[:, :2]))

    def radii(self):
        """Radius of each hole."""
        return dict(zip(self.words.get("hole_id", []), self.whole.get("hole_radius", [])))


def lagrange_nodes(p):
    """Coordinates (xi, eta) of VTK's nodes, shape (nodes, 2): corners, edges bottom, right, top, left, the inside."""
    s = np.linspace(-1, 1, p + 1)[1:-1]
    one = np.ones_like(s)
    edges = [(s, -one), (one, s), (s, one), (-one, s)]
    inside = [(s, t * one) for t in s]
    return np.vstack([[(-1, -1), (1, -1), (1, 1), (-1, 1)], *(np.column_stack(e) for e in edges + inside)])


def products(p, xi, eta):
    """Products of Legendre polynomials at points, shape (points, (p + 1)^2)."""
    return np.polynomial.legendre.legvander2d(xi, eta, [p, p])


def fine_patch(n_nodes):
    """Matrix from a cell's nodes to a fine grid of points on it, and the triangles between those."""
    p = int(round(np.sqrt(n_nodes))) - 1
    n = max(2 * p, 8) + 1
    eta, xi = (a.ravel() for a in np.meshgrid(*2 * [np.linspace(-1, 1, n)], indexing="ij"))
    refine = products(p, xi, eta) @ np.linalg.inv(products(p, *lagrange_nodes(p).T))
    a = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    return refine, np.vstack([np.column_stack([a, a + 1, a + n + 1]), np.column_stack([a, a + n + 1, a + n])])


class FineField:
    """Triangles over the sheet, and the quantity at their corners. The components of the stress are what is interpolated:
    they are smooth where von Mises and principal stresses have kinks."""

    def __init__(self, field, quantity):
        refine, triangles = fine_patch(field.points["points"].shape[1])
        self.x, self.y = (field.points["points"][..., i] @ refine.T for i in (0, 1))
        self.stress = [field.points[name][..., 0] @ refine.T for name in ("stress_xx", "stress_yy", "stress_xy")]
        self.thickness = field.thickness
        first = np.arange(len(self.x))[:, None, None] * self.x.shape[1]
        self.mesh = Triangulation(self.x.ravel(), self.y.ravel(), (first + triangles).reshape(-1, 3))
        self.values = QUANTITIES[quantity](*self.stress).ravel()

    def near_holes(self, field):
        """The values within one radius of a rim; all of a sheet without holes."""
        near = np.zeros(self.mesh.x.shape, bool)
        for hole, (x, y) in field.holes().items():
            near |= np.hypot(self.mesh.x - x, self.mesh.y - y) < 2 * field.radii()[hole]
        return self.values[near] if near.any() else self.values

    def _sides(self):
        """Of each side of the cells' grids the coordinates and the stresses along it, (cells, points), and the thickness."""
        n = int(round(np.sqrt(self.x.shape[1])))
        grids = [a.reshape(-1, n, n) for a in (self.x, self.y, *self.stress)]
        for side in (np.s_[:, 0, :], np.s_[:, -1, :], np.s_[:, :, 0], np.s_[:, :, -1]):
            yield [a[side] for a in grids]

    def hole_force(self, center, radius):
        """Force on the sheet at the rim of a hole: the integral of the stress along it."""
        force = np.zeros(2)
        for x, y, xx, yy, xy in self._sides():
            x, y = x - center[0], y - center[1]
            on = np.abs(np.hypot(x, y) - radius).max(axis=1) < 1e-6 * radius
            angle = np.unwrap(np.arctan2(y[on], x[on]), axis=1)
            for i, traction in enumerate((xx[on] * x[on] + xy[on] * y[on], xy[on] * x[on] + yy[on] * y[on])):
                force[i] -= (np.abs(np.diff(angle)) * (traction[:, 1:] + traction[:, :-1]) / 2 * self.thickness[on, None]).sum()
        return force

    def edge_forces(self):
        """Middle, outward normal and force on the sheet of each side of its bounding box that bears a load along straight
        edges: the integral of the stress over them."""
        size = max(np.ptp(self.x), np.ptp(self.y))
        bounds = (((1, 0), self.x.max()), ((-1, 0), self.x.min()), ((0, 1), self.y.max()), ((0, -1), self.y.min()))
        for normal, bound in bounds:
            force, ends = np.zeros(2), []
            for x, y, *stress in self._sides():
                across, along = (x, y) if normal[0] else (y, x)
                on = np.abs(across - bound).max(axis=1) < 1e-6 * size
                if not on.any():
                    continue
                at, (xx, yy, xy) = along[on], (a[on] for a in stress)
                for i, (a, b) in enumerate(((xx, xy), (xy, yy))):
                    traction = (a * normal[0] + b * normal[1]) * self.thickness[on, None]
                    step = np.abs(np.diff(at, axis=1))
                    force[i] += (step * (traction[:, 1:] + traction[:, :-1]) / 2).sum()
                ends += [at.min(), at.max()]
            if ends:
                middle = (bound, (min(ends) + max(ends)) / 2)
                yield np.array(middle if normal[0] else middle[::-1]), np.array(normal), force
