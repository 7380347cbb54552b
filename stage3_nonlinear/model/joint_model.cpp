// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/joint_model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ranges>
#include <set>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "stage3_nonlinear/model/parameters.hpp"

namespace fastjoint::stage3 {
namespace {

/// What `read` makes of the file of a plate.
auto read_from(const PlateScene& plate, auto read) {
  try {
    return read(plate.file);
  } catch (const FileError& e) {
    std::error_code unreachable;  // for example if the name is too long
    const bool absent = !std::filesystem::exists(plate.file, unreachable) && !unreachable;
    throw FileError(fmt::format("{}: {}{}", plate.where, e.what(),
                                absent ? fmt::format("; stage2_extract PLATE.h5 -o {} makes it", plate.file) : ""));
  }
}

/// What the files of all plates say beside their matrices, which are read plate by plate.
std::vector<formats::UnitCases> read_unit_cases(const JointScene& scene) {
  std::vector<formats::UnitCases> all;
  for (const auto& plate : scene.plates) {
    const std::string& digest = all.emplace_back(read_from(plate, formats::read_unit_cases)).header.digest;
    if (!plate.digest.empty() && digest != plate.digest)
      refuse(plate.where + "/digest",
             fmt::format("{} has {}, not the digest {}", plate.file, digest.empty() ? "none" : digest, plate.digest),
             "the digest that stage2_extract printed when it made the file that is meant");
  }
  return all;
}

/// True if the file of a plate tells what it is as a beam along all axes, and where forces act on it.
bool is_beam(const PlateModel& plate, const std::vector<int>& axes) {
  return plate.places.is_known() && std::ranges::all_of(axes, [&](int axis) {
           return std::ranges::count(plate.bays, rim::axis_names[axis], &formats::Bay::direction) > 0;
         });
}

std::string quoted(const Units& units) { return fmt::format("length \"{}\", force \"{}\"", units.length, units.force); }

Units common_units(const JointScene& scene, const std::vector<formats::UnitCases>& all) {
  const Units& units = all[0].header.units;
  for (Index i = 1; i < std::ssize(all); ++i)
    if (!(all[i].header.units == units))
      throw InputError(fmt::format("{}: units are {}; allowed: {}, as in {}", scene.plates[i].file,
                                   quoted(all[i].header.units), quoted(units), scene.plates[0].file));
  if (scene.units && !(*scene.units == units))
    refuse(scene.file + ": /units", quoted(*scene.units), quoted(units) + ", as in " + scene.plates[0].file);
  return units;
}

/// @param p Degree that every plate must have, or 0 for the highest that all have.
int common_degree(const JointScene& scene, const std::vector<formats::UnitCases>& all, int p) {
  std::set<int> common(all[0].p.begin(), all[0].p.end());
  std::string each;
  for (Index i = 0; i < std::ssize(all); ++i) {
    const std::set<int> own(all[i].p.begin(), all[i].p.end());
    std::erase_if(common, [&](int degree) { return !own.contains(degree); });
    each += fmt::format("{}{} has p = {}", i == 0 ? "" : ", ", scene.plates[i].file, fmt::join(own, ", "));
  }
  if (common.empty())
    throw InputError(fmt::format("{}: the plates have no polynomial degree in common: {}", scene.file, each));
  if (p != 0 && !common.contains(p))
    throw InputError(fmt::format("--p: {} is not in the matrices of every plate of {}; allowed: {}", p, scene.file,
                                 fmt::join(common, ", ")));
  return p == 0 ? *common.rbegin() : p;
}

/// Directions of the discs of a hole, "x and y".
std::string directions_at(const PlateModel& plate, Index first_disc) {
  std::vector<std::string> names;
  for (Index d = 0; d < std::ssize(plate.axes); ++d)
    if (plate.has_disc(first_disc + d)) names.emplace_back(rim::axis_names[plate.axes[d]]);
  return fmt::format("{}", fmt::join(names, " and "));
}

/// Refuses a fastener whose discs do not all have the same directions.
void check_directions(const JointModel& model, const FastenerScene& scene, const FastenerModel& fastener) {
  const auto directions = [&](const HoleModel& hole) { return directions_at(model.plates[hole.plate], hole.disc); };
  const HoleModel& first = fastener.holes[0];
  for (const auto& hole : fastener.holes)
    if (directions(hole) != directions(first))
      refuse(scene.where + "/between",
             fmt::format("the disc of hole \"{}\" moves along {}, that of hole \"{}\" along {}", model.name(first),
                         directions(first), model.name(hole), directions(hole)),
             fmt::format(
                 "discs of the same directions: whole holes of sheets with the same \"disc_directions\", as {} has "
                 "them, or half holes on one line of symmetry",
                 model.plates[first.plate].file));
}

/// The friction case of a hole for the side that bears along an axis.
FrictionCase friction_case(const PlateModel& plate, const std::string& hole, double mu, int axis, Side side) {
  const std::string bearing = name_of(rim::SignedAxis{static_cast<rim::Axis>(axis), side == plus_side ? 1 : -1});
  for (Index i = 0; i < std::ssize(plate.friction_unit_force); ++i) {
    if (plate.friction_hole[i] != hole || plate.friction_bearing[i] != bearing) continue;
    const double c = plate.friction_unit_force[i];
    if (!(c > 0))
      throw InputError(fmt::format(
          "{}:friction/unit_force: hole \"{}\" has {} on its side {}: no rim there can bear, so friction {} has no "
          "meaning; allowed: a value > 0, a law with \"one_sided\" that never bears there, or friction 0",
          plate.file, hole, c, bearing, mu));
    return {i, c, std::abs(plate.friction_resultant[i])};
  }
  throw InputError(
      fmt::format("{}:friction/hole: has no friction case for hole \"{}\" bearing {}, but its fastener has friction "
                  "{}; run stage 2 again, or set the friction to 0",
                  plate.file, hole, bearing, mu));
}

/// Sides of a fastener's hole on which its planes can bear: F > 0 acts on the second plate along +, on the first along
/// -.
std::array<bool, 2> bearing_sides(const JointScene& scene, const FastenerScene& fastener, Index hole) {
  std::array<bool, 2> sides{};
  for (Index plane = hole > 0 ? hole - 1 : 0; plane < std::min(hole + 1, std::ssize(fastener.law)); ++plane) {
    const Side positive = plane == hole ? minus_side : plus_side;
    sides[positive] = true;
    if (!scene.laws.at(fastener.law[plane]).one_sided) sides[1 - positive] = true;
  }
  return sides;
}

/// Refuses a half hole whose disc may move along the normal of its line of symmetry: by symmetry the disc of the whole
/// hole stays on that line, but bearing on half a rim would move it off.
void check_rim_all_around(const PlateModel& plate, const std::string& hole) {
  for (Index i = 0; i < plate.n_friction_cases(); ++i)
    if (plate.friction_hole[i] == hole && !(plate.friction_unit_force[i] > 0) && !plate.is_in_contact(hole))
      throw InputError(fmt::format(
          "{}:friction/unit_force: hole \"{}\" has no rim on its side {}, but its disc moves along x and y, off its "
          "line of symmetry too; allowed: whole holes, or \"disc_directions\" along that line alone",
          plate.file, hole, plate.friction_bearing[i]));
}

HoleModel make_hole(const JointModel& model, const JointScene& scene, const FastenerScene& fastener, Index at) {
  const Reference& hole = fastener.between[at];
  const Index plate_at = index_of(model.plates, hole.plate, &PlateModel::name);
  const PlateModel& plate = model.plates[plate_at];
  const Index index = index_of(plate.holes, hole.name);
  if (index == std::ssize(plate.holes))
    refuse(hole.where, fmt::format("hole \"{}\" does not exist in {}", hole.name, plate.file),
           plate.holes.empty() ? "none: the sheet has no hole with a spring"
                               : fmt::format("{}", fmt::join(plate.holes, ", ")));
  const double mu = fastener.friction[at];
  HoleModel result{plate_at, index * model.n_directions(), mu != 0};
  if (directions_at(plate, result.disc) == "x and y") check_rim_all_around(plate, hole.name);
  if (mu == 0) return result;
  if (plate.is_in_contact(hole.name)) return result;
  const auto sides = bearing_sides(scene, fastener, at);
  for (Index d = 0; d < model.n_directions(); ++d) {
    auto& friction = result.friction.emplace_back();
    const Index other = result.disc + 1 - d;
    for (const Side side : {plus_side, minus_side}) {
      if (!sides[side] || !plate.has_disc(result.disc + d)) continue;
      friction[side] = friction_case(plate, hole.name, mu, model.axes[d], side);
      if (model.n_directions() == 2 && plate.has_disc(other))
        friction[side].across = entry_or_0(plate.friction_resultant_across, friction[side].column);
    }
  }
  return result;
}

void add_fastener(JointModel& model, const JointScene& scene, const FastenerScene& fastener) {
  for (Index plane = 0; plane < std::ssize(fastener.law); ++plane) {
    const LawScene& law = scene.laws.at(fastener.law[plane]);
    if (law.one_sided && model.n_directions() > 1)
      refuse(fastener.where + "/law",
             fmt::format("law \"{}\" is one_sided, but the discs move along x and y", fastener.law[plane]),
             "laws that bear all around, or plates whose discs have one direction");
    model.planes.push_back({std::ssize(model.fasteners), plane, fastener.law[plane], law.one_sided});
  }
  FastenerModel result{fastener.id, {}, fastener.law_includes_friction, fastener.grounded};
  for (Index i = 0; i < std::ssize(fastener.between); ++i) result.holes.push_back(make_hole(model, scene, fastener, i));
  check_directions(model, fastener, result);
  for (const auto& hole : result.holes)  // at a rim of contact the force on the disc includes friction already
    result.law_includes_friction |= model.plates[hole.plate].is_in_contact(model.plates[hole.plate].hole_of(hole.disc));
  model.fasteners.push_back(std::move(result));
}

/// Name of the plate on the second side of a plane, or that of the ground.
std::string second_plate(const JointModel& joint, const ShearPlane& plane) {
  return joint.is_to_ground(plane) ? ground_name : joint.plates[joint.second_hole(plane).plate].name;
}

}  // namespace

Index JointModel::offset(Index plate) const {
  Index offset = 0;
  for (Index i = 0; i < plate; ++i) offset += plates[i].n_unknowns();
  return offset;
}

std::vector<Index> JointModel::rim_sizes() const {
  std::vector<Index> sizes;
  for (const auto& plate : plates)
    for (Index i = 0; i < std::ssize(plate.contact); ++i) sizes.push_back(plate.waves[i].waves.size());
  return sizes;
}

Index JointModel::n_moments() const {
  Index n = 0;
  for (const auto& plate : plates) n += plate.n_unknowns() - plate.first_moment();
  return n;
}

Index JointModel::number_of_first_hole(const ShearPlane& plane) const {
  Index first = plane.first;
  for (Index i = 0; i < plane.fastener; ++i) first += std::ssize(fasteners[i].holes);
  return first;
}

std::optional<Index> JointModel::described(const HoleModel& hole) const {
  const auto& holes = plates[hole.plate].stresses.rim_hole;
  const int at = index_of(holes, plates[hole.plate].hole_of(hole.disc));
  return at < count_of(holes) ? std::optional<Index>(at) : std::nullopt;
}

std::vector<std::string> JointModel::rims() const {
  std::vector<std::string> names;
  for (const auto& plate : plates)
    for (const auto& rim : plate.contact) names.push_back(plate.name + ":" + rim.hole);
  return names;
}

std::string JointModel::name(const HoleModel& hole) const {
  return plates[hole.plate].name + ":" + plates[hole.plate].hole_of(hole.disc);
}

std::string JointModel::name(const ShearPlane& plane) const {
  const FastenerModel& fastener = fasteners[plane.fastener];
  std::string id = fmt::format("fastener \"{}\"", fastener.id);
  if (fastener.n_planes() == 1) return id;
  return fmt::format("{} between \"{}\" and \"{}\"", id, plates[first_hole(plane).plate].name,
                     second_plate(*this, plane));
}

std::string JointModel::short_name(const ShearPlane& plane) const {
  const FastenerModel& fastener = fasteners[plane.fastener];
  if (fastener.n_planes() == 1) return fastener.id;
  return fmt::format("{} ({}-{})", fastener.id, plates[first_hole(plane).plate].name, second_plate(*this, plane));
}

JointModel load_joint(const JointScene& scene, int p) {
  const auto all = read_unit_cases(scene);
  JointModel model;
  model.file = scene.file;
  model.units = common_units(scene, all);
  model.p = common_degree(scene, all, p);
  std::vector<std::string> files;
  for (const auto& plate : scene.plates) files.push_back(plate.file);
  model.axes = joint_axes(files, all);
  for (Index i = 0; i < std::ssize(all); ++i)
    model.plates.push_back(make_plate(scene.plates[i].name, files[i],
                                      read_from(scene.plates[i], formats::read_plate_matrices), model.p, model.axes));
  const bool bends = scene.bending.is_wanted &&
                     std::ranges::all_of(model.plates, [&](const auto& plate) { return is_beam(plate, model.axes); });
  for (auto& plate : model.plates) plate.bends = bends;
  for (const auto& fastener : scene.fasteners) add_fastener(model, scene, fastener);
  for (const auto& each : scene.cases) (void)parameters_of(model, scene, each);  // checks them
  return model;
}

}  // namespace fastjoint::stage3
