// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>

#include "stage3_nonlinear/path/load_path.hpp"

namespace fastjoint::stage3 {

/// Solved state. If it is on a corner and at the start of an interval, the corner counts as passed.
struct Sample {
  double load;
  VectorXd c;
  Eigen::VectorXi passed;  ///< ContactCorners::passed
};

/// dc / d load factor at a state, (r), force; not finite if the tangent is singular.
[[nodiscard]] VectorXd rate(const JointEquations& equations, const Sample& at);

/// Search for the load factor at which rims begin or cease to touch (docs/theory.md, section 8.7).
class TouchSearch {
 public:
  /// @param equations, corners Outlive this.
  TouchSearch(const JointEquations& equations, const ContactCorners& corners)
      : equations_(equations), corners_(corners) {}

  /// True if two states differ only by rims that touch in one of them.
  [[nodiscard]] bool make_the_difference(const Sample& a, const Sample& b) const;
  /// Load factor between two such states slightly past that at which the first of these rims ceases to touch, estimated
  /// from the rate of its depth where it touches; the interval then becomes much shorter. The position of a bolt that
  /// does not touch is indeterminate and gives no estimate. None if the last estimate left nearly the whole interval:
  /// bisection is then better.
  [[nodiscard]] std::optional<double> place_between(const Sample& a, const Sample& b);

 private:
  /// Load beyond the touch of a rim: the depth is a power of it, whose exponent follows from two states.
  /// @param ratio Depth over its rate by the load factor: the load beyond the touch over the exponent.
  double load_from_touch(Index entry, double load, double ratio);

  const JointEquations& equations_;
  const ContactCorners& corners_;
  double last_length_ = 0;                           ///< of the interval of the last estimate
  std::map<Index, std::pair<double, double>> last_;  ///< of each rim's entry: load factor and ratio
};

}  // namespace fastjoint::stage3
