// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/curve.hpp"

#include <cmath>
#include <numbers>

namespace fastjoint::pfem {

Curve Curve::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Curve c;
  c.a_ = a;
  c.b_ = b;
  return c;
}

Curve Curve::arc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& center) {
  Curve c = line(a, b);
  const Eigen::Vector2d from = a - center;
  const Eigen::Vector2d to = b - center;
  c.is_arc_ = true;
  c.center_ = center;
  c.radius_ = from.norm();
  c.start_ = std::atan2(from.y(), from.x());
  c.sweep_ = std::remainder(std::atan2(to.y(), to.x()) - c.start_, 2 * std::numbers::pi);
  return c;
}

Eigen::Vector2d Curve::point(double s) const {
  if (!is_arc_) return (1 - s) / 2 * a_ + (1 + s) / 2 * b_;
  const double angle = start_ + (1 + s) / 2 * sweep_;
  return center_ + radius_ * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d Curve::derivative(double s) const {
  if (!is_arc_) return (b_ - a_) / 2;
  const double angle = start_ + (1 + s) / 2 * sweep_;
  return radius_ * sweep_ / 2 * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
}

}  // namespace fastjoint::pfem
