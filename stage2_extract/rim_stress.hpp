// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage2_extract/rim_points.hpp"
#include "stage2_extract/unit_fields.hpp"

namespace fastjoint::stage2 {

/// Stress at one point of the rim of a hole in every unit case, shape (3, n_cases): sigma_rr, sigma_tt, sigma_rt, mean
/// of the sides that meet there.
///
/// The tractions on a rim are known: sigma_rr = k (u.n - D.n) by the springs, equation (6), or the pressure of a
/// bearing load, and sigma_rt is the friction's. What is left of the strains, eps_tt, needs only derivatives along the
/// rim; the material's law then gives sigma_tt. So no derivative across the rim comes in. tests/bench/rim_stress.cpp
/// compares this with the plain stress, patch recovery and harmonics of the displacement; a laminate gains most by it.
[[nodiscard]] Eigen::MatrixXd rim_stress(const UnitFields& fields, std::size_t hole, const RimPoint& point);

}  // namespace fastjoint::stage2
