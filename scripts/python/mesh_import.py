# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of quadrilaterals as Gmsh, Abaqus, Nastran and others write it, as "geometry" of a PLATE.json. Elements share whole edges; circles
are exact arcs: those of holes by their centre and radius, others by the nodes in the middle of quadratic elements' edges."""
import contextlib
import io
from dataclasses import dataclass, field

import meshio
import numpy as np
from scipy.spatial import cKDTree

QUADS, LINES = ("quad", "quad8", "quad9"), ("line", "line3")
IGNORED = ("vertex",)
SMALL = 1e-6  # of the length of an edge: nodes nearer than that are one, arcs flatter than that straight


class Refused(Exception):
    """A mesh that cannot become a sheet, with what is wrong and what is allowed."""


@dataclass
class Mesh:
    """Nodes (n, 2), elements (m, 4) counter-clockwise; what the file names: elements, edges {(a, b), a < b} and nodes; arcs {edge: centre}."""
    nodes: np.ndarray
    quads: np.ndarray
    surfaces: dict
    curves: dict
    middles: dict = field(default_factory=dict)  # of edges of quadratic elements
    arcs: dict = field(default_factory=dict)

    def edges(self):
        """{edge: number of elements that have it}."""
        found = {}
        for quad in self.quads:
            for edge in edges_of(quad):
                found[edge] = found.get(edge, 0) + 1
        return found

    def border(self):
        return [edge for edge, count in self.edges().items() if count == 1]


def edges_of(quad):
    return [tuple(sorted((int(a), int(b)))) for a, b in zip(quad, np.roll(quad, -1))]


def place(point):
    return f"({point[0]:g}, {point[1]:g})"


def read_mesh(path):
    """The mesh of a file in any format that meshio reads. Raises Refused."""
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # meshio prints empty lines
            read = meshio.read(path)
    except (meshio.ReadError, OSError, ValueError, KeyError, IndexError, SystemExit) as error:
        raise Refused(f"cannot be read: {str(error) or type(error).__name__}; allowed: a format that meshio reads, by the ending of the file's name")
    others = [(block.type, block.data) for block in read.cells if block.type not in QUADS + LINES + IGNORED and len(block.data)]
    if others:
        kind, cells = others[0]
        raise Refused(f"has {sum(len(data) for _, data in others)} elements that are no quadrilaterals; the first is a {kind} about "
                      f"{place(read.points[cells[0]].mean(axis=0))}; allowed: quadrilaterals alone (in Gmsh: Mesh.RecombineAll = 1, "
                      "Mesh.SubdivisionAlgorithm = 1)")
    quads = [block.data for block in read.cells if block.type in QUADS]
    if not quads:
        raise Refused("has no quadrilaterals")
    points = np.asarray(read.points, float)
    flat = points[:, 2:]
    if flat.size and np.ptp(flat) > SMALL * np.ptp(points[:, :2], axis=0).max():
        raise Refused(f"its z goes from {flat.min():g} to {flat.max():g}; allowed: a plane sheet, z the same everywhere")
    return compact(points[:, :2], quads, *named_parts(read))


def named_parts(read):
    """{name: indices of elements}, {name: edges by the nodes at their ends}: sets with names, else the numbers of groups."""
    starts, n = [], 0
    for block in read.cells:
        starts.append(n)
        n += len(block.data) if block.type in QUADS else 0
    surfaces, curves = {}, {}
    groups = {name: sets for name, sets in read.cell_sets.items() if not name.startswith("gmsh:")}
    named = {int(tag) for tag, _ in read.field_data.values()}  # of Gmsh
    for key in ("gmsh:physical", "nastran:ref", "medit:ref", "cell_tags"):
        for i, tags in enumerate(read.cell_data.get(key, [])):
            for tag in set(np.unique(tags).tolist()) - named:
                names = getattr(read, "cell_tags", {}).get(tag, [str(tag)]) if key == "cell_tags" else [str(tag)]
                for name in names:
                    groups.setdefault(name, [None] * len(read.cells))[i] = np.flatnonzero(tags == tag)
    for name, sets in groups.items():
        for block, start, members in zip(read.cells, starts, sets):
            if members is None or len(members) == 0:
                continue
            if block.type in QUADS:
                surfaces.setdefault(name, []).extend(start + np.asarray(members, int))
            elif block.type in LINES:
                curves.setdefault(name, set()).update(tuple(sorted(map(int, line[:2]))) for line in block.data[np.asarray(members, int)])
    nodes = {name: set(map(int, members)) for name, members in read.point_sets.items()}
    return surfaces, curves, nodes


def compact(points, blocks, surfaces, curves, node_sets):
    """Without the nodes that no corner uses; clockwise elements turned."""
    corners = np.vstack([block[:, :4] for block in blocks]).astype(int)
    x, y = points[corners].transpose(2, 0, 1)
    area = ((x[:, 2] - x[:, 0]) * (y[:, 3] - y[:, 1]) - (x[:, 3] - x[:, 1]) * (y[:, 2] - y[:, 0])) / 2
    middles = {}
    for block in blocks:
        for cell in block[:, :8] if block.shape[1] >= 8 else ():
            middles.update(zip(edges_of(cell[:4]), points[cell[4:8]]))
    used, renumbered = np.unique(corners, return_inverse=True)
    quads = renumbered.reshape(-1, 4)
    quads[area < 0] = quads[area < 0][:, ::-1]
    number = dict(zip(used.tolist(), range(len(used))))

    def new(edge):
        return tuple(sorted(number[a] for a in edge))

    mesh = Mesh(points[used], quads, surfaces, {}, {new(edge): middle for edge, middle in middles.items()})
    known = mesh.edges()
    for name, edges in curves.items():
        missing = [edge for edge in edges if not (edge[0] in number and edge[1] in number and new(edge) in known)]
        if missing:
            raise Refused(f"curve \"{name}\" has a line from {place(points[missing[0][0]])} to {place(points[missing[0][1]])} that is no edge of an element")
        mesh.curves[name] = {new(edge) for edge in edges}
    border = mesh.border()
    for name, members in node_sets.items():
        inside = {number[a] for a in members if a in number}
        edges = {edge for edge in border if inside.issuperset(edge)}
        if edges:
            mesh.curves.setdefault(name, edges)
    return mesh


def check_connection(mesh):
    """Elements meet at whole edges. Raises Refused for nodes at one place, nodes on an edge and edges of three elements."""
    for edge, count in mesh.edges().items():
        if count > 2:
            raise Refused(f"{count} elements share the edge from {place(mesh.nodes[edge[0]])} to {place(mesh.nodes[edge[1]])}; allowed: at most two")
    border = mesh.border()
    a, b = mesh.nodes[np.array(border)].transpose(1, 0, 2)
    lengths = np.hypot(*(b - a).T)
    tree = cKDTree(mesh.nodes)
    pairs = tree.query_pairs(SMALL * lengths.min())
    if pairs:
        raise Refused(f"{len(pairs)} pairs of nodes stand at one place, the first at {place(mesh.nodes[min(pairs)[0]])}; allowed: elements that share their nodes "
                      "(merge them)")
    for edge, start, end, length in zip(border, a, b, lengths):
        along = (end - start) / length
        for node in tree.query_ball_point((start + end) / 2, length / 2):
            offset = mesh.nodes[node] - start
            if node not in edge and abs(offset[0] * along[1] - offset[1] * along[0]) < SMALL * length and edge not in mesh.arcs:
                raise Refused(f"a node hangs at {place(mesh.nodes[node])} on the edge from {place(start)} to {place(end)}; allowed: elements that share whole edges")


def add_arcs(mesh):
    """Circles through the ends and the middle of the edges of quadratic elements; flat ones stay straight."""
    for (a, b), middle in mesh.middles.items():
        half, rise = (mesh.nodes[b] - mesh.nodes[a]) / 2, middle - (mesh.nodes[a] + mesh.nodes[b]) / 2
        length = np.hypot(*half)
        if np.hypot(*rise) <= SMALL * length:
            continue
        # From a the vectors to b and to the middle; the centre is as far from a as from both.
        system = np.array([2 * half, middle - mesh.nodes[a]])
        mesh.arcs[a, b] = mesh.nodes[a] + np.linalg.solve(2 * system, (system**2).sum(axis=1))


def fit_hole(mesh, hole, tolerance):
    """Makes the border's edges about a hole exact arcs of its circle, and moves their nodes onto it. Returns how far they were off.

    Raises Refused if a node is off by more than tolerance radii, or the rim is neither closed nor half nor a quarter of a circle."""
    name, center, radius = hole["id"], np.array(hole["center"], float), hole["radius"]
    rim = []
    for edge in mesh.border():
        ends = mesh.nodes[list(edge)] - center
        along = ends[1] - ends[0]
        middle = ends.mean(axis=0)
        across = abs(along @ middle) / max(np.hypot(*along) * np.hypot(*middle), 1e-300)  # 0 for a chord of a circle about the centre
        if np.abs(np.hypot(*ends.T) / radius - 1).max() < 0.1 and across < 0.5:
            rim.append(edge)
    if not rim:
        nearest = np.abs(np.hypot(*(mesh.nodes - center).T) - radius).min()
        raise Refused(f"hole \"{name}\": no edge of the border is on its circle about {place(center)} with radius {radius:g}; the nearest node is off it by {nearest:g}")
    nodes = sorted({node for edge in rim for node in edge})
    offsets = mesh.nodes[nodes] - center
    distances = np.hypot(*offsets.T)
    off = np.abs(distances - radius)
    if off.max() > tolerance * radius:
        raise Refused(f"hole \"{name}\": the node at {place(mesh.nodes[nodes[off.argmax()]])} is off its circle by {off.max():g}; allowed: {tolerance:g} of the radius, "
                      f"{tolerance * radius:g} (--tolerance)")
    angles = dict(zip(nodes, np.arctan2(*offsets.T[::-1])))
    sweep = sum(abs(np.remainder(angles[b] - angles[a] + np.pi, 2 * np.pi) - np.pi) for a, b in rim)
    if min(abs(sweep - part * np.pi) for part in (0.5, 1, 2)) > max(1e-3, 4 * tolerance):
        raise Refused(f"hole \"{name}\": its rim covers {np.degrees(sweep):.5g} degrees of its circle; allowed: 360, or 180 and 90 on the border of a sheet")
    mesh.nodes[nodes] = center + offsets * (radius / distances)[:, None]
    mesh.arcs.update({edge: center for edge in rim})
    return off.max()


def edge_curve(mesh, a, b, t):
    """Points (n, 2) and derivatives by t of the edge from a to b at t in [0, 1]."""
    start, end = mesh.nodes[a], mesh.nodes[b]
    center = mesh.arcs.get((min(a, b), max(a, b)))
    if center is None:
        return start + t[:, None] * (end - start), np.broadcast_to(end - start, (len(t), 2))
    first, last = (np.arctan2(*(p - center)[::-1]) for p in (start, end))
    sweep = np.remainder(last - first + np.pi, 2 * np.pi) - np.pi
    angle = first + sweep * t
    ray = np.hypot(*(start - center)) * np.column_stack([np.cos(angle), np.sin(angle)])
    return center + ray, sweep * np.column_stack([-ray[:, 1], ray[:, 0]])


def jacobians(mesh, quad, n=9):
    """Determinant of the element's map, whose edges are blended linearly into it, on a grid of n by n points."""
    t = np.linspace(0, 1, n)
    (bottom, d_bottom), (right, d_right) = edge_curve(mesh, quad[0], quad[1], t), edge_curve(mesh, quad[1], quad[2], t)
    (top, d_top), (left, d_left) = edge_curve(mesh, quad[3], quad[2], t), edge_curve(mesh, quad[0], quad[3], t)
    c = mesh.nodes[quad]
    s, r = t[:, None, None], t[None, :, None]  # along bottom, along left
    by_s = ((1 - r) * d_bottom[:, None] + r * d_top[:, None] + (right - left)[None]
            - ((1 - r) * (c[1] - c[0]) + r * (c[2] - c[3])))
    by_r = ((top - bottom)[:, None] + (1 - s) * d_left[None] + s * d_right[None]
            - ((1 - s) * (c[3] - c[0]) + s * (c[2] - c[1])))
    return by_s[..., 0] * by_r[..., 1] - by_s[..., 1] * by_r[..., 0]


def check_shapes(mesh):
    """Smallest ratio of the Jacobian's minimum to its maximum over the elements. Raises Refused for an inverted one."""
    worst = 1.0
    for quad in mesh.quads:
        values = jacobians(mesh, quad)
        ratio = values.min() / values.max() if values.max() > 0 else -1.0
        if ratio <= 0:
            raise Refused(f"the element about {place(mesh.nodes[quad].mean(axis=0))} is inverted or degenerate: its Jacobian falls to {values.min():g}; allowed: "
                          "convex quadrilaterals, also with their edges as arcs (a finer or smoother mesh there)")
        worst = min(worst, ratio)
    return worst
