// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <complex>

namespace fastjoint::stage3 {

/// A beam without loads between its ends, under a tension that stiffens it, or a compression.
struct BeamColumn {
  double EI;      ///< force length^2
  double N;       ///< tension, force
  double length;  ///< length

  /// Exact stiffness, (4, 4), by w0, w0', w1, w1': forces across it and moments that act on its ends. Hyperbolic for
  /// tension, circular for compression, a series where N is small (S. P. Timoshenko, J. M. Gere, Theory of elastic
  /// stability, 2nd edition, 1961, sections 1.11 and 2.2).
  [[nodiscard]] Eigen::Matrix4d stiffness() const { return at(N).real(); }
  /// Derivative of the stiffness by N, (4, 4): half of u^T K_N u is the shortening, the integral of w'^2 / 2, since the
  /// energy u^T K u / 2 is stationary in w.
  [[nodiscard]] Eigen::Matrix4d by_tension() const;

 private:
  [[nodiscard]] Eigen::Matrix4cd at(std::complex<double> tension) const;
};

}  // namespace fastjoint::stage3
