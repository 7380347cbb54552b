// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/model/joint_model.hpp"

namespace fastjoint::stage3 {

/// Stress intensity factors of a plate's t crack tips, stress length^1/2.
struct CrackState {
  VectorXd K_I, K_II;              ///< (t)
  VectorXd K_I_waves, K_II_waves;  ///< (t) estimated parts of the waves of contact that the elements leave out
};

/// @param coefficients Amplitudes of the unit cases of the plate's file.
[[nodiscard]] CrackState crack_state(const PlateModel& plate, const VectorXd& coefficients);

/// Estimates the error of the last value of a sequence of rising degrees, >= 0; infinite for a single value.
///
/// On meshes graded towards a tip errors fall geometrically with the degree (Szabo & Babuska 1991, section 10.2), so
/// the last difference d and its ratio q to the one before make d q / (1 - q) (docs/theory.md, section 11.7).
[[nodiscard]] double geometric_error(const VectorXd& values);

}  // namespace fastjoint::stage3
