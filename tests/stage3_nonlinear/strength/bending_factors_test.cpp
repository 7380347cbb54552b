// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/bending_factors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fastjoint::stage3 {
namespace {

// Schijve's formula for equal sheets.
double equal_sheets(double thickness, double modulus, double N, double overlap) {
  const double beta = std::sqrt(N / (8 * modulus * std::pow(thickness, 3) / 12));
  return 3 / (1 + 2 * std::sqrt(2) * std::tanh(beta * overlap / 2));
}

TEST(SecondaryBending, OfEqualSheetsIsSchijvesFormula) {
  for (const double N : {1e-6, 10.0, 100.0, 1e6})
    for (const double overlap : {0.0, 20.0, 1000.0})
      for (const double factor : bending_factors({1.6, 1.6}, {72400, 72400}, N, overlap))
        EXPECT_NEAR(factor, equal_sheets(1.6, 72400, N, overlap), 1e-12) << N << " " << overlap;
}

// Without an overlap the neutral line jumps from sheet to sheet and keeps its slope: |A_1| + |A_2| = (t_1 + t_2) / 2,
// alpha_1 A_1 = -alpha_2 A_2.
TEST(SecondaryBending, OfASingleRowSharesTheEccentricityByTheBendingLengths) {
  const double t1 = 2, t2 = 3, E1 = 70000, E2 = 210000;
  const auto [k1, k2] = bending_factors({t1, t2}, {E1, E2}, 50, 0);
  const double A1 = k1 * t1 / 6, A2 = k2 * t2 / 6;
  EXPECT_NEAR(A1 + A2, (t1 + t2) / 2, 1e-12);
  EXPECT_NEAR(A1 / A2, std::sqrt(E1 * std::pow(t1, 3) / (E2 * std::pow(t2, 3))), 1e-12);
}

// A long overlap decouples its ends: w_o = A_1 + e_1 decays there as outside, so that alpha_1 A_1 = beta (e_1 - A_1).
TEST(SecondaryBending, OfALongOverlapIsThatOfEachEndAlone) {
  const double t1 = 2, t2 = 3, modulus = 70000, N = 500, e1 = 1.5;
  const double alpha = std::sqrt(N / (modulus * t1 * t1 * t1 / 12)), beta = std::sqrt(N / (modulus * 125 / 12));
  EXPECT_NEAR(bending_factors({t1, t2}, {modulus, modulus}, N, 1e5)[0], 6 / t1 * beta * e1 / (alpha + beta), 1e-12);
}

}  // namespace
}  // namespace fastjoint::stage3
