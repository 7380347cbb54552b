// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage2_extract/stresses/rim_points.hpp"
#include "stage2_extract/stresses/unit_fields.hpp"

namespace fastjoint::stage2 {

/// Stress at one point of the rim of a hole in every unit case, shape (3, n_cases): sigma_rr, sigma_tt, sigma_rt, mean
/// of the sides that meet there.
///
/// sigma_rr and sigma_rt are the known tractions of springs, bearing load and friction; sigma_tt follows from them and
/// the strain along the rim by the material's law, without a derivative across the rim (docs/theory.md, section 11.1).
/// tests/bench/rim_stress.cpp compares this with three other ways.
[[nodiscard]] Eigen::MatrixXd rim_stress(const UnitFields& fields, std::size_t hole, const RimPoint& point);

}  // namespace fastjoint::stage2
