// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/rim_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "common/rim/angles.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Error where one degree alone says nothing.
constexpr double unknown = std::numeric_limits<double>::infinity();

/// Half width of what is left out around a jump of friction, degrees: the point itself and its neighbours.
constexpr double left_out = 7.5;

/// Maximum between points.
struct Peak {
  double value = 0, angle = 0;
  Index at = 0;  ///< nearest point
};

double turn(double angle) { return angle - 360 * std::round(angle / 360); }

/// Components of friction whose peak is more than 1 % of the bearing stress, else 0: the friction of the other axis
/// must not hide the peak beside the hole under a force almost along one axis.
Eigen::Vector2d jumping(const Eigen::Vector2d& friction, const Eigen::Vector2d& bearing) {
  // The cosine distribution's peak stress over F / (d t) is twice its resultant over F.
  const double negligible = 0.01 / 2 * bearing.norm();
  return (friction.array().abs() > negligible).select(friction, 0);
}

/// Points of one rim.
class Rim {
 public:
  /// @param friction Resultants along x and y that jump, each at its bearing direction, else 0.
  Rim(const formats::PlateStresses& a, Index rim, const Eigen::Vector2d& friction)
      : first_(a.rim_start[rim]), angle_(a.angle.segment(first_, a.rim_start[rim + 1] - first_)) {
    const auto jumps = [&](double angle, int axis) {
      const double jump = 90 * axis + (friction[axis] > 0 ? 0 : 180);
      return friction[axis] != 0 && std::abs(turn(angle - jump)) <= left_out;
    };
    for (const double angle : angle_) allowed_.push_back(!jumps(angle, 0) && !jumps(angle, 1));
  }

  [[nodiscard]] VectorXd stress(const Eigen::MatrixXd& sigma, const VectorXd& amounts) const {
    return sigma.middleRows(first_, angle_.size()) * amounts;
  }

  /// Largest value, at the top of the parabola through it and its neighbours; none if all points are left out.
  [[nodiscard]] std::optional<Peak> peak(const VectorXd& value) const {
    std::optional<Peak> best;
    for (Index i = 0; i < angle_.size(); ++i)
      if (allowed_[i] && (!best || value[i] > best->value)) best = Peak{value[i], angle_[i], i};
    if (!best) return best;
    const Index n = angle_.size(), before = (best->at + n - 1) % n, after = (best->at + 1) % n;
    const double step = distance(best->at, after);
    const bool between = step > 0 && std::abs(distance(before, best->at) - step) < same_step * step;
    if (between && allowed_[before] && allowed_[after]) refine(value[before], value[after], step, *best);
    best->angle = turn(best->angle);
    return best;
  }

  /// Share of all radial stress, by amount, on the half that bears under a force.
  [[nodiscard]] double bearing_share(const VectorXd& sigma_rr, const Eigen::Vector2d& force) const {
    const Eigen::ArrayXd angle = angle_.array() * rim::degree;
    const auto bears = force[0] * angle.cos() + force[1] * angle.sin() > 0;
    return bears.select(sigma_rr.array().abs(), 0).sum() / sigma_rr.lpNorm<1>();
  }

  /// Force on the rim along an axis by the pressure around a whole circle in equal steps; NaN on part of a circle.
  /// @param area d t
  [[nodiscard]] double force(const VectorXd& sigma_rr, int axis, double area) const {
    const double n = double(angle_.size());
    if (std::abs(distance(angle_.size() - 1, 0) - 360 / n) > same_step * 360) return std::nan("");
    const Eigen::ArrayXd off_axis = (angle_.array() - 90 * axis) * rim::degree;
    return -off_axis.cos().matrix().dot(sigma_rr) / n * std::numbers::pi * area;
  }

  /// Largest change within 45 degrees of a point.
  [[nodiscard]] double change_around(Index at, const VectorXd& change) const {
    constexpr double around = 45;
    double largest = 0;
    for (Index i = 0; i < angle_.size(); ++i)
      if (allowed_[i] && std::abs(turn(angle_[i] - angle_[at])) <= around)
        largest = std::max(largest, std::abs(change[i]));
    return largest;
  }

 private:
  static constexpr double same_step = 1e-6;

  /// Counter-clockwise, degrees; negative or 0 where that is not the shorter way.
  [[nodiscard]] double distance(Index from, Index to) const { return turn(angle_[to] - angle_[from]); }
  static void refine(double before, double after, double step, Peak& peak) {
    const double curvature = before - 2 * peak.value + after;
    if (!(curvature < 0)) return;
    const double shift = (before - after) / (2 * curvature);
    peak.value -= curvature * shift * shift / 2;
    peak.angle += shift * step;
  }

  Index first_;
  VectorXd angle_;
  std::vector<bool> allowed_;  ///< (n) not close to the jump
};

void read_peak(const formats::PlateStresses& a, const Rim& rim, std::size_t level, const VectorXd& amounts,
               RimState& state) {
  const VectorXd hoop = rim.stress(a.sigma_tt[level], amounts);
  const auto peak = rim.peak(hoop);
  if (!peak) return;
  state.peak_hoop = peak->value;
  state.peak_angle = peak->angle;
  state.peak_error =
      level > 0 ? rim.change_around(peak->at, hoop - rim.stress(a.sigma_tt[level - 1], amounts)) : unknown;
}

/// Forces over all sections of a plate.
struct SectionForces {
  VectorXd force;                 ///< (s)
  std::optional<VectorXd> below;  ///< at the degree below
};

/// @param T Force of the fastener along x, friction included. @param largest Force anywhere on the plate.
void read_sections(const formats::PlateStresses& a, const std::string& hole, const SectionForces& sections, double T,
                   double largest, RimState& state) {
  std::optional<Index> plus, minus;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i) {
    if (a.section_hole[i] != hole) continue;
    if (a.section_side[i] == "+x") plus = i;
    if (a.section_side[i] == "-x") minus = i;
  }
  if (!plus && !minus) return;
  // Tension is `right` on the side of +x and `left` on that of -x; T along +x takes left - right. It bears on the side
  // that it pushes to.
  const auto bypass = [&](const VectorXd& N) {
    const double right = plus ? N[*plus] : N[*minus] - T;
    const double left = minus ? N[*minus] : N[*plus] + T;
    return T == 0 ? (left + right) / 2 : T > 0 ? right : left;
  };
  const VectorXd& force = sections.force;
  state.bypass_load = bypass(force);
  state.bypass_error = sections.below ? std::abs(bypass(*sections.below) - state.bypass_load) : unknown;
  const Index loaded = plus && (!minus || std::abs(force[*plus]) >= std::abs(force[*minus])) ? *plus : *minus;
  constexpr double rounding = 1e-9;
  if (!(std::abs(force[loaded]) > rounding * largest)) return;
  state.in_tension = force[loaded] > 0;
  state.gross_concentration = state.peak_hoop * a.gross_area[loaded] / std::abs(force[loaded]);
  state.net_concentration = state.peak_hoop * a.net_area[loaded] / std::abs(force[loaded]);
}

}  // namespace

std::vector<RimState> rim_states(const PlateModel& plate, const PlateLoading& loading) {
  std::vector<RimState> states;
  const formats::PlateStresses& a = plate.stresses;
  if (!plate.stress_level) return states;
  const std::size_t level = *plate.stress_level;
  SectionForces forces{a.section_force[level] * loading.amounts, std::nullopt};
  if (level > 0) forces.below = a.section_force[level - 1] * loading.amounts;
  const double largest = std::max(forces.force.lpNorm<Eigen::Infinity>(), loading.bearing.lpNorm<Eigen::Infinity>());
  for (std::size_t i = 0; i < a.rim_hole.size(); ++i) {
    RimState state;
    Eigen::Vector2d bearing{0, 0}, friction{0, 0};
    const auto hole = std::find(plate.holes.begin(), plate.holes.end(), a.rim_hole[i]) - plate.holes.begin();
    for (Index disc = 0; disc < plate.n_discs(); ++disc) {
      if (disc / std::ssize(plate.axes) != hole) continue;
      bearing[plate.axis_of(disc)] = loading.bearing[disc];
      friction[plate.axis_of(disc)] = loading.friction[disc];
    }
    state.bearing_load = bearing[0];
    state.bearing_load_y = bearing[1];
    state.bearing_stress = bearing.cwiseQuotient(a.bearing_area.row(i).transpose()).norm();
    const Eigen::Vector2d jumps = jumping(friction, bearing);
    state.by_components = jumps[0] != 0 && jumps[1] != 0;
    const Rim points(a, i, jumps);
    read_peak(a, points, level, loading.amounts, state);
    const VectorXd radial = points.stress(a.sigma_rr[level], loading.amounts);
    constexpr double hardly = 0.05;  // all around it is about half, on an arc that bears all
    state.pulls = bearing.norm() > 1e-9 * largest && points.bearing_share(radial, bearing) < hardly;
    const auto touched = (radial.array().abs() > 1e-9 * radial.lpNorm<Eigen::Infinity>()).count();
    state.filled = double(touched) > (1 - hardly) * double(radial.size());
    if (state.filled) state.pull = std::max(0.0, radial.maxCoeff());
    if (const int across = 1 - plate.axes[0]; plate.axes.size() == 1 && hole < std::ssize(plate.holes))
      state.across = points.force(radial, across, a.bearing_area(i, across));
    state.across_share = std::abs(state.across) / std::max(bearing.norm(), 0.01 * largest);
    read_sections(a, a.rim_hole[i], forces, bearing[0] + friction[0], largest, state);
    states.push_back(state);
  }
  return states;
}

}  // namespace fastjoint::stage3
