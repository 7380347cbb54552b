// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/joint_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/errors.hpp"

namespace fastjoint::stage3 {
namespace {

using formats::PlateMatrices;

std::optional<Eigen::Index> index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return found - names.begin();
}

std::vector<PlateMatrices> read_all(const JointScene& scene) {
  std::vector<PlateMatrices> all;
  all.reserve(scene.plates.size());
  for (const auto& plate : scene.plates) all.push_back(formats::read_plate_matrices(plate.file));
  return all;
}

std::string quoted(const formats::Units& units) {
  return fmt::format("length \"{}\", force \"{}\"", units.length, units.force);
}

formats::Units common_units(const JointScene& scene, const std::vector<PlateMatrices>& all) {
  const formats::Units& units = all[0].header.units;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (!(all[i].header.units == units))
      throw InputError(fmt::format("{}: units are {}; allowed: {}, as in {}", scene.plates[i].file,
                                   quoted(all[i].header.units), quoted(units), scene.plates[0].file));
  if (scene.units && !(*scene.units == units))
    refuse(scene.file + ": /units", quoted(*scene.units), quoted(units) + ", as in " + scene.plates[0].file);
  return units;
}

/// Degrees that every plate has, ascending.
std::set<int> common_degrees(const JointScene& scene, const std::vector<PlateMatrices>& all) {
  std::set<int> common(all[0].p.begin(), all[0].p.end());
  std::string each;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::set<int> own(all[i].p.begin(), all[i].p.end());
    std::erase_if(common, [&](int degree) { return !own.contains(degree); });
    each += fmt::format("{}{} has p = {}", i == 0 ? "" : ", ", scene.plates[i].file, fmt::join(own, ", "));
  }
  if (common.empty())
    throw InputError(fmt::format("{}: the plates have no polynomial degree in common: {}", scene.file, each));
  return common;
}

int chosen_degree(const JointScene& scene, const std::vector<PlateMatrices>& all, int p) {
  const auto degrees = common_degrees(scene, all);
  if (p == 0) return *degrees.rbegin();
  if (!degrees.contains(p))
    throw InputError(fmt::format("--p: {} is not in the matrices of every plate of {}; allowed: {}", p, scene.file,
                                 fmt::join(degrees, ", ")));
  return p;
}

/// The friction case of one end for one sign of F: F > 0 pushes the second plate to +x and the first to -x.
FrictionLoad friction_load(const PlateModel& plate, const std::string& hole, double mu, End end, Sign sign) {
  const bool plus = (end == second_plate) == (sign == positive_force);
  const char* bearing = plus ? "+x" : "-x";
  for (Eigen::Index i = 0; i < plate.friction_unit_force.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (plate.friction_hole[at] != hole || plate.friction_bearing[at] != bearing) continue;
    const double c = plate.friction_unit_force[i];
    if (!(c > 0))
      throw InputError(
          fmt::format("{}:friction/unit_force: hole \"{}\" has {} on its side {}: no rim there can bear, so friction "
                      "{} has no meaning; allowed: a value > 0, a law with \"one_sided\" that never bears there, or "
                      "friction 0",
                      plate.file, hole, c, bearing, mu));
    return {plate.R.col(i) * (mu / c), std::abs(plate.friction_resultant[i]) * mu / c, i, mu / c};
  }
  throw InputError(
      fmt::format("{}:friction/hole: has no friction case for hole \"{}\" bearing {}, but its fastener has "
                  "friction {}; run stage 2 again, or set the friction to 0",
                  plate.file, hole, bearing, mu));
}

FastenerEnd fastener_end(const JointModel& model, const FastenerScene& scene, End end, bool one_sided) {
  const Reference& hole = scene.between[end];
  const auto is_named = [&](const PlateModel& plate) { return plate.name == hole.plate; };
  const auto plate = std::find_if(model.plates.begin(), model.plates.end(), is_named);
  const auto disc = index_of(plate->holes, hole.name);
  if (!disc)
    refuse(hole.where, fmt::format("hole \"{}\" does not exist in {}", hole.name, plate->file),
           fmt::format("{}", fmt::join(plate->holes, ", ")));
  FastenerEnd result{static_cast<std::size_t>(plate - model.plates.begin()), *disc, {}};
  const double mu = scene.friction[end];
  if (mu == 0) return result;
  result.friction[positive_force] = friction_load(*plate, hole.name, mu, end, positive_force);
  if (!one_sided) result.friction[negative_force] = friction_load(*plate, hole.name, mu, end, negative_force);
  return result;
}

FastenerModel make_fastener(const JointModel& model, const JointScene& scene, const FastenerScene& fastener) {
  const LawScene& law = scene.laws.at(fastener.law);
  return {.id = fastener.id,
          .ends = {fastener_end(model, fastener, first_plate, law.one_sided),
                   fastener_end(model, fastener, second_plate, law.one_sided)},
          .law = law.law,
          .gap = law.law->delta0() + fastener.clearance,
          .one_sided = law.one_sided};
}

void apply_load(JointModel& model, const LoadScene& load) {
  const Reference& name = load.external;
  const auto is_named = [&](const PlateModel& candidate) { return candidate.name == name.plate; };
  PlateModel& plate = *std::find_if(model.plates.begin(), model.plates.end(), is_named);
  if (const auto rigid = index_of(plate.externals, name.name)) {
    if (load.is_displacement) {
      plate.external_displacement[static_cast<std::size_t>(*rigid)] = load.value;
    } else {
      plate.external_force[*rigid] = load.value;
    }
  } else if (const auto traction = index_of(plate.tractions, name.name)) {
    if (load.is_displacement)
      refuse(name.where, fmt::format("\"{}\" carries a traction and has no single displacement", name.name),
             "\"force\", or an external of kind \"rigid\"");
    plate.traction_force[*traction] = load.value;
  } else {
    auto known = plate.externals;
    known.insert(known.end(), plate.tractions.begin(), plate.tractions.end());
    refuse(name.where, fmt::format("external \"{}\" does not exist in {}", name.name, plate.file),
           known.empty() ? "none: this plate has no external boundary" : fmt::format("{}", fmt::join(known, ", ")));
  }
}

}  // namespace

Eigen::Index JointModel::offset(std::size_t plate) const {
  Eigen::Index offset = 0;
  for (std::size_t i = 0; i < plate; ++i) offset += plates[i].n_unknowns();
  return offset;
}

JointModel load_joint(const JointScene& scene, int p) {
  const auto all = read_all(scene);
  JointModel model;
  model.file = scene.file;
  model.units = common_units(scene, all);
  model.p = chosen_degree(scene, all, p);
  for (std::size_t i = 0; i < all.size(); ++i)
    model.plates.push_back(make_plate(scene.plates[i].name, scene.plates[i].file, all[i], model.p));
  for (const auto& fastener : scene.fasteners) model.fasteners.push_back(make_fastener(model, scene, fastener));
  for (const auto& load : scene.loads) apply_load(model, load);
  return model;
}

}  // namespace fastjoint::stage3
