// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::bench {

enum class Family { lap, doubler, stack, discs, weak, contact, friction };
inline constexpr std::array family_names{"lap joint",     "floating doubler",     "stack of three", "discs in x and y",
                                         "near-singular", "load ends at contact", "friction"};

/// A force and its slope by delta.
struct Force {
  double F, slope;
};

/// A law as F(delta), delta >= 0, written down anew beside stage 3's own form in the contact coordinate.
struct Curve {
  std::shared_ptr<const stage3::Law> law;
  std::function<Force(double delta, double clearance)> at;
};

/// A joint whose laws never fall. The same seed gives the same joint.
struct RandomJoint {
  std::uint32_t seed = 0;
  Family family = Family::lap;
  double ratio = 1;  ///< stiffness of the laws over that of the plates
  stage3::JointEquations equations;
  std::vector<Curve> curves;  ///< of the planes
  Eigen::VectorXd exact;      ///< forces, where the load was made from the solution, else empty
  [[nodiscard]] double force_scale() const { return equations.q.cwiseAbs().maxCoeff(); }
};

/// 3 to 100 shear planes, stiffness ratios 1e-4 to 1e4, clearances of 1e-4 to 1e4 of the plates' own displacement.
[[nodiscard]] RandomJoint random_joint(std::uint32_t seed);

/// 1 to 3 fasteners in a lap joint with cubics of which some fall, so that there may be several solutions or none.
[[nodiscard]] stage3::JointEquations random_falling_joint(std::uint32_t seed);

}  // namespace fastjoint::bench
