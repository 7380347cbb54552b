// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

/// A vector in the one or two directions of the discs, and a matrix of such.
using PlaneVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2, 1>;
using PlaneMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2>;

/// A slider of a shear plane after an increment.
struct Slider {
  PlaneVector set;          ///< what it has moved, length
  PlaneVector motion;       ///< in the last increment; 0 where that is rounding
  double dissipated = 0.0;  ///< by all of its motion so far, force x length
};

/// State of a shear plane with a law that remembers.
struct RememberedState {
  PlaneVector F, delta;    ///< force, length
  PlaneMatrix dF, ddelta;  ///< by c, symmetric; dimensionless, length / force
  std::vector<Slider> sliders;
};

/// The state at which F + k delta = c, from the sliders before the increment (docs/theory.md, section 8.9).
///
/// Each branch is an elastic part in series with a slider that moves under its force less its backstress where that
/// exceeds its limit. Of an increment delta its potential is the least over the slider's set s of
///   elastic energy(delta - s) + backstress energy(s) + limit |s - s before|,
/// which is convex in delta: so is the joint's, and the solution of an increment is unique.
/// @param like Law::branches with the clearance. @param start A displacement near the solution, length.
/// @param one_sided The elastic parts push for positive displacements only; of one direction.
[[nodiscard]] RememberedState remembered(const std::vector<MemoryBranch>& branches, const std::vector<Slider>& before,
                                         const PlaneVector& c, double k, const PlaneVector& start,
                                         bool one_sided = false);

}  // namespace fastjoint::stage3
