// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "common/formats/plate_solution.hpp"

namespace fastjoint::stage2 {

/// S = K_cc + K_cf U, shape (nc, nc), force / length: the energy products of the unit fields, whose error is the
/// product of two energy-norm errors. Integrating the stresses along the boundaries instead would converge at half the
/// rate. S_ij is the force on i per displacement of j. Not made symmetric: how far it is from that is a check of the
/// solution. Where rounding is all that is left of K_cc, as of a sheet that one disc alone holds, S is zero. Theory:
/// Babuska & Miller, Int. J. Numer. Meth. Engng 20, 1085 (1984).
[[nodiscard]] Eigen::MatrixXd condensed_stiffness(const formats::PlateSolution& plate, std::size_t level);

}  // namespace fastjoint::stage2
