// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stresses/rim_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "common/count.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stresses {
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

/// Friction whose peak is below 1 % of the bearing stress does not jump: that of the other axis must not hide the peak
/// beside the hole under a force almost along one axis. The cosine distribution's peak stress over F / (d t) is twice
/// its resultant over F.
constexpr double hardly_jumps = 0.01 / 2;

/// Places, degrees, at which friction jumps that has a case for each side: at the bearing direction along either axis.
std::vector<double> jumps_of_sides(const Eigen::Vector2d& friction) {
  std::vector<double> jumps;
  for (const int axis : {0, 1})
    if (friction[axis] != 0) jumps.push_back(90 * axis + (friction[axis] > 0 ? 0 : 180));
  return jumps;
}

/// Places, degrees, at which friction jumps that follows the pressure of contact: in the direction of its force, and
/// opposite if there is pressure too.
/// @param angle Points of the rim, degrees. @param radial Stress there.
std::vector<double> jumps_of_contact(const Eigen::Vector2d& bearing, const Eigen::Vector2d& friction,
                                     const VectorXd& angle, const VectorXd& radial) {
  if (!(friction.norm() > hardly_jumps * bearing.norm())) return {};
  const double direction = std::atan2(bearing.y(), bearing.x()) / rim::degree;
  Index opposite = 0;
  angle.unaryExpr([&](double at) { return std::abs(turn(at - direction - 180)); }).minCoeff(&opposite);
  const bool presses = radial[opposite] < -0.01 * radial.lpNorm<Eigen::Infinity>();
  return presses ? std::vector{direction, direction + 180} : std::vector{direction};
}

/// Points of one rim.
class Rim {
 public:
  /// @param angles Of its points, (n), degrees.
  /// @param jumps  Places at which friction jumps, degrees.
  Rim(VectorXd angles, const std::vector<double>& jumps) : angle_(std::move(angles)) {
    const auto is_near = [](double angle) {
      return [angle](double jump) { return std::abs(turn(angle - jump)) <= left_out; };
    };
    for (const double angle : angle_) allowed_.push_back(std::ranges::none_of(jumps, is_near(angle)));
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
    const double curvature = value[before] - 2 * best->value + value[after];
    if (between && allowed_[before] && allowed_[after] && curvature < 0) {
      const double shift = (value[before] - value[after]) / (2 * curvature);
      best->value -= curvature * shift * shift / 2;
      best->angle += shift * step;
    }
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
  VectorXd angle_;
  std::vector<bool> allowed_;  ///< (n) not close to the jump
};

/// @param hoop Stress at the rim's points, beside it that at the degree below if there is one, (n, 1 or 2).
void read_peak(const Rim& rim, const Eigen::MatrixXd& hoop, RimState& state) {
  const auto peak = rim.peak(hoop.col(0));
  if (!peak) return;
  state.peak_hoop = peak->value;
  state.peak_angle = peak->angle;
  state.peak_error = hoop.cols() > 1 ? rim.change_around(peak->at, hoop.col(0) - hoop.col(1)) : unknown;
}

/// @param forces       Over all sections of the plate, beside them those at the degree below if there is one, (s, 1 or
/// 2).
/// @param T            Force of the fastener along x, friction included.
/// @param largest      Force anywhere on the plate.
/// @param energy_error Relative error of the plate's fields in the energy norm, which that of a resultant of stresses
///                     follows.
void read_sections(const formats::PlateStresses& a, const std::string& hole, const Eigen::MatrixXd& forces, double T,
                   double largest, double energy_error, RimState& state) {
  std::optional<Index> plus, minus;
  for (int i = 0; i < count_of(a.section_hole); ++i) {
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
  const VectorXd force = forces.col(0);
  state.bypass_load = bypass(force);
  state.bypass_error = forces.cols() > 1
                           ? std::max(std::abs(bypass(forces.col(1)) - state.bypass_load), energy_error * largest)
                           : unknown;
  const Index loaded = plus && (!minus || std::abs(force[*plus]) >= std::abs(force[*minus])) ? *plus : *minus;
  constexpr double rounding = 1e-9;
  if (!(std::abs(force[loaded]) > rounding * largest)) return;
  state.in_tension = force[loaded] > 0;
  state.gross_concentration = state.peak_hoop * a.gross_area[loaded] / std::abs(force[loaded]);
  state.net_concentration = state.peak_hoop * a.net_area[loaded] / std::abs(force[loaded]);
}

}  // namespace

std::vector<RimState> rim_states(const formats::PlateStresses& a, int level, const InState& in_state,
                                 const LoadedDiscs& discs, const Contacts& contacts) {
  std::vector<RimState> states;
  const auto with_lower_degree = [&](const std::vector<formats::StressRows>& levels) {
    Eigen::MatrixXd columns(levels[level].rows(), level > 0 ? 2 : 1);
    for (Index i = 0; i < columns.cols(); ++i) columns.col(i) = in_state(levels[level - i]);
    return columns;
  };
  const Eigen::MatrixXd hoop = with_lower_degree(a.sigma_tt), forces = with_lower_degree(a.section_force);
  const Eigen::MatrixXd all_radial =
      contacts.rims.empty() ? Eigen::MatrixXd(in_state(a.sigma_rr[level])) : with_lower_degree(a.sigma_rr);
  const double largest = std::max(forces.col(0).lpNorm<Eigen::Infinity>(), discs.bearing.lpNorm<Eigen::Infinity>());
  for (int i = 0; i < count_of(a.rim_hole); ++i) {
    RimState state;
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
    const int contact = index_of(contacts.rims, a.rim_hole[i], &formats::ContactRim::hole);
    const bool in_contact = contact < count_of(contacts.rims);
    const Eigen::Vector2d jumps = (friction.array().abs() > hardly_jumps * bearing.norm()).select(friction, 0);
    state.by_components = !in_contact && jumps[0] != 0 && jumps[1] != 0;
    const auto rows = Eigen::seq(a.rim_start[i], a.rim_start[i + 1] - 1);
    const VectorXd radial = all_radial(rows, 0);
    const auto places = in_contact ? jumps_of_contact(bearing, friction, a.angle(rows), radial) : jumps_of_sides(jumps);
    const Rim points(a.angle(rows), places);
    RimHoop around{a.angle(rows), hoop(rows, Eigen::all)};
    if (in_contact)
      around = under_contact(around, all_radial(rows, Eigen::all), a.hoop_by_pressure(rows), contacts, contact);
    read_peak(Rim(around.angle, places), around.hoop, state);
    // Waves that are left out keep the pressures of springs and of contact apart, and so the peaks by either.
    if (const auto other = points.peak(hoop(rows, 0)); in_contact && other)
      state.peak_error += std::abs(other->value - state.peak_hoop);
    constexpr double hardly = 0.05;  // all around it is about half, on an arc that bears all
    state.pulls = bearing.norm() > 1e-9 * largest && points.bearing_share(radial, bearing) < hardly;
    const auto touched = (radial.array().abs() > 1e-9 * radial.lpNorm<Eigen::Infinity>()).count();
    state.filled = double(touched) > (1 - hardly) * double(radial.size());
    if (state.filled) state.pull = std::max(0.0, radial.maxCoeff());
    if (axes.size() == 1) {
      const int across = 1 - axes[0];
      state.across = points.force(radial, across, a.bearing_area(i, across));
    }
    state.across_share = std::abs(state.across) / std::max(bearing.norm(), 0.01 * largest);
    read_sections(a, a.rim_hole[i], forces, bearing[0] + friction[0], largest, std::sqrt(a.stiffness_error[level]),
                  state);
    states.push_back(state);
  }
  return states;
}

int n_sections(const formats::PlateStresses& a, const std::string& hole) {
  int n = 0;
  for (int i = 0; i < count_of(a.section_hole); ++i) n += a.section_hole[i] == hole && a.section_side[i].back() == 'x';
  return n;
}

formats::RimHistory rims_of(const formats::PlateStresses& a) {
  formats::RimHistory rims{a.rim_hole, Eigen::VectorXi(std::ssize(a.rim_hole)), {}};
  for (Index i = 0; i < rims.sections.size(); ++i) rims.sections[i] = n_sections(a, rims.hole[i]);
  return rims;
}

}  // namespace fastjoint::stresses
