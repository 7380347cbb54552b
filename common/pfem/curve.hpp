// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::pfem {

/// A straight edge or a circular arc from a to b, parametrised on [-1, 1]; an arc by its angle.
class Curve {
 public:
  static Curve line(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  /// The shorter arc about `center` from a to b.
  static Curve arc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& center);

  [[nodiscard]] Eigen::Vector2d point(double s) const;
  [[nodiscard]] Eigen::Vector2d derivative(double s) const;
  [[nodiscard]] bool is_arc() const { return is_arc_; }
  /// Angle of an arc at s = -1, and its signed increase up to s = 1, in (-pi, pi].
  [[nodiscard]] double start_angle() const { return start_; }
  [[nodiscard]] double sweep() const { return sweep_; }

 private:
  Eigen::Vector2d a_, b_, center_ = Eigen::Vector2d::Zero();
  double radius_ = 0, start_ = 0, sweep_ = 0;
  bool is_arc_ = false;
};

}  // namespace fastjoint::pfem
