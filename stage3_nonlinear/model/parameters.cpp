// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/count.hpp"
#include "stage3_nonlinear/model/fastener_gaps.hpp"

namespace fastjoint::stage3 {

std::vector<Load> loads_of(const JointModel& joint) {
  std::vector<Load> loads;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index at = 0; at < plate.n_externals(); ++at) loads.push_back({i, at, false});
    for (Index at = 0; at < plate.n_tractions(); ++at)
      if (!plate.is_other_side(at)) loads.push_back({i, at, true});
  }
  return loads;
}

std::vector<LoadColumn> load_columns(const JointModel& joint, const Held& held) {
  std::vector<LoadColumn> columns;
  const auto loads = loads_of(joint);
  for (Index load = 0; load < std::ssize(loads); ++load) {
    const auto& [at_plate, first, is_traction] = loads[load];
    const PlateModel& plate = joint.plates[at_plate];
    Index at = first;
    do {
      columns.push_back(
          {load, at_plate, at, is_traction, held.displaced[load], is_traction ? plate.bearing_sign(at) : 0});
    } while (is_traction && plate.is_other_side(++at));
  }
  return columns;
}

namespace {

/// Refuses a force on a side of a hole that the model does not have. @param factors The requested load factors.
void check_side(const PlateModel& plate, Index traction, const LoadScene& load, const std::vector<double>& factors) {
  for (const double factor : factors) {
    bool has_side = load.value * factor == 0;
    for (Index i = 0; i < plate.n_tractions(); ++i)
      has_side = has_side || (plate.traction_id[i] == plate.traction_id[traction] &&
                              is_active(plate.bearing_sign(i), factor * load.value));
    if (!has_side)
      refuse(load.external.where,
             fmt::format("\"{}\" carries the force {:g} at load factor {:g}, and {} has no rim on the side of the hole "
                         "that would bear",
                         load.external.name, factor * load.value, factor, plate.file),
             "a force of the other sign, or a sheet that has the whole hole");
  }
}

/// Refuses a load that a traction cannot carry.
void check_traction(const PlateModel& plate, Index traction, const LoadScene& load) {
  const Reference& name = load.external;
  const bool is_moment = plate.is_moment(traction);
  if (load.is_displacement)
    refuse(name.where, fmt::format("\"{}\" carries a traction and has no single displacement", name.name),
           is_moment ? "\"moment\"" : "\"force\", or an external of kind \"rigid\"");
  if (is_moment != load.is_moment)
    refuse(name.where, fmt::format("\"{}\" carries a {}", name.name, is_moment ? "moment" : "force"),
           is_moment ? "\"moment\", force x length" : "\"force\", or an external of kind \"moment\"");
}

/// Ties the externals of a load.
void tie(const JointModel& joint, const LoadScene& load, Held& held) {
  std::vector<Reference> names{load.external};
  names.insert(names.end(), load.tied.begin(), load.tied.end());
  auto& group = held.ties.emplace_back();
  for (const auto& name : names) {
    const Index at = index_of(joint.plates, name.plate, &PlateModel::name);
    const PlateModel& plate = joint.plates[at];
    const Index external = index_of(plate.external_id, name.name);
    if (external == plate.n_externals())
      refuse(name.where, fmt::format("\"{}:{}\" is no rigid external", name.plate, name.name),
             "externals of kind \"rigid\" in a tie");
    if (!group.empty() && plate.external_axis[external] != joint.plates[group[0].first].external_axis[group[0].second])
      refuse(name.where, fmt::format("\"{}:{}\" moves along another axis than the first", name.plate, name.name),
             "externals of one direction in a tie");
    group.emplace_back(at, external);
  }
}

/// @param factors The requested load factors.
void set_load(const JointModel& joint, const LoadScene& load, const std::vector<double>& factors, Parameters& all) {
  const Reference& name = load.external;
  const Index at_plate = index_of(joint.plates, name.plate, &PlateModel::name);
  const PlateModel& plate = joint.plates[at_plate];
  const Index rigid = index_of(plate.external_id, name.name), traction = index_of(plate.traction_id, name.name);
  const bool is_rigid = rigid < plate.n_externals();
  if (is_rigid && load.is_moment)
    refuse(name.where, fmt::format("\"{}\" moves along an axis and takes no moment", name.name),
           "\"force\" or \"displacement\", or an external of kind \"moment\"");
  if (!is_rigid && traction == plate.n_tractions()) {
    auto known = plate.external_id;
    std::ranges::unique_copy(plate.traction_id, std::back_inserter(known));
    refuse(name.where, fmt::format("external \"{}\" does not exist in {}", name.name, plate.file),
           known.empty() ? "none: this plate has no external boundary" : fmt::format("{}", fmt::join(known, ", ")));
  }
  if (!is_rigid) {
    check_traction(plate, traction, load);
    check_side(plate, traction, load, factors);
  }
  const Index at = index_of(loads_of(joint), Load{at_plate, is_rigid ? rigid : traction, !is_rigid});
  all.load[at] = load.is_moment ? load.value / plate.traction_arm[traction] : load.value;
  all.held.displaced[at] = load.is_displacement;
  if (!load.tied.empty()) tie(joint, load, all.held);
}

/// Refuses loads that are not in balance on a sheet that nothing holds.
void check_balance(const JointModel& joint, const CaseScene& its, const VectorXd& load) {
  constexpr double rounding = 1e-9;  // of the sum of magnitudes
  const auto loads = loads_of(joint);
  for (Index at = 0; at < std::ssize(joint.plates); ++at) {
    const PlateModel& plate = joint.plates[at];
    if (!plate.is_free_body()) continue;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), magnitude = sum;
    for (Index i = 0; i < load.size(); ++i) {
      if (loads[i].plate != at) continue;
      const Eigen::Vector3d its_load = load[i] * plate.resultant(loads[i].at);
      sum += its_load;
      magnitude += its_load.cwiseAbs();
    }
    const double force = magnitude.head<2>().sum();
    double moment = magnitude[2];
    for (const auto& piece : plate.border)
      moment = std::max(moment, force * (piece.from - Eigen::Vector2d(plate.held_at)).norm());
    if (sum.head<2>().norm() <= rounding * force && std::abs(sum[2]) <= rounding * moment) continue;
    refuse(its.where_loads,
           fmt::format(
               "the loads on \"{}\", which has no support, have a resultant: force ({:.6g}, {:.6g}), moment {:.6g} "
               "about ({:.6g}, {:.6g})",
               plate.name, sum[0], sum[1], sum[2], plate.held_at[0], plate.held_at[1]),
           "loads in balance, or a sheet with \"supports\"");
  }
}

/// Sets the laws, clearances, friction and gaps.
void set_fasteners(const JointModel& joint, const JointScene& scene, const CaseScene& its_case, Parameters& all) {
  std::vector<double> clearance, mu, gap;
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i) {
    const FastenerScene& its = scene.fasteners[i];
    for (const auto& name : its.law) all.law.push_back(scene.laws.at(name).law);
    clearance.insert(clearance.end(), its.clearance.begin(), its.clearance.end());
    mu.insert(mu.end(), its.friction.begin(), its.friction.end());
    check_clearance(joint, its, joint.fasteners[i]);
    for (Index j = 0; j < std::ssize(its.between); ++j) {
      const PlateModel& plate = joint.plates[joint.fasteners[i].holes[j].plate];
      const double at_rest = gap_of(its, j, plate);
      check_gap(its, its.between[j].name, plate, at_rest);
      gap.push_back(at_rest + gap_growth(joint, scene, its_case, i, j));
    }
  }
  const auto vector = [](const std::vector<double>& list) { return VectorXd::Map(list.data(), std::ssize(list)); };
  all.clearance = vector(clearance);
  all.mu = vector(mu);
  all.gap = vector(gap);
}

}  // namespace

void set_free_shapes(const JointModel& joint, std::vector<FreeShape> shapes, Parameters& all) {
  all.offset = free_offsets(joint, shapes);
  const auto loads = loads_of(joint);
  VectorXd given = VectorXd::Zero(std::ssize(loads));
  for (Index i = 0; i < given.size(); ++i)
    if (all.held.displaced[i]) given[i] = shapes[loads[i].plate].De[loads[i].at];
  all.free_given = given.isZero(0) ? VectorXd() : given;
  all.free = std::move(shapes);
}

Parameters parameters_of(const JointModel& joint, const JointScene& scene, const CaseScene& its) {
  Parameters all;
  const Index n_loads = std::ssize(loads_of(joint));
  all.load = VectorXd::Zero(n_loads);
  all.held.displaced.resize(n_loads);
  for (const auto& load : its.loads) set_load(joint, load, its.wanted_load_factors(), all);
  check_balance(joint, its, all.load);
  set_fasteners(joint, scene, its, all);
  set_free_shapes(joint, free_shapes(joint, scene, its), all);
  return all;
}

std::vector<RimPlace> rim_places(const JointModel& joint) {
  std::vector<RimPlace> places;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index at = 0; at < std::ssize(joint.plates[i].contact); ++at) {
      RimPlace& place = places.emplace_back(RimPlace{i, at});
      Index hole = 0;
      for (const auto& fastener : joint.fasteners)
        for (const auto& its : fastener.holes) {
          if (its.plate == i && joint.plates[i].hole_of(its.disc) == joint.plates[i].contact[at].hole)
            place.hole = hole, place.has_friction = its.has_friction;
          ++hole;
        }
    }
  return places;
}

}  // namespace fastjoint::stage3
