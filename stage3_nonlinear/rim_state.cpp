// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/rim_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Half width of what is left out around a jump of friction, degrees: the point itself and its neighbours.
constexpr double left_out = 7.5;

/// A maximum between points.
struct Peak {
  double value = 0, angle = 0;
  Index at = 0;  ///< nearest point
};

double turn(double angle) { return angle - 360 * std::round(angle / 360); }

/// Points of one rim.
class Rim {
 public:
  Rim(const formats::PlateStresses& a, Index rim)
      : first_(a.rim_start[rim]), angle_(a.angle.segment(first_, a.rim_start[rim + 1] - first_)) {}

  [[nodiscard]] VectorXd hoop(const Eigen::MatrixXd& sigma_tt, const VectorXd& amounts) const {
    return sigma_tt.middleRows(first_, angle_.size()) * amounts;
  }

  /// Largest value, at the top of the parabola through it and its neighbours; none if all points are left out.
  [[nodiscard]] std::optional<Peak> peak(const VectorXd& value, std::optional<double> jump) const {
    const auto allowed = [&](Index i) { return !jump || std::abs(turn(angle_[i] - *jump)) > left_out; };
    std::optional<Peak> best;
    for (Index i = 0; i < angle_.size(); ++i)
      if (allowed(i) && (!best || value[i] > best->value)) best = Peak{value[i], angle_[i], i};
    if (!best) return best;
    const Index before = neighbour(best->at, -1), after = neighbour(best->at, 1);
    const double step = distance(best->at, after);
    const bool between = step > 0 && std::abs(distance(before, best->at) - step) < same_step * step;
    if (between && allowed(before) && allowed(after)) refine(value[before], value[after], step, *best);
    best->angle = turn(best->angle);
    return best;
  }

 private:
  static constexpr double same_step = 1e-6;

  /// The next point counter-clockwise or before, around a closed rim.
  [[nodiscard]] Index neighbour(Index i, Index by) const { return (i + by + angle_.size()) % angle_.size(); }
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
};

/// Forces over the sections on the two sides of a hole along x.
struct Sections {
  std::optional<Index> plus, minus;
};

Sections sections_of(const formats::PlateStresses& a, const std::string& hole) {
  Sections result;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i) {
    if (a.section_hole[i] != hole) continue;
    if (a.section_side[i] == "+x") result.plus = static_cast<Index>(i);
    if (a.section_side[i] == "-x") result.minus = static_cast<Index>(i);
  }
  return result;
}

/// Tension is N_plus on the right and N_minus on the left; the fastener's force T along +x takes N_minus - N_plus. It
/// bears on the side that it pushes to.
double bypass(std::optional<double> N_plus, std::optional<double> N_minus, double T) {
  if (T > 0) return N_plus ? *N_plus : *N_minus - T;
  if (T < 0) return N_minus ? *N_minus : *N_plus + T;
  return N_plus && N_minus ? (*N_plus + *N_minus) / 2 : N_plus.value_or(N_minus.value_or(0));
}

void read_sections(const formats::PlateStresses& a, const std::string& hole, const VectorXd& force, double T,
                   double largest, RimState& state) {
  const Sections at = sections_of(a, hole);
  if (!at.plus && !at.minus) return;
  const auto N = [&](std::optional<Index> i) { return i ? std::optional(force[*i]) : std::nullopt; };
  state.bypass_load = bypass(N(at.plus), N(at.minus), T);
  const bool plus = at.plus && (!at.minus || std::abs(force[*at.plus]) >= std::abs(force[*at.minus]));
  const Index loaded = plus ? *at.plus : *at.minus;
  constexpr double rounding = 1e-9;
  if (!(std::abs(force[loaded]) > rounding * largest)) return;
  state.gross_concentration = state.peak_hoop * a.gross_area[loaded] / std::abs(force[loaded]);
  state.net_concentration = state.peak_hoop * a.net_area[loaded] / std::abs(force[loaded]);
}

}  // namespace

std::vector<RimState> rim_states(const PlateModel& plate, const PlateLoading& loading) {
  std::vector<RimState> states;
  const formats::PlateStresses& a = plate.stresses;
  if (!plate.stress_level) return states;
  const std::size_t level = *plate.stress_level;
  const VectorXd force = a.section_force[level] * loading.amounts;
  const double largest = std::max(force.size() > 0 ? force.cwiseAbs().maxCoeff() : 0,
                                  loading.bearing.size() > 0 ? loading.bearing.cwiseAbs().maxCoeff() : 0);
  for (std::size_t i = 0; i < a.rim_hole.size(); ++i) {
    const auto rim_index = static_cast<Index>(i);
    const Rim rim(a, rim_index);
    RimState state;
    double friction = 0;
    const auto disc = std::find(plate.holes.begin(), plate.holes.end(), a.rim_hole[i]);
    if (disc != plate.holes.end()) {
      state.bearing_load = loading.bearing[disc - plate.holes.begin()];
      friction = loading.friction[disc - plate.holes.begin()];
    }
    state.bearing_stress = std::abs(state.bearing_load) / a.bearing_area(rim_index, 0);
    const auto jump = friction == 0 ? std::nullopt : std::optional(friction > 0 ? 0.0 : 180.0);
    const VectorXd hoop = rim.hoop(a.sigma_tt[level], loading.amounts);
    if (const auto peak = rim.peak(hoop, jump)) {
      state.peak_hoop = peak->value;
      state.peak_angle = peak->angle;
      state.peak_error = level == 0
                             ? std::numeric_limits<double>::infinity()
                             : std::abs(rim.hoop(a.sigma_tt[level - 1], loading.amounts)[peak->at] - hoop[peak->at]);
    }
    read_sections(a, a.rim_hole[i], force, state.bearing_load + friction, largest, state);
    states.push_back(state);
  }
  return states;
}

}  // namespace fastjoint::stage3
