// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <utility>

#include "stage3_nonlinear/path/load_path.hpp"

namespace fastjoint::stage3 {

/// Solved state; what its planes have passed is so just behind it if it begins an interval.
struct Sample {
  double load;
  VectorXd c;
  Eigen::VectorXi passed;  ///< ContactCorners::passed
};

/// dc / d load factor at a state, (r), force; not finite where there is none.
[[nodiscard]] VectorXd rate(const JointEquations& equations, const Sample& at);

/// Search of the load factor at which rims begin to touch or cease to (docs/theory.md, section 8.7).
class TouchSearch {
 public:
  /// @param equations, corners Outlive this.
  TouchSearch(const JointEquations& equations, const ContactCorners& corners)
      : equations_(equations), corners_(corners) {}

  /// True if two states differ, and by rims alone that touch in one of them.
  [[nodiscard]] bool make_the_difference(const Sample& a, const Sample& b) const;
  /// Load factor between two such states by which the first of these rims ceases to touch, and a little more, so that
  /// either state comes much closer: by the rate at which it is pressed in where it touches. A bolt that does not touch
  /// lies anywhere and tells nothing. None if the last place left nearly the whole interval: then half of it is better.
  [[nodiscard]] std::optional<double> place_between(const Sample& a, const Sample& b);

 private:
  /// Load from the touch of a rim: depths grow as a power of it, whose exponent two places tell.
  /// @param ratio Of the depth to its rate by the load factor: the load from the touch over the exponent.
  double load_from_touch(Index entry, double load, double ratio);

  const JointEquations& equations_;
  const ContactCorners& corners_;
  double last_length_ = 0;                           ///< of the interval in which a place was last asked for
  std::map<Index, std::pair<double, double>> last_;  ///< of each rim's entry: load factor and ratio
};

}  // namespace fastjoint::stage3
