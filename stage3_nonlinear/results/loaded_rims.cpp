// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/loaded_rims.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <ranges>
#include <utility>

#include "common/count.hpp"
#include "stage3_nonlinear/interfaces/rim_friction.hpp"

namespace fastjoint::stage3 {
namespace {

double sign_of(double x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }

/// A cosine pressure or a cosine friction on half of the rim.
struct HalfLoad {
  double direction, peak;
};

std::vector<double> ends_of(const std::vector<rim::AngleRange>& arcs) {
  std::vector<double> ends;
  for (const auto& arc : arcs) ends.insert(ends.end(), {arc.from, arc.to});
  return ends;
}

/// Given tractions on a rim that is not in contact, in addition to the pressure of its springs.
struct KnownLoads {
  std::vector<HalfLoad> pressures, frictions;

  [[nodiscard]] Eigen::Vector2d at(double angle) const {
    Eigen::Vector2d result{0, 0};
    for (const auto& [direction, peak] : pressures) result.x() += peak * cosine_bearing(angle, direction);
    for (const auto& [direction, peak] : frictions) result.y() += peak * cosine_friction(angle, direction);
    return result;
  }
};

KnownLoads known_loads(const PlateModel& plate, const std::string& hole, const VectorXd& coefficients) {
  KnownLoads loads;
  const Index q = plate.n_tractions(), h = plate.n_friction_cases();
  for (Index i = 0; i < h; ++i) {
    const double peak = coefficients[coefficients.size() - q - h + i];
    if (const auto side = bearing_side(plate.friction_bearing[i]); side && plate.friction_hole[i] == hole && peak != 0)
      loads.frictions.push_back({angle_of(*side), peak});
  }
  for (Index i = 0; i < std::ssize(plate.traction_hole); ++i) {
    const double force = coefficients[coefficients.size() - q + i];  // along + on both sides
    if (plate.traction_hole[i] != hole || force == 0) continue;
    const rim::SignedAxis side = bearing_side(plate.traction_bearing[i]).value();
    loads.pressures.push_back({angle_of(side), side.sign * force / plate.traction_unit_force[i]});
  }
  return loads;
}

/// Tractions on a rim that is not in contact: the pressure of its springs, if it has any, and the given ones.
Tractions springs_and(const formats::WaveRim& rim, const SpringWaves* springs, const VectorXd& long_w,
                      const KnownLoads& known) {
  if (!springs) return [known](double angle) { return known.at(angle); };
  rim::Harmonics shape = rim.waves;
  VectorXd w = long_w;
  if (!springs->only_friction || !known.frictions.empty()) {
    shape = springs->full;
    VectorXd by_quarter = VectorXd::Zero(springs->by_friction.cols());
    for (const auto& [direction, peak] : known.frictions)
      by_quarter[std::lround(direction / (rim::full_turn / 4))] += peak;
    w.resize(shape.size());
    w << long_w, springs->by_long * long_w + springs->by_friction * by_quarter;
  }
  return [=, modulus = rim.modulus, acts = rim.acts](double angle) -> Eigen::Vector2d {
    const double pressure = rim::covers(acts, angle) ? modulus * shape.sum_at(w, angle).first : 0;
    return known.at(angle) + Eigen::Vector2d(pressure, 0);
  };
}

/// Tractions of contact: the pressure of the springs, and friction proportional to it.
Tractions of_contact(const ContactLoad& load, const ContactLoad::Contour& contour) {
  return [gap = load.gap, contour](double angle) -> Eigen::Vector2d {
    if (!rim::covers(contour.arcs, angle)) return {0, 0};
    const double p = contour.modulus * std::max(contour.waves->pressures.sum_at(contour.w, angle).first - gap, 0.0);
    return {p, -contour.mu * p * sign_of(std::sin(angle - contour.direction))};
  };
}

ContactLoad::Contour contour_of(const RimProblem& rim, const RimSolution& its) {
  const VectorXd shear = its.friction.forces.size() > 0 ? its.friction.forces : VectorXd::Zero(rim.waves()->n_shears);
  return {rim.waves(),
          its.forces / rim.area(),
          shear / rim.area(),
          its.w,
          rim.contact().mu() / its.friction.excess,
          rim.modulus(),
          its.friction.direction,
          its.touching.arcs,
          its.friction.slips};
}

/// Corrects the displacement of the elements, where short waves are those of linear springs, to that under the contact
/// load.
void correct(const ContactLoad& load, double modulus, VectorXd& displacement) {
  const ShortWaves& rim = *load.own.waves;
  if (rim.is_empty()) return;
  const Index s = rim.n - rim.n_long, s_t = rim.n_shears - rim.n_long_shears;
  const VectorXd p_s = load.own.pressure.tail(s), tau_s = load.own.shear.tail(s_t);
  const VectorXd w_s = -(rim.G * load.own.pressure.head(rim.n_long) + rim.G_t * load.own.shear.head(rim.n_long_shears));
  displacement.head(rim.n_long) -= rim.G.transpose() * (p_s - modulus * load.w.tail(s)) + rim.E * tau_s;
  const auto rows = rim.D.middleRows(rim.n, rim.n_long_shears);
  displacement.tail(rim.n_long_shears) -=
      rows.middleCols(rim.n_long, s) * (p_s - modulus * w_s) + rows.rightCols(s_t) * tau_s;
}

/// Waves of the tangential displacement of the disc relative to the sheet, (n_shears).
/// @param along The long ones, for a rigid disc.
VectorXd slip_of(const ContactLoad::Contour& its, const VectorXd& along) {
  const ShortWaves& rim = *its.waves;
  VectorXd slip(rim.n_shears);
  slip.head(along.size()) = along;
  const Index s_t = rim.n_shears - rim.n_long_shears;
  if (s_t > 0) {
    const auto rows = rim.D.bottomRows(s_t);
    slip.tail(s_t) = -(rows.leftCols(rim.n) * its.pressure + rows.rightCols(rim.n_shears) * its.shear);
  }
  slip -= rim.disk_by_shear.transpose() * its.pressure + rim.disk_tangential.cwiseProduct(its.shear);
  return slip;
}

}  // namespace

double LoadedRim::against_slip() const {
  if (slip.size() == 0) return 0;
  const Index n = std::lround(4 * rim.waves.sweep / rim::degree);
  Index against = 0;
  for (Index i = 0; i < n; ++i) {
    const double angle = rim.waves.start + (double(i) + 0.5) * rim.waves.sweep / double(n);
    const double shear = degrees[0].tractions(angle).y();
    if (shear != 0 && shear * all.shear_sum_at(slip, angle) < 0) ++against;
  }
  return double(against) * 360 / double(n);
}

ContactLoad contact_load(const RimProblem& rim, const RimSolution& solution) {
  auto own = contour_of(rim, solution);
  VectorXd w = rim.against_sheet(solution.w, own.pressure, own.shear);
  return {std::move(w), rim.contact().gap(), std::move(own)};
}

ContactLoad contact_load(const RimProblem& rim, const VectorXd& c, bool compares) {
  ContactLoad load = contact_load(rim, rim.solve(c));
  if (!compares || !rim.compared()) return load;
  if (const RimSolution& its = rim.solve_compared(c); its.converged) load.compared = contour_of(*rim.compared(), its);
  return load;
}

VectorXd wave_coefficients(const ContactLoad& load, double modulus) {
  const ShortWaves& rim = *load.own.waves;
  VectorXd w = load.w.head(rim.n_long);
  if (!rim.is_empty())
    w += rim.G.transpose() * (load.own.pressure - modulus * load.w).tail(rim.n - rim.n_long) +
         rim.E * load.own.shear.tail(rim.n_shears - rim.n_long_shears);
  VectorXd coefficients(rim.n_carried());
  coefficients << load.own.pressure.head(rim.n_long) - modulus * w, load.own.shear.head(rim.n_long_shears);
  return coefficients;
}

VectorXd LoadedRim::places() const {
  const auto& [highest, start, sweep] = rim.waves;
  const Index steps = std::lround(sweep / rim::degree);
  if (rim.waves.is_whole()) return VectorXd::LinSpaced(steps, 0, double(steps - 1));
  return VectorXd::LinSpaced(steps + 1, start / rim::degree, (start + sweep) / rim::degree);
}

MatrixXd LoadedRim::stresses(const VectorXd& places) const {
  const HoopStress hoop_stress = hoop(0, rim.waves, traction_waves(degrees[0].tractions));
  MatrixXd result(places.size(), 3);
  for (Index i = 0; i < places.size(); ++i) {
    const double angle = places[i] * rim::degree;
    const Eigen::Vector2d traction = degrees[0].tractions(angle);
    result.row(i) << -traction.x(), hoop_stress.at(angle), -traction.y();
  }
  return result;
}

HoopStress LoadedRim::hoop(Index degree, const rim::Harmonics& shape,
                           std::shared_ptr<const TractionWaves> tractions) const {
  const RimWaves& waves = degrees[degree];
  VectorXd displacement(shape.size() + shape.n_shears());
  displacement << waves.displacement.head(shape.size()), waves.displacement.segment(rim.waves.size(), shape.n_shears());
  return {rim::RimCompliance(rim.compliance, rim.radius), shape, displacement, std::move(tractions)};
}

std::shared_ptr<const TractionWaves> LoadedRim::traction_waves(const Tractions& tractions) const {
  return std::make_shared<const TractionWaves>(rim.waves, tractions);
}

std::vector<std::optional<LoadedRim>> loaded_rims(const PlateModel& plate, const VectorXd& coefficients,
                                                  const std::vector<ContactLoad>& contacts) {
  std::vector<std::optional<LoadedRim>> result;
  Index row = 0;
  for (Index i = 0; i < std::ssize(plate.waves); ++i) {
    const auto& rim = plate.waves[i];
    const Index first = std::exchange(row, row + rim.size());
    auto& loaded = result.emplace_back();
    if (!rim.has_closed_form()) continue;
    const bool in_contact = i < std::ssize(contacts);
    loaded = LoadedRim{rim, {}, in_contact, {}, {}, {}};
    const KnownLoads known = known_loads(plate, rim.hole, coefficients);
    for (const auto& rows : plate.wave_rows | std::views::take(plate.peaks_alone ? 1 : plate.wave_rows.size())) {
      VectorXd displacement = rows.middleRows(first, rim.size()) * coefficients / rim.area;
      if (in_contact) correct(contacts[i], rim.modulus, displacement);
      const Tractions tractions =
          in_contact ? of_contact(contacts[i], contacts[i].finest())
                     : springs_and(rim, plate.spring_waves[i].get(), displacement.head(rim.waves.size()), known);
      loaded->degrees.push_back({std::move(displacement), tractions});
    }
    if (in_contact) {
      const ContactLoad& load = contacts[i];
      const auto& all = load.finest();
      loaded->kinks = ends_of(all.arcs);
      if (all.mu > 0 && all.slips && !plate.peaks_alone) {
        loaded->all = all.waves->pressures;
        loaded->slip = slip_of(all, loaded->degrees[0].displacement.tail(rim.waves.n_shears()));
      }
      loaded->beyond = infinite;
      if (load.compared) {
        const auto& fewer = load.compares_with_more() ? load.own : *load.compared;
        loaded->has_root_at_end = plate.contact_waves[i]->has_root_at_end(all.mu);
        const double rate = loaded->has_root_at_end ? 0.5 : 1.5;
        const double ratio = double(all.waves->pressures.highest) / fewer.waves->pressures.highest;
        loaded->beyond = 1 / (std::pow(ratio, rate) - 1);
        loaded->kinks_by_fewer = ends_of(fewer.arcs);
        loaded->by_fewer = of_contact(load, fewer);
      }
    }
    if (!in_contact && rim.modulus > 0) loaded->kinks = ends_of(rim.acts);
  }
  return result;
}

}  // namespace fastjoint::stage3
