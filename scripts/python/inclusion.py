# SPDX-License-Identifier: GPL-3.0-or-later
"""A disc in a sheet so large that it is infinite to 1e-6, under remote tension: Bortman & Szabo, section 5, (30), (31).

At the rim, 4 sigma_rr / s = A + B cos 2 theta. Closed forms are those of docs/theory.md, section 3.3: springs with
kappa = k a / E_P; the elastic disk without friction has the same A with kappa = beta / (1 - nu_D) and B_b's formula with
kappa = 3 beta / (3 + nu_D), beta = E_D / E_P.
"""
import numpy as np

from sheet import Sheet

NU = 0.3
HALF_WIDTH = 4000  # radii: the border then matters by its inverse square
BETAS = (0.1, 1 / 3, 0.5, 1, 2, 3, 5, 10)


def mean(kappa):
    return 4 * kappa / (1 + kappa * (1 + NU))


def second(kappa):
    return 8 * kappa / (1 + kappa * (5 - NU) / 3)


def springs(beta):
    """A_b, B_b for the law of plane stress, (29)."""
    return mean(beta / (1 - NU)), second(beta / (1 - NU))


def disk(beta):
    """A_a, B_a of the elastic disk."""
    return mean(beta / (1 - NU)), second(3 * beta / (3 + NU))


def sheet(beta, law="plane stress"):
    """Quarter of the sheet with the disc held, under unit remote tension."""
    return Sheet({"analysis": "plane stress", "disc_directions": ["x"], "materials": {"sheet": {"E": 1.0, "nu": NU}},
                  "geometry": {"grid": {"x": [0, HALF_WIDTH], "y": [0, HALF_WIDTH], "thickness": 1}},
                  "holes": [{"id": "disc", "center": [0, 0], "radius": 1, "rings": 20,
                             "spring": {"disk": {"E": beta, "nu": NU, "law": law}}}],
                  "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
                  "external": [{"id": "s", "on": "right", "direction": "x", "kind": "traction"}], "p": [8, 8]},
                 {"s": HALF_WIDTH})


def harmonics(solved):
    """A and B of a solved sheet, from sigma_rr at the rim."""
    theta, radial, _, _ = solved.rim("disc")
    even = np.column_stack([np.cos(2 * m * theta) for m in range(6)])
    return 4 * np.linalg.lstsq(even, radial, rcond=None)[0][:2]
