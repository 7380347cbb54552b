// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace fastjoint::stage3 {

/// Bending stress over membrane stress of both sheets of a single lap at its outer rows of fasteners, by the neutral
/// line: J. Schijve, Some elementary calculations on secondary bending in simple lap joints, NLR TR 72036 U, 1972; for
/// equal sheets 3 / (1 + 2 sqrt(2) tanh(beta L)), beta^2 = N / (8 D) with the bending stiffness D of one of them. The
/// overlap between the outer rows, 2 L long, bends as one beam of both sheets, the sheets outside it are long, and
/// nothing supports the lap against bending.
/// @param t Thicknesses, > 0, length. @param E Moduli, > 0, stress.
/// @param N Tension per width, > 0, force / length. @param overlap 2 L, >= 0, length.
[[nodiscard]] std::array<double, 2> bending_factors(const std::array<double, 2>& t, const std::array<double, 2>& E,
                                                    double N, double overlap);

}  // namespace fastjoint::stage3
