# SPDX-License-Identifier: GPL-3.0-or-later
"""Stress concentration of an open hole in a strip, without finite elements: boundary collocation of complex potentials.

phi(z) and psi(z) are odd Laurent series with real coefficients (two lines of symmetry); the tractions on hole, free edge and
loaded end are met in the least-squares sense. Muskhelishvili 1953, section 32: sigma_x + sigma_y = 4 Re phi',
sigma_y - sigma_x + 2 i tau_xy = 2 (conj(z) phi'' + psi').
"""
import numpy as np


def powers(z, exponents, scale):
    """z^(k-1) k and its derivative for each k; positive powers over scale^k, so that they are of order 1 at the border."""
    k = exponents[None, :]
    size = np.where(k > 0, scale ** np.maximum(k, 0), 1.0)
    z = z[:, None]
    return k * z ** (k - 1) / size, k * (k - 1) * z ** (k - 2) / size


def stresses(z, exponents, scale):
    """sigma_x, sigma_y, tau_xy per coefficient of phi, then psi, each (n_points, 2 n_exponents)."""
    first, second = powers(z, exponents, scale)
    mean = np.hstack([4 * first.real, np.zeros(first.shape)])
    turning = np.hstack([2 * np.conj(z)[:, None] * second, 2 * first])
    return (mean - turning.real) / 2, (mean + turning.real) / 2, turning.imag / 2


def concentration(ratio, length=3.0, n_terms=25, n_points=400):
    """Peak stress over the gross stress of a strip of width W = d / ratio and half length `length` W / 2."""
    half_width = 1 / ratio
    exponents = np.arange(-2 * n_terms + 1, 2 * n_terms, 2)
    scale = half_width * np.hypot(length, 1)
    share = (1 - np.cos(np.pi * (np.arange(n_points) + 0.5) / n_points)) / 2  # denser towards both ends
    hole = np.exp(1j * np.pi / 2 * share)
    top, end = half_width * (length * share + 1j), half_width * (length + 1j * share)
    x, y, xy = stresses(hole, exponents, scale)
    c, s = hole.real[:, None], hole.imag[:, None]
    rows = [x * c**2 + y * s**2 + 2 * xy * c * s, (y - x) * c * s + xy * (c**2 - s**2)]
    rows += stresses(top, exponents, scale)[1:]
    rows += stresses(end, exponents, scale)[::2]
    A = np.vstack(rows)
    wanted = np.zeros(len(A))
    wanted[4 * n_points:5 * n_points] = 1  # sigma_x at the loaded end
    size = np.abs(A).max(axis=0)
    coefficients = np.linalg.lstsq(A / size, wanted, rcond=1e-14)[0] / size
    return (stresses(np.array([1j]), exponents, scale)[0] @ coefficients)[0]
