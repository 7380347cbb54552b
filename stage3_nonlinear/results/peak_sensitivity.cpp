// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/peak_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/infinite.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stage3 {
namespace {

/// A hole with a peak.
struct PeakHole {
  Index plate, rim;                   ///< rim among PlateModel::waves
  double angle;                       ///< of the peak, radians
  bool is_loaded;                     ///< else any angle may become that of the peak
  std::optional<std::size_t> kink{};  ///< index in LoadedRim::kinks if the peak is on a kink
};

std::vector<PeakHole> holes_with_peaks(const JointModel& joint, const JointState& state) {
  std::vector<PeakHole> holes;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index at = 0; at < std::ssize(state.plates[i].rims); ++at)
      for (Index rim = 0; rim < std::ssize(plate.waves); ++rim)
        if (plate.waves[rim].hole == plate.stresses.rim_hole[at] && plate.waves[rim].has_closed_form()) {
          const HoleState& its = state.plates[i].rims[at];
          holes.push_back({i, rim, its.peak_angle * rim::degree, std::abs(its.peak_hoop) > 0});
        }
  }
  return holes;
}

/// States of a joint near a given one, and their hoop stresses at fixed angles.
class NearbyStates {
 public:
  NearbyStates(const JointModel& joint, const JointNumbers& numbers, const StateSlopes& slopes,
               const SolvedPoint& point, std::vector<PeakHole> holes)
      : joint_(joint),
        point_(point),
        equations_(point.equations()),
        numbers_(numbers),
        slopes_(slopes),
        state_(point.state()),
        load_(equations_.load_at(point.load_factor())),
        D_(displacements(joint, *equations_.system, load_, equations_.deforming(state_.delta), state_.Lambda)),
        dD_(displacements(joint, *equations_.system, slopes.load, slopes.delta, slopes.Lambda)),
        holes_(std::move(holes)) {
    constexpr double rounding = 1e-9;
    const auto plates = plates_after(0, 0);
    for (auto& hole : holes_) {
      const auto& kinks = plates[hole.plate].loaded[hole.rim]->kinks;
      for (std::size_t i = 0; i < kinks.size(); ++i)
        if (std::abs(rim::wrapped(kinks[i] - hole.angle)) < rounding) hole.kink = i;
    }
  }

  /// Change of a parameter that changes the state by about a given fraction; 0 if the state does not depend on it.
  [[nodiscard]] double change_for(Index column, double part) const {
    const auto ratio = [](const auto& change, const VectorXd& all) {
      const double largest = all.lpNorm<Eigen::Infinity>();
      return largest > 0 ? change.template lpNorm<Eigen::Infinity>() / largest : 0;
    };
    const double rate =
        std::max({ratio(slopes_.F.col(column), state_.F), ratio(slopes_.delta.col(column), state_.delta),
                  ratio(slopes_.Lambda.col(column), state_.Lambda), ratio(slopes_.load.col(column), load_)});
    return rate > 0 ? part / rate : 0;
  }

  /// Hoop stresses after a change of a parameter, (holes).
  [[nodiscard]] VectorXd hoop_stresses(Index column, double change) const {
    const auto plates = plates_after(column, change);
    VectorXd result(std::ssize(holes_));
    for (Index i = 0; i < result.size(); ++i) {
      const auto& rim = plates[holes_[i].plate].loaded[holes_[i].rim];
      const HoopStress hoop = rim->hoop(0, rim->rim.waves, rim->traction_waves(rim->degrees[0].tractions));
      const auto& kink = holes_[i].kink;
      result[i] = hoop.at(kink && *kink < rim->kinks.size() ? rim->kinks[*kink] : holes_[i].angle);
    }
    return result;
  }

 private:
  /// Loads and rims of the plates after a change of a parameter.
  [[nodiscard]] std::vector<PlateState> plates_after(Index column, double change) const {
    std::vector<ContactLoad> contacts;
    for (Index i = 0; i < std::ssize(equations_.rims); ++i) contacts.push_back(contact_after(i, column, change));
    return plate_loads(joint_, *equations_.system, contacts, D_ + change * dD_.col(column),
                       load_ + change * slopes_.load.col(column), state_.Lambda + change * slopes_.Lambda.col(column));
  }

  /// A rim of contact after a change of a parameter: all its waves change by their derivatives.
  [[nodiscard]] ContactLoad contact_after(Index i, Index column, double change) const {
    const VectorXd c = equations_.of_rim(point_.c(), i);
    const RimProblem& rim = equations_.rims[i]->finest_at(c);
    const RimSolution& solution = rim.solve(c);
    const double gap = column == numbers_.first_gap() + i ? change : 0, mu = column == numbers_.of_rim[i] ? change : 0;
    const VectorXd dc = equations_.of_rim(slopes_.F.col(column) + rim.k() * slopes_.delta.col(column), i);
    VectorXd w =
        solution.w + change * (solution.w_by_c * dc) + mu * solution.w_by_mu - gap * rim.k() * solution.w_by_c.col(0);
    w[0] += gap;
    if (gap == 0 && mu == 0) return contact_load(rim, rim.contact_at(w));
    const RimProblem changed = rim.with(rim.contact().gap() + gap, rim.contact().mu() + mu);
    return contact_load(changed, changed.contact_at(w));
  }

  const JointModel& joint_;
  const SolvedPoint& point_;
  const JointEquations& equations_;
  const JointNumbers& numbers_;
  const StateSlopes& slopes_;
  const ContactState& state_;
  VectorXd load_, D_;
  MatrixXd dD_;
  std::vector<PeakHole> holes_;
};

}  // namespace

PeakSensitivity peak_sensitivity(const JointModel& joint, const JointNumbers& numbers, const StateSlopes& slopes,
                                 const SolvedPoint& point, const JointState& state) {
  const auto holes = holes_with_peaks(joint, state);
  PeakSensitivity result{{}, MatrixXd::Zero(std::ssize(holes), numbers.n_derivatives())};
  for (const auto& hole : holes)
    result.hole.push_back(joint.plates[hole.plate].name + ":" + joint.plates[hole.plate].waves[hole.rim].hole);
  if (holes.empty()) return result;
  const NearbyStates nearby(joint, numbers, slopes, point, holes);
  const VectorXd here = nearby.hoop_stresses(0, 0);
  constexpr double part = 1e-7;
  for (Index column = 0; column < result.slopes.cols(); ++column)
    if (const double change = nearby.change_for(column, part); change > 0)
      result.slopes.col(column) = (nearby.hoop_stresses(column, change) - here) / change;
  for (const Index column : slopes.none) result.slopes.col(column).setConstant(infinite);
  for (Index i = 0; i < std::ssize(holes); ++i)
    if (!holes[i].is_loaded) result.slopes.row(i).setConstant(infinite);
  return result;
}

}  // namespace fastjoint::stage3
