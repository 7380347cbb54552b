// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/parameters.hpp"

#include <algorithm>

#include "stage3_nonlinear/model/fastener_gaps.hpp"
#include "stage3_nonlinear/model/free_shape.hpp"

namespace fastjoint::stage3 {

std::vector<Load> loads_of(const JointModel& joint) {
  std::vector<Load> loads;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index at = 0; at < plate.n_externals(); ++at)
      loads.push_back({i, at, false, plate.external_displacement[at].has_value()});
    for (Index at = 0; at < std::ssize(plate.tractions); ++at)
      if (!plate.is_other_side(at)) loads.push_back({i, at, true, false});
  }
  return loads;
}

std::vector<LoadCase> load_cases(const JointModel& joint) {
  std::vector<LoadCase> cases;
  const auto loads = loads_of(joint);
  for (Index load = 0; load < std::ssize(loads); ++load) {
    const auto& [at_plate, first, is_traction, is_displacement] = loads[load];
    const PlateModel& plate = joint.plates[at_plate];
    Index at = first;
    do {
      cases.push_back({load, at_plate, at, is_traction, is_displacement, is_traction ? plate.bearing_sign(at) : 0});
    } while (is_traction && plate.is_other_side(++at));
  }
  return cases;
}

namespace {

void set_free_shapes(const JointModel& joint, const std::vector<FreeShape>& shapes, Parameters& all) {
  if (std::ranges::any_of(shapes, [](const FreeShape& each) { return each.D.size() == 0 && each.De.size() == 0; }))
    return;  // not set
  all.offset = free_offsets(joint, shapes);
  all.free_De.clear();
  for (const auto& shape : shapes) all.free_De.push_back(shape.De);
  const auto loads = loads_of(joint);
  VectorXd given = VectorXd::Zero(std::ssize(loads));
  for (Index i = 0; i < given.size(); ++i)
    if (loads[i].is_displacement) given[i] = shapes[loads[i].plate].De[loads[i].at];
  all.free_given = given.isZero(0) ? VectorXd() : given;
}

}  // namespace

Parameters parameters_of(const JointModel& joint) {
  Parameters all;
  const auto loads = loads_of(joint);
  all.load.resize(std::ssize(loads));
  for (Index i = 0; i < all.load.size(); ++i) {
    const auto& [plate, at, is_traction, is_displacement] = loads[i];
    const PlateModel& its = joint.plates[plate];
    all.load[i] = is_traction       ? its.traction_force[at]
                  : is_displacement ? *its.external_displacement[at]
                                    : its.external_force[at];
  }
  std::vector<FreeShape> shapes;
  for (const auto& plate : joint.plates) shapes.push_back(plate.free);
  set_free_shapes(joint, shapes, all);
  all.clearance.resize(joint.n_planes());
  for (Index j = 0; j < joint.n_planes(); ++j) {
    all.law.push_back(joint.planes[j].law);
    all.clearance[j] = joint.planes[j].clearance;
  }
  std::vector<double> mu, gap;
  for (const auto& fastener : joint.fasteners)
    for (const auto& hole : fastener.holes) mu.push_back(hole.mu), gap.push_back(hole.gap);
  all.mu = VectorXd::Map(mu.data(), std::ssize(mu));
  all.gap = VectorXd::Map(gap.data(), std::ssize(gap));
  return all;
}

Parameters parameters_of(const JointModel& joint, const JointScene& scene, const CaseScene& its_case) {
  Parameters all = parameters_of(joint);
  Index plane = 0, hole = 0;
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i) {
    const FastenerScene& its = scene.fasteners[i];
    for (Index j = 0; j < std::ssize(its.law); ++j, ++plane) {
      all.law[plane] = scene.laws.at(its.law[j]).law;
      all.clearance[plane] = its.clearance[j];
    }
    check_clearance(joint, its, joint.fasteners[i]);
    for (Index j = 0; j < std::ssize(its.between); ++j, ++hole) {
      const PlateModel& plate = joint.plates[joint.fasteners[i].holes[j].plate];
      all.mu[hole] = its.friction[j];
      all.gap[hole] = gap_of(its, j, plate);
      check_gap(its, its.between[j].name, plate, all.gap[hole]);
      all.gap[hole] += gap_growth(joint, scene, its_case, i, j);
    }
  }
  set_free_shapes(joint, free_shapes(joint, scene, its_case), all);
  const auto loads = loads_of(joint);
  for (Index i = 0; i < std::ssize(loads); ++i) {
    const auto& [plate_at, at, is_traction, is_displacement] = loads[i];
    const PlateModel& plate = joint.plates[plate_at];
    const std::string& name = is_traction ? plate.tractions[at] : plate.externals[at];
    all.load[i] = 0;
    for (const auto& load : its_case.loads) {
      if (load.external.plate != plate.name || load.external.name != name) continue;
      all.load[i] = load.is_moment ? load.value / plate.traction_arm[at] : load.value;
      if (is_traction) check_side(plate, at, load, its_case.wanted_load_factors());
    }
  }
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
            place.hole = hole;
          ++hole;
        }
    }
  return places;
}

}  // namespace fastjoint::stage3
