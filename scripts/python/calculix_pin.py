# SPDX-License-Identifier: GPL-3.0-or-later
"""A rigid pin on springs that only push in the hole of a square sheet, by CalculiX (`ccx`) with its elements CPS8.

Independent of the programs: a polar mesh of its own, and a nonlinear spring at each node of the rim with the consistent
weight of a quadratic edge. The pin stands; the loads on the sheet's left and right edge press the rim against it.
"""
import re
import shutil
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from timed_runs import run

# A material of no element: without it ccx 2.20 takes the springs for linear.
PLASTIC = "*MATERIAL, NAME=PLASTIC\n*ELASTIC\n1., 0.\n*PLASTIC\n1e9, 0.\n"
# Of the sheet, in mm: ccx makes solid elements of those in plane stress, where thicker ones shear across the sheet: its
# hoop stresses would tend to a peak 1.7 % too high at 1 mm. Loads and springs are in proportion.
THICKNESS = 0.01
FAR = 1e4  # mm of each spring, along its radius: they do not turn
GRADING = 2.5  # the outermost step of log r is e^2.5 times the innermost


@dataclass(frozen=True)
class Pin:
    """Radius of the hole and thickness are 1 mm; moduli in N/mm^2, the springs' per mm; the force in N along x."""
    E: float
    nu: float
    modulus: float
    gap: float
    force: float
    half_width: float

    def start(self):
        """How far (mm) the pin stands off towards its bearing side: it touches from the first iteration on."""
        return 2 * self.gap + self.force / self.E


@dataclass
class Found:
    """Wall seconds of ccx; the force of the springs along x in N; peak pressure and nodal hoop stress in N/mm^2."""
    seconds: float
    force: float
    pressure: float
    hoop: float


def is_there():
    return shutil.which("ccx") is not None


class Mesh:
    """n elements around the hole and n // 4 outwards, from a circle to the square; node numbers from 1."""

    def __init__(self, n, half_width):
        self.n, layers = n, n // 4
        at = np.linspace(0, 1, layers + 1)
        radii = half_width ** (np.expm1(GRADING * at) / np.expm1(GRADING))
        self.radii = np.empty(2 * layers + 1)
        self.radii[::2], self.radii[1::2] = radii, (radii[1:] + radii[:-1]) / 2
        self.theta = np.pi * np.arange(2 * n) / n
        ray = np.exp(1j * self.theta)
        square = 1 / np.maximum(np.abs(ray.real), np.abs(ray.imag)) - 1
        blend = (self.radii - 1) / (half_width - 1)
        self.nodes = (self.radii[:, None] * (1 + blend[:, None] * square) * ray).ravel()  # centres of elements too

    def at(self, layer, ray):
        return 2 * self.n * layer + ray % (2 * self.n) + 1

    def elements(self):
        """Corners counter-clockwise, then the middles of the sides."""
        for j in range(0, len(self.radii) - 1, 2):
            for i in range(0, 2 * self.n, 2):
                places = (0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)
                yield [self.at(j + dj, i + di) for dj, di in places]

    def rim(self):
        """Node, angle and length of the rim that is its share."""
        for i, theta in enumerate(self.theta):
            yield self.at(0, i), theta, 2 * np.pi / self.n * (1 / 3 if i % 2 == 0 else 2 / 3)

    def edge_loads(self, force, half_width):
        """Nodes of both edges across x, and the load along x of each; half of the force is on either edge."""
        last = len(self.radii) - 1
        for middle in (0, self.n):
            corners = range(middle - self.n // 4, middle + self.n // 4, 2)
            for first in corners:
                three = [self.at(last, first + k) for k in range(3)]
                length = abs(self.nodes[three[2] - 1].imag - self.nodes[three[0] - 1].imag)
                for node, share in zip(three, (1 / 6, 4 / 6, 1 / 6)):
                    yield node, force / 2 * share * length / (2 * half_width)


def lines(rows):
    """Real numbers in 19 characters: ccx reads 20."""
    cells = ([f"{cell:.12e}" if isinstance(cell, float) else str(cell) for cell in row] for row in rows)
    return "".join(", ".join(row) + "\n" for row in cells)


def springs_text(mesh, pin, first):
    """One at each node of the rim, numbers from `first` on: pairs of a force (N) and a radial displacement (mm)."""
    text = ""
    for number, (node, theta, length) in enumerate(mesh.rim(), first):
        ground, touch = (1 - FAR) * np.exp(1j * theta), pin.start() * np.cos(theta) - pin.gap
        text += "*NODE, NSET=GROUND\n" + lines([(number, ground.real, ground.imag)])
        text += (f"*ELEMENT, TYPE=SPRINGA, ELSET=S{node}\n{number}, {number}, {node}\n"
                 f"*SPRING, ELSET=S{node}, NONLINEAR\n")
        text += lines([(-pin.modulus * length * THICKNESS, touch - 1.0), (0.0, touch), (0.0, touch + 1.0)])
    return text


def input_text(mesh, pin):
    elements = list(mesh.elements())
    nodes = [(k, mesh.nodes[k - 1].real, mesh.nodes[k - 1].imag) for k in np.unique(elements)]
    return ("*NODE\n" + lines(nodes)
            + "*ELEMENT, TYPE=CPS8, ELSET=SHEET\n" + lines([k, *element] for k, element in enumerate(elements, 1))
            + "*NSET, NSET=RIM\n" + lines([node] for node, *_ in mesh.rim())
            + "*MATERIAL, NAME=M\n*ELASTIC\n" + lines([(pin.E, pin.nu)])
            + f"*SOLID SECTION, ELSET=SHEET, MATERIAL=M\n{THICKNESS}\n"
            + PLASTIC + springs_text(mesh, pin, len(mesh.nodes) + 1)
            + "*BOUNDARY\nGROUND, 1, 3\n" + lines((node, 2, 2) for node in (mesh.at(0, 0), mesh.at(0, mesh.n)))
            + "*STEP\n*STATIC, DIRECT\n1., 1.\n*CLOAD\n"
            + lines((node, 1, -load * THICKNESS) for node, load in mesh.edge_loads(pin.force, pin.half_width))
            + "*NODE FILE, OUTPUT=2D, NSET=RIM\nU\n*EL FILE, NSET=RIM\nS\n*END STEP\n")


def block(text, name):
    """Numbers of a block of a .frd file by node."""
    body = re.search(rf"^ -4  {name} .*?^ -3", text, re.M | re.S)[0]
    return {int(line[3:13]): np.array([float(line[k:k + 12]) for k in range(13, len(line) - 11, 12)])
            for line in body.splitlines() if line.startswith(" -1")}


def solve(folder, n, pin):
    """With n elements around the hole, a multiple of 8."""
    mesh = Mesh(n, pin.half_width)
    path = folder / f"pin_{n}"
    path.with_suffix(".inp").write_text(input_text(mesh, pin))
    begin = perf_counter()
    run("ccx", path.name, folder=folder)
    seconds = perf_counter() - begin
    text = path.with_suffix(".frd").read_text()
    displacement, stress = block(text, "DISP"), block(text, "STRESS")
    force, pressure, hoop = 0, [], []
    for node, theta, length in mesh.rim():
        c, s = np.cos(theta), np.sin(theta)
        u, (xx, yy, _, xy, *_) = displacement[node], stress[node]
        pressure.append(pin.modulus * max(pin.start() * c - pin.gap - u[0] * c - u[1] * s, 0))
        force += pressure[-1] * length * c
        hoop.append(xx * s * s + yy * c * c - 2 * xy * s * c)
    return Found(seconds, force, max(pressure), max(hoop))
