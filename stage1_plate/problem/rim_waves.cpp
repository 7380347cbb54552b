// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "common/count.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

/// Throws InputError if the springs of contact are so much stiffer or softer than the sheet around them that its
/// numbers do not resolve where they touch.
void check_modulus(const PlateScene& scene, const PlateMesh& plate, int hole) {
  constexpr double softest = 1e-5, stiffest = 1e4;
  const double modulus = scene.holes[hole].sprung().modulus, radius = scene.holes[hole].radius;
  for (const auto& side : plate.rims[hole].sides) {
    const Eigen::Matrix3d compliance = scene.elasticity[plate.mesh.material[side.element]].inverse();
    const double E = compliance.diagonal().head<2>().cwiseInverse().maxCoeff(), ratio = modulus * radius / E;
    if (ratio < softest || ratio > stiffest)
      reject(scene, fmt::format("/holes/{}/spring", hole),
             fmt::format("springs of contact of modulus {:.6g} are {:.3g} times E / radius of the sheet, {:.6g}",
                         modulus, ratio, E / radius),
             fmt::format("{:g} to {:g} times; for a rigid pin \"disk\" of {:.6g} with \"law\": \"elastic\"", softest,
                         stiffest, 1000 * E));
  }
}

/// Throws InputError if the rim of a hole in contact is in several pieces or of several thicknesses.
void check_contact(const PlateScene& scene, const PlateMesh& plate, int hole, std::size_t n_pieces) {
  const auto fail = [&](const std::string& found, const char* allowed) {
    reject(scene, fmt::format("/holes/{}/spring/compression_only", hole), found, allowed);
  };
  const rim::Rim& rim = plate.rims[hole];
  if (n_pieces > 1)
    fail(fmt::format("the rim of hole \"{}\" is in {} pieces", scene.holes[hole].id, n_pieces),
         "compression-only springs on a whole rim or one connected part of it");
  for (const auto& side : rim.sides)
    if (plate.mesh.thickness[side.element] != plate.mesh.thickness[rim.sides[0].element])
      fail(fmt::format("the sheet has several thicknesses around hole \"{}\"", scene.holes[hole].id),
           "compression-only springs on a rim of one thickness");
  if (scene.holes[hole].sprung().disk.is_given() && !ends_on_symmetry(scene, plate, hole))
    reject(scene, fmt::format("/holes/{}/spring/disk/law", hole),
           fmt::format("\"elastic\" at hole \"{}\", which ends on a free border", scene.holes[hole].id),
           "\"elastic\" at a whole hole or at a half hole on a line of symmetry, or another law");
}

}  // namespace

Eigen::Matrix3d rim_compliance(const PlateScene& scene, const PlateMesh& plate, int hole) {
  const auto& sides = plate.rims[hole].sides;
  if (sides.empty() || plate.is_cracked[hole] || !ends_on_symmetry(scene, plate, hole)) return Eigen::Matrix3d::Zero();
  const int element = sides[0].element, material = plate.mesh.material[element];
  for (const auto& side : sides)
    if (plate.mesh.thickness[side.element] != plate.mesh.thickness[element] ||
        plate.mesh.material[side.element] != material)
      return Eigen::Matrix3d::Zero();
  return scene.elasticity[material].inverse();
}

std::vector<std::optional<rim::Waves>> rim_waves(const PlateScene& scene, const PlateMesh& plate) {
  const auto needed = needed_orders(scene, plate);
  std::vector<std::optional<rim::Waves>> all;
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const Hole& hole = scene.holes[i];
    auto& waves = all.emplace_back();
    const bool in_contact = hole.spring && hole.spring->compression_only;
    const auto pieces = rim::open_pieces(rim::side_angles(plate.mesh, plate.edges, plate.rims[i]));
    if (in_contact) check_contact(scene, plate, i, pieces.size()), check_modulus(scene, plate, i);
    rim::Harmonics shape{rim::max_harmonics};
    if (!pieces.empty()) shape.start = pieces[0].from, shape.sweep = pieces[0].to - pieces[0].from;
    const int resolved = resolved_order(scene.p_high, count_of(plate.rims[i].sides) * rim::full_turn / shape.sweep);
    const bool is_linked = hole.spring && hole.spring->link > 0;
    if (!(rim_compliance(scene, plate, i)(0, 0) > 0 && shape.repeats())) {
      // The waves of the elements are all that there are. A short crack feels the stress of its place on the rim, for
      // which 16 are too few; more than the elements resolve do not help.
      constexpr int least_order = 16, most_orders = 64;
      const int order = plate.is_cracked[i] ? std::clamp(resolved, least_order, most_orders) : least_order;
      shape.highest = in_contact ? hole.spring->harmonics.value_or(order) : 0;
      if (in_contact) waves = {shape, true};
      continue;
    }
    if (in_contact) shape.highest = hole.spring->harmonics.value_or(shape.highest);
    if (!in_contact && (!hole.stresses || is_linked)) continue;
    shape.highest = std::min(shape.highest, hole.waves > 0 ? hole.waves : std::min(needed[i], resolved));
    waves = {shape, in_contact};
  }
  return all;
}

}  // namespace fastjoint::stage1
