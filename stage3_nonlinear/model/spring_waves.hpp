// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/formats/plate_matrices.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Cosine pressure, of peak 1, at an angle on the half of a rim around a direction.
[[nodiscard]] double cosine_bearing(double angle, double direction);
/// The friction shear on the sheet per unit of that pressure; its resultant points along the direction.
[[nodiscard]] double cosine_friction(double angle, double direction);

/// Short waves of the disc's normal displacement relative to the sheet at a rim with linear springs on given arcs, in
/// closed form: w_s = -(D p)_s with p = K w on the arcs, plus the part by friction (docs/theory.md, section 6.3).
struct SpringWaves {
  rim::Harmonics full;   ///< the long waves, then the short ones
  MatrixXd by_long;      ///< (n_short, n_long) by the long waves, dimensionless
  MatrixXd by_friction;  ///< (n_short, 4) by the peak of cosine friction along each quarter turn, length / stress
  bool only_friction;    ///< by_long is zero: springs all around a hole in an isotropic sheet couple no waves
};

/// The short waves of each rim; equal rims have one object in common, a rim without springs or closed form has none.
[[nodiscard]] std::vector<std::shared_ptr<const SpringWaves>> spring_waves(const std::vector<formats::WaveRim>& rims);

}  // namespace fastjoint::stage3
