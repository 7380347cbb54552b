// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/peak_sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "common/count.hpp"
#include "common/rim/angles.hpp"
#include "stage3_nonlinear/equations/rim_friction.hpp"

namespace fastjoint::stage3 {
namespace {

/// A hole with a peak.
struct PeakHole {
  Index plate, rim;                   ///< rim among PlateModel::waves
  double angle;                       ///< of the peak, radians
  bool is_loaded;                     ///< else any place may become the peak
  std::optional<std::size_t> kink{};  ///< LoadedRim::kinks that it is on
};

std::vector<PeakHole> holes_with_peaks(const JointModel& joint, const JointState& state) {
  std::vector<PeakHole> holes;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index at = 0; at < std::ssize(state.plates[i].rims); ++at)
      for (Index rim = 0; rim < std::ssize(plate.waves); ++rim)
        if (plate.waves[rim].hole == plate.stresses.rim_hole[at] && plate.waves[rim].has_closed_form()) {
          const RimState& its = state.plates[i].rims[at];
          holes.push_back({i, rim, its.peak_angle * rim::degree, its.peak_hoop != 0});
        }
  }
  return holes;
}

/// Hoop stress at the place of a peak as the peak is found there: on a kink, which the place then moves with, or on the
/// parabola through the nearest three of HoopStress::values.
double at_place(const HoopStress& hoop, const PeakHole& peak, const std::vector<double>& kinks) {
  const auto& values = hoop.values();
  if (peak.kink && *peak.kink < kinks.size()) return hoop.at(kinks[*peak.kink]);
  const Index n = values.size();
  const double step = rim::full_turn / double(n);
  const double past = rim::wrapped(peak.angle, hoop.angles()[0]) - hoop.angles()[0];
  const Index middle = std::lround(past / step);
  const double x = past / step - double(middle);
  const double before = values[(middle + n - 1) % n], at = values[middle % n], after = values[(middle + 1) % n];
  return at + x * (after - before) / 2 + x * x * (after - 2 * at + before) / 2;
}

/// States of a joint beside one, and their hoop stresses at fixed places.
class NearbyStates {
 public:
  NearbyStates(const JointModel& joint, const JointNumbers& numbers, const SolvedPoint& point,
               std::vector<PeakHole> holes)
      : joint_(joint),
        equations_(point.equations()),
        numbers_(numbers),
        point_(point),
        holes_(std::move(holes)),
        slopes_(state_slopes(numbers, point)),
        forces_(unit_forces(joint, point.load_factor())),
        first_mu_(1 + std::ssize(numbers.first_of_law) + std::ssize(numbers.law)),
        first_shear_(first_mu_ + std::ssize(numbers.friction)),
        first_force_(first_shear_ + std::ssize(numbers.shears)),
        first_gap_(numbers.n_derivatives() - std::ssize(numbers.gap)),
        direct_(direct_displacements()) {
    constexpr double rounding = 1e-9;
    const auto plates = plates_after(0, 0);
    for (auto& hole : holes_) {
      const auto& kinks = plates[hole.plate].loaded[hole.rim]->kinks;
      for (std::size_t i = 0; i < kinks.size(); ++i)
        if (std::abs(rim::wrapped(kinks[i] - hole.angle)) < rounding) hole.kink = i;
    }
  }

  [[nodiscard]] const std::vector<Index>& none() const { return slopes_.none; }

  /// Change of a number that changes the state by about a part of it; 0 if it does nothing.
  [[nodiscard]] double change_for(Index column, double part) const {
    const auto share = [](const VectorXd& change, const VectorXd& all) {
      const double largest = all.lpNorm<Eigen::Infinity>();
      return largest > 0 ? change.lpNorm<Eigen::Infinity>() / largest : 0;
    };
    const VectorXd &F = point_.state().F, &delta = point_.state().delta;
    const VectorXd U = equations_.system.displacements(F, delta, point_.load_factor(), point_.state().shear);
    VectorXd direct = direct_.col(column);
    if (column == 0) direct += equations_.system.D_load_at(point_.load_factor());
    const double does =
        std::max({share(slopes_.F.col(column), F), share(slopes_.delta.col(column), delta), share(direct, U)});
    return does > 0 ? part / does : 0;
  }

  /// Hoop stresses after a change of a number, (holes).
  [[nodiscard]] VectorXd hoop_stresses(Index column, double change) const {
    const auto plates = plates_after(column, change);
    VectorXd result(std::ssize(holes_));
    for (Index i = 0; i < result.size(); ++i) {
      const auto& rim = plates[holes_[i].plate].loaded[holes_[i].rim];
      const HoopStress hoop = rim->hoop(0, rim->rim.waves, rim->traction_waves(rim->degrees[0].tractions));
      result[i] = at_place(hoop, holes_[i], rim->kinks);
    }
    return result;
  }

 private:
  /// The plates after a change of a number: their loads and rims.
  [[nodiscard]] std::vector<PlateState> plates_after(Index column, double change) const {
    const VectorXd F = point_.state().F + change * slopes_.F.col(column);
    const VectorXd delta = point_.state().delta + change * slopes_.delta.col(column);
    const double factor = point_.load_factor() + (column == 0 ? change : 0);
    const auto rims = rims_after(column, change);
    const VectorXd shear = shears(rims, delta);
    const VectorXd U = equations_.system.displacements(F, delta, factor, shear) + change * direct_.col(column);
    std::vector<PlateState> plates;
    Index first_rim = 0, first_shear = 0;
    for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
      const PlateModel& plate = joint_.plates[i];
      const VectorXd u = U.segment(joint_.offset(i), plate.n_unknowns());
      PlateState state{};
      state.D = u.head(plate.n_discs());
      state.De = u.segment(plate.n_discs(), plate.n_externals());
      state.moments = u.tail(plate.n_unknowns() - plate.first_moment());
      state.Lambda = friction_stresses(i, F, column, change);
      add_shears(plate, i, shear, first_shear, state.Lambda);
      state.traction = factor * plate.traction_rate(factor);
      if (column >= first_force_ && column < first_force_ + std::ssize(forces_))
        if (const UnitLoad& load = forces_[column - first_force_]; load.plate == i && load.traction)
          state.traction[*load.traction] += factor * change;
      load_rims(plate, std::span(rims).subspan(first_rim, plate.contact.size()), state);
      first_rim += std::ssize(plate.contact);
      plates.push_back(std::move(state));
    }
    return plates;
  }

  /// Displacements by each number at a fixed load factor, and fixed forces and displacements of the planes, (N,
  /// columns).
  [[nodiscard]] MatrixXd direct_displacements() const {
    const CondensedSystem& system = equations_.system;
    MatrixXd loads = MatrixXd::Zero(joint_.n_unknowns(), numbers_.n_derivatives());
    const VectorXd b = system.friction.empty() ? VectorXd() : VectorXd(system.E * point_.state().F);
    for (Index i = 0; i < std::ssize(numbers_.friction); ++i)
      for (const auto& row : numbers_.friction[i].rows) {
        const VectorXd& load = row.load[b[row.at] < 0 ? minus_side : plus_side];
        loads.col(first_mu_ + i).segment(joint_.offset(row.plate), load.size()) -= std::abs(b[row.at]) * load;
      }
    const auto add = [&](Index column, const UnitLoad& unit) {
      loads.col(column).segment(joint_.offset(unit.plate), unit.load.size()) += point_.load_factor() * unit.load;
    };
    const auto displacements = unit_displacements(joint_);
    for (Index i = 0; i < std::ssize(forces_); ++i) add(first_force_ + i, forces_[i]);
    const Index first_displacement = first_force_ + std::ssize(forces_);
    for (Index i = 0; i < std::ssize(displacements); ++i) add(first_displacement + i, displacements[i]);
    MatrixXd direct = displacements_under(joint_, loads);
    for (Index i = 0; i < std::ssize(displacements); ++i)
      direct(joint_.offset(displacements[i].plate) + *displacements[i].displaced, first_displacement + i) +=
          point_.load_factor();
    return direct;
  }

  [[nodiscard]] std::vector<RimContact> rims_after(Index column, double change) const {
    std::vector<RimContact> rims = equations_.rims;
    Index shear = first_shear_;
    for (Index i = 0; i < std::ssize(rims); ++i) {
      const double gap = column == first_gap_ + i ? change : 0;
      const double mu = rims[i].mu() > 0 && column == shear++ ? change : 0;
      if (gap != 0 || mu != 0)
        rims[i] = RimContact(rims[i].pressures(), rims[i].stiffness(), rims[i].gap() + gap, rims[i].mu() + mu);
    }
    return rims;
  }

  /// Forces of the shears of all rims, (s).
  [[nodiscard]] VectorXd shears(const std::vector<RimContact>& rims, const VectorXd& delta) const {
    VectorXd shear(point_.state().shear.size());
    Index moment = equations_.n_plane_rows(), next = 0;
    for (const RimContact& rim : rims) {
      const VectorXd m = delta.segment(moment, rim.size());
      moment += rim.size();
      if (rim.mu() == 0) continue;
      const VectorXd forces = rim_friction(rim, rim.touching(m), m).forces;
      shear.segment(next, forces.size()) = forces;
      next += forces.size();
    }
    return shear;
  }

  /// Peak stresses of a plate's friction cases under bearing forces, then zeros for its shears.
  [[nodiscard]] VectorXd friction_stresses(Index plate, const VectorXd& F, Index column, double change) const {
    const CondensedSystem& system = equations_.system;
    VectorXd Lambda = VectorXd::Zero(joint_.plates[plate].R.cols());
    if (system.friction.empty()) return Lambda;
    const VectorXd b = system.E * F;
    for (Index i = 0; i < b.size(); ++i) {
      const HoleModel& hole = joint_.fasteners[system.friction[i].fastener].holes[system.friction[i].hole];
      if (hole.plate != plate) continue;
      const FrictionLoad& friction = hole.friction[system.friction[i].direction][b[i] < 0 ? minus_side : plus_side];
      if (friction.load.size() > 0) Lambda[friction.case_index] += friction.peak * std::abs(b[i]);
    }
    if (column < first_mu_ || column >= first_shear_) return Lambda;
    for (const auto& row : numbers_.friction[column - first_mu_].rows)
      if (row.plate == plate) {
        const Side side = b[row.at] < 0 ? minus_side : plus_side;
        Lambda[row.case_index[side]] += change * row.peak[side] * std::abs(b[row.at]);
      }
    return Lambda;
  }

  /// Adds the amounts of the shears of a plate's rims.
  void add_shears(const PlateModel& plate, Index at, const VectorXd& shear, Index& next, VectorXd& Lambda) const {
    for (const auto& rim : plate.contact) {
      if (joint_.mu(at, rim.hole) == 0) continue;
      const Index n = rim.pressures.n_shears();
      Lambda.segment(plate.first_shear(rim), n) = shear.segment(next, n) / rim.area;
      next += n;
    }
  }

  const JointModel& joint_;
  const JointEquations& equations_;
  const JointNumbers& numbers_;
  const SolvedPoint& point_;
  std::vector<PeakHole> holes_;
  StateSlopes slopes_;
  std::vector<UnitLoad> forces_;
  Index first_mu_, first_shear_, first_force_, first_gap_;  ///< columns
  MatrixXd direct_;
};

}  // namespace

PeakSensitivity peak_sensitivity(const JointModel& joint, const JointNumbers& numbers, const SolvedPoint& point,
                                 const JointState& state) {
  const auto holes = holes_with_peaks(joint, state);
  PeakSensitivity result{{}, MatrixXd::Zero(std::ssize(holes), numbers.n_derivatives())};
  for (const auto& hole : holes)
    result.hole.push_back(joint.plates[hole.plate].name + ":" + joint.plates[hole.plate].waves[hole.rim].hole);
  if (holes.empty()) return result;
  const NearbyStates nearby(joint, numbers, point, holes);
  const VectorXd here = nearby.hoop_stresses(0, 0);
  constexpr double part = 1e-6;
  for (Index column = 0; column < result.slopes.cols(); ++column)
    if (const double change = nearby.change_for(column, part); change > 0)
      result.slopes.col(column) = (nearby.hoop_stresses(column, change) - here) / change;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const Index column : nearby.none()) result.slopes.col(column).setConstant(infinite);
  for (Index i = 0; i < std::ssize(holes); ++i)
    if (!holes[i].is_loaded) result.slopes.row(i).setConstant(infinite);
  return result;
}

}  // namespace fastjoint::stage3
