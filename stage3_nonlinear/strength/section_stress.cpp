// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/section_stress.hpp"

#include <algorithm>
#include <cmath>

#include "common/infinite.hpp"
#include "common/rim/angles.hpp"
#include "common/rim/axis.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

/// Centre and radius of Mohr's circle, and the direction of the larger principal value, degrees.
struct MohrCircle {
  double centre, radius, direction;

  explicit MohrCircle(const MeanStress& s)
      : centre((s[0] + s[1]) / 2),
        radius(std::hypot((s[0] - s[1]) / 2, s[2])),
        direction(std::atan2(2 * s[2], s[0] - s[1]) / 2 / rim::degree) {}

  [[nodiscard]] Principal high() const { return {centre + radius, direction}; }
  [[nodiscard]] Principal low() const { return {centre - radius, direction > 0 ? direction - 90 : direction + 90}; }
};

constexpr Principal not_known{infinite, 0};

constexpr double equal = 1e-9;  ///< share by which numbers differ that are equal but for rounding

/// The number of larger magnitude; of equal ones the tension.
double larger(double a, double b) {
  const double difference = std::abs(a) - std::abs(b);
  if (std::abs(difference) <= equal * std::abs(a)) return std::max(a, b);
  return difference > 0 ? a : b;
}

}  // namespace

Principal larger_principal(const MeanStress& stress) {
  if (!stress.allFinite()) return not_known;
  const MohrCircle circle(stress);
  return circle.centre >= -equal * circle.radius ? circle.high() : circle.low();
}

Principal largest_tension(const MeanStress& stress) {
  return stress.allFinite() ? MohrCircle(stress).high() : not_known;
}

double distance_to_border(const formats::Border& border, const Eigen::Vector2d& from, const Eigen::Vector2d& direction,
                          bool held_too) {
  double nearest = infinite;
  if (direction.norm() == 0) return nearest;
  const Eigen::Vector2d along = direction.normalized();
  constexpr double touch = 1e-9;
  for (const auto& piece : border) {
    if (piece.is_free == 0 && !held_too) continue;
    const Eigen::Vector2d a = piece.from - from, side = piece.to - from - a;
    const double area = along.x() * side.y() - along.y() * side.x();
    if (std::abs(area) < touch * side.norm()) continue;
    const double s = (a.x() * along.y() - a.y() * along.x()) / area, r = (a.x() * side.y() - a.y() * side.x()) / area;
    if (s >= -touch && s <= 1 + touch && r > 0) nearest = std::min(nearest, r);
  }
  return nearest;
}

HoleSections::HoleSections(const formats::PlateStresses& a, Index rim, const formats::Border* border) : a_(a) {
  for (Index i = 0; i < std::ssize(a.section_hole); ++i) {
    if (a.section_hole[i] != a.rim_hole[rim]) continue;
    const auto [axis, sign] = rim::signed_axis_named(a.section_side[i]);
    at_[rim::coordinate(axis)][sign > 0 ? 0 : 1] = i;
  }
  const auto area = a.bearing_area.row(rim);
  const double whole = a.rim_thickness.size() > 0 ? 2 * a.rim_radius[rim] * a.rim_thickness[rim] : area.maxCoeff();
  constexpr double part = 0.75;  // of the projected area; half of it is there on a line of symmetry
  on_symmetry_ = area.minCoeff() < part * whole;
  constexpr double most = 0.5, nearly = 0.99;
  for (const int axis : {0, 1}) {
    if (!border || is_open(axis) || net_area(axis) >= most * gross_area(axis)) continue;
    double of_sheet = 0;
    for (const int sign : {1, -1}) {
      const double room =
          distance_to_border(*border, a.rim_center.row(rim), sign * Eigen::Vector2d::Unit(1 - axis), true);
      if (std::isfinite(room) || !on_symmetry_) of_sheet += room;  // a line of symmetry is no border at its hole
    }
    const double t = a.rim_thickness.size() > 0 ? a.rim_thickness[rim] : 0;
    is_filled_[axis] = !(gross_area(axis) >= nearly * of_sheet * t);
  }
}

int HoleSections::number() const {
  int n = 0;
  for (const Sides& sides : at_) n += int(sides[0].has_value()) + int(sides[1].has_value());
  return n;
}

std::optional<Index> HoleSections::smaller(int axis) const {
  const auto& [plus, minus] = at_[axis];
  return plus && (!minus || a_.net_area[*plus] <= a_.net_area[*minus]) ? plus : minus;
}

double HoleSections::gross_area(int axis) const {
  const auto at = smaller(axis);
  return at ? a_.gross_area[*at] : 0;
}

double HoleSections::net_area(int axis) const {
  const auto at = smaller(axis);
  return at ? a_.net_area[*at] : 0;
}

double HoleSections::across(double x, double y, double direction) {
  const double c = std::cos(direction * rim::degree);
  return x == 0 ? y : y == 0 ? x : y + (x - y) * c * c;
}

double HoleSections::gross_area_across(double direction) const {
  return across(gross_area(0), gross_area(1), direction);
}

double HoleSections::net_share(double direction) const {
  return across(net_area(0), net_area(1), direction) / gross_area_across(direction);
}

bool HoleSections::is_unknown(int axis, const Eigen::Vector2d& T, double scale) const {
  constexpr double nearly_across = 1e-3;
  return !at_[axis][0] && !at_[axis][1] && std::abs(T[axis]) > nearly_across * std::max(T.norm(), scale);
}

double HoleSections::shear(const SectionForces& forces) const {
  double largest = 0;
  if (on_symmetry_) return largest;
  for (const Sides& sides : at_) {
    double sum = 0;
    int n = 0;
    for (const auto& side : sides)
      if (side) sum += forces.shear[*side] / a_.gross_area[*side], ++n;
    if (n > 0 && !(std::abs(sum / n) <= std::abs(largest))) largest = sum / n;
  }
  return largest;
}

MeanStress HoleSections::bypass(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const {
  MeanStress stress(0, 0, shear(forces));
  for (const int axis : {0, 1}) {
    const auto& [plus, minus] = at_[axis];
    if (is_unknown(axis, T, scale)) stress[axis] = infinite;
    if (!plus && !minus) continue;
    // Equilibrium, N_minus - N_plus = T, supplies a section that is missing.
    const auto& N = forces.normal;
    const double right = plus ? N[*plus] : N[*minus] - T[axis], left = minus ? N[*minus] : N[*plus] + T[axis];
    constexpr double hardly = 1e-3;  // the number must not depend on the sign of a component that is rounding
    const double least = hardly * std::max(T.norm(), scale);
    const double bears = least > 0 ? std::clamp(T[axis] / least, -1.0, 1.0) : 0;
    stress[axis] = ((left + right) - bears * (left - right)) / 2 / gross_area(axis);
  }
  return stress;
}

MeanStress HoleSections::gross(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const {
  MeanStress stress(0, 0, shear(forces));
  for (const int axis : {0, 1}) {
    if (is_unknown(axis, T, scale)) stress[axis] = infinite;
    for (const auto& side : at_[axis])
      if (side) stress[axis] = larger(stress[axis], forces.normal[*side] / a_.gross_area[*side]);
  }
  return stress;
}

MeanStress HoleSections::net(const SectionForces& forces, const Eigen::Vector2d& T, double scale) const {
  constexpr double hardly = 0.05;  // of the stress across the other axis
  const MeanStress over_gross = gross(forces, T, scale);
  MeanStress stress(0, 0, shear(forces));
  double share = 1;  // of the gross area; the shear acts where it is smallest
  for (const int axis : {0, 1}) {
    if (is_unknown(axis, T, scale) || is_open(axis)) stress[axis] = infinite;
    const auto& [plus, minus] = at_[axis];
    if ((!plus && !minus) || is_open(axis)) continue;
    if (is_filled_[axis]) {
      const bool carries = !(std::abs(over_gross[axis]) <= hardly * std::abs(over_gross[1 - axis]));
      stress[axis] = carries ? infinite : over_gross[axis];
      continue;
    }
    const auto of = [&](const std::optional<Index>& side) {
      return side ? forces.normal[*side] / a_.net_area[*side] : -infinite;
    };
    stress[axis] = std::max(of(plus), of(minus));
    share = std::min(share, net_area(axis) / gross_area(axis));
  }
  stress[2] /= share;
  return stress;
}

}  // namespace fastjoint::stage3
