// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/joint_numbers.hpp"

#include <map>

namespace fastjoint::stage3 {
namespace {

void add_laws(const JointModel& joint, const Parameters& parameters, JointNumbers& numbers) {
  const Index first_column = 1 + joint.n_planes();
  std::map<std::string, Index> first;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const std::string& name = joint.planes[j].law_name;
    const auto [at, is_new] = first.try_emplace(name, first_column + std::ssize(numbers.law));
    numbers.of_law.push_back(at->second);
    if (!is_new) continue;
    for (const auto& parameter : parameters.law[j]->parameters()) numbers.law.emplace_back(name, parameter);
  }
}

void add_friction(const JointModel& joint, const Parameters& parameters, JointNumbers& numbers) {
  Index column = 1 + numbers.n_planes + std::ssize(numbers.law), number = 0;
  for (const auto& fastener : joint.fasteners)
    for (const auto& hole : fastener.holes) {
      const bool has_friction = parameters.mu[number++] > 0 && !hole.friction.empty();
      numbers.of_friction.push_back(has_friction ? column++ : -1);
      if (has_friction) numbers.friction.push_back(joint.name(hole));
    }
  numbers.gap = joint.rims();
  const auto places = rim_places(joint);
  for (Index i = 0; i < std::ssize(places); ++i) {
    const bool has_friction = places[i].hole >= 0 && parameters.mu[places[i].hole] != 0;
    numbers.of_rim.push_back(has_friction ? column++ : -1);
    if (has_friction) numbers.rim_friction.push_back(numbers.gap[i]);
  }
}

void add_loads(const JointModel& joint, const std::vector<bool>& displaced, JointNumbers& numbers) {
  const auto loads = loads_of(joint);
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Load& load = loads[i];
    const PlateModel& plate = joint.plates[load.plate];
    (displaced[i] ? numbers.displacement : numbers.force)
        .push_back(plate.name + ":" + (load.is_traction ? plate.traction_id : plate.external_id)[load.at]);
  }
  Index displacement = numbers.first_gap() - std::ssize(numbers.displacement);
  Index force = displacement - std::ssize(numbers.force);
  for (const bool is_displaced : displaced) numbers.of_load.push_back(is_displaced ? displacement++ : force++);
}

}  // namespace

Index JointNumbers::column(const Change& change) const {
  switch (change.kind) {
    case NumberKind::clearance:
      return 1 + change.at;
    case NumberKind::law:
      return of_law[change.at] + change.number;
    case NumberKind::mu:
      return of_friction[change.at];
    case NumberKind::rim_mu:
      return of_rim[change.at];
    case NumberKind::gap:
      break;
  }
  return first_gap() + change.at;
}

std::vector<formats::NumberColumns> JointNumbers::kinds() const {
  using columns::length, columns::ratio;
  constexpr columns::Dimension by_law{0, 0, "law_unit"};
  std::vector<formats::NumberColumns> all{
      {"load_factor", "the load factor", ratio, 1},
      {"clearance", "the clearance of each shear plane", length, n_planes},
      {"law", "each number of the laws", by_law, std::ssize(law)},
      {"mu", "the coefficient of friction of each hole", ratio, std::ssize(friction) + std::ssize(rim_friction)},
      {"force", "the force on each at load factor 1", columns::force, std::ssize(force)},
      {"displacement", "the displacement of each at load factor 1", length, std::ssize(displacement)},
      {"gap", "the radial gap of each", length, std::ssize(gap)}};
  Index first = 0;
  for (auto& each : all) each.first = std::exchange(first, first + each.n);
  return all;
}

JointNumbers joint_numbers(const JointModel& joint, const Parameters& parameters) {
  JointNumbers numbers;
  numbers.n_planes = joint.n_planes();
  add_laws(joint, parameters, numbers);
  add_friction(joint, parameters, numbers);
  add_loads(joint, parameters.held.displaced, numbers);
  return numbers;
}

}  // namespace fastjoint::stage3
