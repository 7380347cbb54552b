// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hole_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "common/count.hpp"
#include "common/rim/angles.hpp"
#include "stage3_nonlinear/results/hoop_peak.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Error if there is only one degree.
constexpr double unknown_stress = std::numeric_limits<double>::infinity();

/// Minimum friction over bearing force of a jump: friction with a peak below 1 % of the bearing stress is ignored, so
/// that the small component along one axis does not exclude the peak of a force almost along the other. The peak stress
/// of the cosine distribution over F / (d t) is twice its resultant over F.
constexpr double min_jump = 0.01 / 2;

/// Angles, degrees, at which friction with a case for each side jumps: the bearing direction along either axis.
std::vector<double> jumps_of_sides(const Eigen::Vector2d& friction) {
  std::vector<double> jumps;
  for (const int axis : {0, 1})
    if (friction[axis] != 0) jumps.push_back(90 * axis + (friction[axis] > 0 ? 0 : 180));
  return jumps;
}

/// Pressure at points of a rim.
struct RimPressure {
  VectorXd angle;     ///< (n) in equal steps all around or from end to end, degrees
  VectorXd pressure;  ///< (n) stress
  bool is_whole;

  explicit RimPressure(const LoadedRim& rim) : is_whole(rim.rim.waves.is_whole()) {
    constexpr int n = 72;
    const auto& [highest, start, sweep] = rim.rim.waves;
    const int steps = std::max(1, static_cast<int>(std::lround(n * sweep / rim::full_turn)));
    angle = is_whole ? VectorXd::LinSpaced(n, 0, 360.0 * (n - 1) / n)
                     : VectorXd::LinSpaced(steps + 1, start / rim::degree, (start + sweep) / rim::degree);
    pressure = angle.unaryExpr([&](double at) { return rim.degrees[0].tractions(at * rim::degree).x(); });
  }

  /// Fraction of the absolute pressure on the half that bears under a force.
  [[nodiscard]] double bearing_fraction(const Eigen::Vector2d& force) const {
    const Eigen::ArrayXd at = angle.array() * rim::degree;
    const auto bears = force[0] * at.cos() + force[1] * at.sin() > 0;
    return bears.select(pressure.array().abs(), 0).sum() / pressure.lpNorm<1>();
  }

  /// Force on the rim along an axis by the pressure around a whole circle; NaN on a part of a circle.
  /// @param area d t
  [[nodiscard]] double force(int axis, double area) const {
    if (!is_whole) return std::nan("");
    const Eigen::ArrayXd off_axis = (angle.array() - 90 * axis) * rim::degree;
    return off_axis.cos().matrix().dot(pressure) / double(angle.size()) * std::numbers::pi * area;
  }
};

/// Angles, degrees, at which friction of contact jumps: the direction of the bearing force, and the opposite one if it
/// has pressure too.
std::vector<double> jumps_of_contact(const Eigen::Vector2d& bearing, const Eigen::Vector2d& friction,
                                     const LoadedRim& rim) {
  if (!(friction.norm() > min_jump * bearing.norm())) return {};
  const double direction = std::atan2(bearing.y(), bearing.x()) / rim::degree;
  const auto& tractions = rim.degrees[0].tractions;
  const double there = tractions(direction * rim::degree).x(),
               opposite = tractions((direction + 180) * rim::degree).x();
  return opposite > 0.01 * there ? std::vector{direction, direction + 180} : std::vector{direction};
}

/// Sets the peak, and the values that follow from the pressure around the rim.
/// @param axes Directions of its disc.
void read_rim(const LoadedRim& rim, const Eigen::Vector2d& bearing, const Eigen::Vector2d& friction,
              const std::vector<int>& axes, double largest, const Eigen::RowVector2d& bearing_area, HoleState& state) {
  const Eigen::Vector2d jumps = (friction.array().abs() > min_jump * bearing.norm()).select(friction, 0);
  state.by_components = !rim.in_contact && jumps[0] != 0 && jumps[1] != 0;
  const auto places = rim.in_contact ? jumps_of_contact(bearing, friction, rim) : jumps_of_sides(jumps);
  if (const auto peak = hoop_peak(rim, places)) {
    state.peak_hoop = peak->value;
    state.peak_angle = peak->angle;
    state.peak_error = peak->error;
    state.hoop = peak->at_points;
    state.against_slip = rim.against_slip();
  }
  const RimPressure around(rim);
  const double highest = around.pressure.lpNorm<Eigen::Infinity>();
  constexpr double max_fraction = 0.05;  // springs all around have about half on the bearing side, those on it all
  if (!rim.in_contact && highest > 0) {
    const auto touched = (around.pressure.array().abs() > 1e-9 * highest).count();
    state.filled = double(touched) > (1 - max_fraction) * double(around.pressure.size());
    state.pulls = !state.filled && bearing.norm() > 1e-9 * largest && around.bearing_fraction(bearing) < max_fraction;
    if (state.filled) state.pull = std::max(0.0, -around.pressure.minCoeff());
  }
  if (axes.size() == 1) state.across = around.force(1 - axes[0], bearing_area[1 - axes[0]]);
  state.across_ratio = std::abs(state.across) / std::max(bearing.norm(), 0.01 * largest);
}

}  // namespace

std::vector<HoleState> hole_states(const formats::PlateStresses& a, const formats::Border& border, int level,
                                   const VectorXd& coefficients, const LoadedDiscs& discs, double scale,
                                   const std::vector<std::optional<LoadedRim>>& rims) {
  std::vector<HoleState> states;
  std::vector<SectionForces> forces;
  for (int at = level; at >= std::max(0, level - 1); --at)
    forces.push_back({a.section_force[at] * coefficients, a.section_shear[at] * coefficients});
  const double largest =
      std::max({forces[0].normal.lpNorm<Eigen::Infinity>(), discs.bearing.lpNorm<Eigen::Infinity>(), scale});
  for (int i = 0; i < count_of(a.rim_hole); ++i) {
    HoleState state;
    state.peak_hoop = state.peak_angle = std::nan(""), state.peak_error = unknown_stress;
    Eigen::Vector2d bearing{0, 0}, friction{0, 0};
    std::vector<int> axes;
    for (int disc = 0; disc < count_of(discs.hole); ++disc) {
      if (discs.hole[disc] != a.rim_hole[i]) continue;
      axes.push_back(discs.axis[disc]);
      bearing[axes.back()] = discs.bearing[disc];
      friction[axes.back()] = discs.friction[disc];
    }
    state.bearing_load = bearing[0];
    state.bearing_load_y = bearing[1];
    state.bearing_stress = bearing.cwiseQuotient(a.bearing_area.row(i).transpose()).norm();
    const auto found =
        std::ranges::find_if(rims, [&](const auto& rim) { return rim && rim->rim.hole == a.rim_hole[i]; });
    if (found != rims.end()) read_rim(**found, bearing, friction, axes, largest, a.bearing_area.row(i), state);
    static_cast<SectionState&>(state) = section_state(HoleSections(a, i, &border), forces, bearing + friction, largest,
                                                      std::sqrt(a.stiffness_error[level]), state.peak_hoop);
    states.push_back(state);
  }
  return states;
}

formats::HoleList holes_of(const formats::PlateStresses& a) {
  const Index r = std::ssize(a.rim_hole);
  formats::HoleList all{.hole = a.rim_hole,
                        .sections = Eigen::VectorXi(r),
                        .center = a.rim_center,
                        .radius = a.rim_radius,
                        .thickness = a.rim_thickness,
                        .gross_area = VectorXd(r),
                        .net_area = VectorXd(r),
                        .gross_area_y = VectorXd(r),
                        .net_area_y = VectorXd(r)};
  for (Index i = 0; i < r; ++i) {
    const HoleSections sections(a, i);
    all.sections[i] = sections.number();
    all.gross_area[i] = sections.gross_area(0), all.gross_area_y[i] = sections.gross_area(1);
    all.net_area[i] = sections.net_area(0), all.net_area_y[i] = sections.net_area(1);
  }
  return all;
}

}  // namespace fastjoint::stage3
