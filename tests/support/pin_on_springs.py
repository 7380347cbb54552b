# SPDX-License-Identifier: GPL-3.0-or-later
"""A rigid pin on springs in the hole of an infinite sheet, by Fourier series of Lekhnitskii's potentials on the rim.

Independent of the programs: displacements and stresses are those of the potentials themselves. Lekhnitskii, Anisotropic Plates,
Gordon and Breach 1968, sections 31 and 37: sigma_x = 2 Re sum mu_k^2 Phi_k', sigma_y = 2 Re sum Phi_k',
tau_xy = -2 Re sum mu_k Phi_k', u = 2 Re sum p_k Phi_k, v = 2 Re sum q_k Phi_k, Phi_k a function of z_k = x + mu_k y. Around the hole
Phi_k = A_k log zeta_k + sum over m >= 1 of B_km zeta_k^-m with zeta_k = e^(i theta) on the rim.
"""
import numpy as np


def compliance(E1, E2, G12, nu12, angle=0):
    """Strains (x, y, shear) by stresses in axes from which axis 1 stands `angle` degrees counter-clockwise, shape (3, 3)."""
    own = np.array([[1 / E1, -nu12 / E1, 0], [-nu12 / E1, 1 / E2, 0], [0, 0, 1 / G12]])
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turn = np.array([[c * c, s * s, 2 * c * s], [s * s, c * c, -2 * c * s], [-c * s, c * s, c * c - s * s]])
    return turn.T @ own @ turn


def isotropic(E, nu):
    """Compliance of an isotropic sheet but for 1e-5 of it: equal roots mu_k would need other potentials."""
    return compliance(E, E * (1 + 1e-5), E / (2 * (1 + nu)), nu)


def rim_angles(n):
    return 2 * np.pi * np.arange(n) / n


class WideSheet:
    """An infinite sheet of unit thickness with a hole of radius 1 about the origin."""

    def __init__(self, S):
        """S is its compliance, shape (3, 3)."""
        roots = np.roots([S[0, 0], -2 * S[0, 2], 2 * S[0, 1] + S[2, 2], -2 * S[1, 2], S[1, 1]])
        self.S, self.mu = S, roots[roots.imag > 0]
        self.p = S[0, 0] * self.mu**2 + S[0, 1] - S[0, 2] * self.mu
        self.q = S[0, 1] * self.mu + S[1, 1] / self.mu - S[1, 2]

    def under(self, X, Y):
        """u_x, u_y and hoop stress at n equal steps around the rim, by tractions X, Y there, each of shape (n, columns)."""
        n = len(X)
        m = np.arange(1, n // 2)
        theta = rim_angles(n)[:, None]
        X, Y = np.fft.fft(X, axis=0) / n, np.fft.fft(Y, axis=0) / n
        # -X = d/dtheta 2 Re sum mu_k Phi_k and Y = d/dtheta 2 Re sum Phi_k, wave e^(-i m theta) by wave
        by_x, by_y = X[-m] / (1j * m[:, None]), -Y[-m] / (1j * m[:, None])
        first = (by_x - self.mu[1] * by_y) / (self.mu[0] - self.mu[1])
        # the resultant: its two conditions, and displacements that come back to themselves
        rows = [[part for k in (0, 1) for part in (2 * (1j * v[k]).real, 2 * (-v[k]).real)]
                for v in (self.mu, np.ones(2), self.p, self.q)]
        A = np.linalg.solve(rows, np.array([-X[0].real, Y[0].real, 0 * X[0].real, 0 * X[0].real]))
        u_x, u_y, hoop = 0, 0, 0
        for B, log, mu, p, q in zip((first, by_y - first), (A[0] + 1j * A[1], A[2] + 1j * A[3]), self.mu, self.p, self.q):
            waves = np.zeros(X.shape, complex)
            waves[-m] = B
            Phi = np.fft.ifft(waves, axis=0) * n
            waves[-m] = -1j * m[:, None] * B
            waves[0] = 1j * log
            slope = np.fft.ifft(waves, axis=0) * n / (mu * np.cos(theta) - np.sin(theta))  # Phi'
            u_x = u_x + 2 * (p * Phi).real
            u_y = u_y + 2 * (q * Phi).real
            hoop = hoop + 2 * ((mu * np.sin(theta) + np.cos(theta))**2 * slope).real
        return u_x, u_y, hoop

    def normal_and_hoop(self, pressure):
        """Normal displacement and hoop stress by pressures at n equal steps around the rim, shape (n, columns)."""
        theta = rim_angles(len(pressure))[:, None]
        u_x, u_y, hoop = self.under(pressure * np.cos(theta), pressure * np.sin(theta))
        return u_x * np.cos(theta) + u_y * np.sin(theta), hoop

    def open_hole(self, n=720):
        """Hoop stress at n equal steps around the rim by remote tension 1 along x."""
        theta = rim_angles(n)
        return self.under(np.cos(theta)[:, None], np.zeros((n, 1)))[2][:, 0] + np.sin(theta)**2

    def pin(self, force, modulus, gap, n_waves=48):
        """Half-angle of contact in degrees, peak pressure and peak hoop stress of a pin that a force along x presses on springs."""
        n, n_fine = 32 * n_waves, 16384
        w, D = self._long_waves(force, modulus, gap, n_waves, n)
        # Shorter waves follow from the pressure, by turns, damped by what springs that also pull would make of them.
        theta = rim_angles(n_fine)
        order = np.abs(np.rint(np.fft.fftfreq(n_fine, 1 / n_fine)))
        waves = np.zeros(n_fine, complex)
        waves[0] = w[0]
        waves[1:n_waves + 1] = (w[1:n_waves + 1] - 1j * w[n_waves + 1:]) / np.sqrt(2)
        waves[-n_waves:] = np.conj(waves[1:n_waves + 1])[::-1]
        probe = np.cos(n_waves * rim_angles(512))[:, None]
        softness = 2 * np.mean(self.normal_and_hoop(probe)[0] * probe) * n_waves
        damping = np.where(order > n_waves, 1 / (1 + modulus * softness / np.maximum(order, 1)), 0)
        for _ in range(8):
            pressure = modulus * np.maximum(np.fft.ifft(waves).real * n_fine - gap, 0)
            u_n, hoop = self.normal_and_hoop(pressure[:, None])
            made = D[0] * np.cos(theta) + D[1] * np.sin(theta) - u_n[:, 0]
            waves += damping * (np.fft.fft(made) / n_fine - waves)
        return 180 * np.mean(pressure > 0), pressure.max(), hoop.max()

    def _long_waves(self, force, modulus, gap, n_waves, n):
        """Waves 1, sqrt 2 cos, sqrt 2 sin of the disc's normal displacement against the sheet, and the disc's own, by Newton's
        method."""
        def basis(points):
            angles = np.outer(rim_angles(points), np.arange(1, n_waves + 1))
            return np.hstack([np.ones((points, 1)), np.sqrt(2) * np.cos(angles), np.sqrt(2) * np.sin(angles)])

        few, phi = basis(8 * n_waves), basis(n)
        L = few.T @ self.normal_and_hoop(few)[0] / len(few)
        directions = phi.T @ np.stack([np.cos(rim_angles(n)), np.sin(rim_angles(n))], 1) / n
        size = phi.shape[1]

        def residual(z):
            p = modulus * phi.T @ np.maximum(phi @ z[:size] - gap, 0) / n
            return np.r_[z[:size] - directions @ z[size:] + L @ p, directions.T @ p / modulus - [force / (2 * np.pi * modulus), 0]]

        D = np.array([force / (np.pi * modulus) + max(gap, 0), 0])
        z = np.r_[directions @ D, D]
        r = residual(z)
        for _ in range(100):
            if np.abs(r).max() < 1e-12 * np.abs(z).max():
                return z[:size], z[size:]
            touching = phi[phi @ z[:size] > gap]
            slope = modulus * touching.T @ touching / n
            J = np.zeros((size + 2, size + 2))
            J[:size, :size] = np.eye(size) + L @ slope
            J[:size, size:] = -directions
            J[size:, :size] = directions.T @ slope / modulus
            step, part = np.linalg.solve(J, r), 1.0
            while part > 1e-3 and np.linalg.norm(residual(z - part * step)) >= np.linalg.norm(r):
                part /= 2
            z = z - part * step
            r = residual(z)
        raise AssertionError("the pin on springs did not converge")
