// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/bending_factors.hpp"

#include <Eigen/LU>
#include <cmath>

namespace fastjoint::stage3 {

std::array<double, 2> bending_factors(const std::array<double, 2>& t, const std::array<double, 2>& E, double N,
                                      double overlap) {
  const double apart = (t[0] + t[1]) / 2;  // of the neutral lines of the sheets
  const double tensile = E[0] * t[0] + E[1] * t[1];
  const std::array offset = {apart * E[1] * t[1] / tensile, apart * E[0] * t[0] / tensile};  // from that of the overlap
  double both = 0;
  std::array<double, 2> alpha{};
  for (const std::size_t i : {0, 1}) {
    const double bending = E[i] * std::pow(t[i], 3) / 12;
    alpha[i] = std::sqrt(N / bending);
    both += bending + E[i] * t[i] * offset[i] * offset[i];
  }
  const double beta = std::sqrt(N / both), T = std::tanh(beta * overlap / 2);
  // The distance w of the neutral line from the line of the load is A_1 exp(alpha_1 (x + L)) and A_2 exp(-alpha_2 (x -
  // L)) outside, and (m cosh(beta x) + (s / beta) sinh(beta x)) / cosh(beta L) in the overlap; at x = -L, L it jumps by
  // the offsets, its slope does not.
  Eigen::Matrix2d slopes;
  slopes << alpha[0] + beta * T, -(1 + alpha[0] * T / beta), alpha[1] + beta * T, 1 + alpha[1] * T / beta;
  const Eigen::Vector2d w = slopes.partialPivLu().solve(Eigen::Vector2d(alpha[0] * offset[0], -alpha[1] * offset[1]));
  const std::array A = {w[0] - w[1] * T / beta - offset[0], w[0] + w[1] * T / beta + offset[1]};
  return {6 * std::abs(A[0]) / t[0], 6 * std::abs(A[1]) / t[1]};
}

}  // namespace fastjoint::stage3
