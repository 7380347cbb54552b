// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double same = 0.05 * (1 + 1e-9);  // relative difference of diameters that are taken for one

/// Diameter of a hole in its sheet, length; 0 if the sheet's matrices do not have it.
double diameter_in_sheet(const JointModel& joint, const HoleModel& hole) {
  const PlateModel& plate = joint.plates[hole.plate];
  const std::string& name = plate.hole_of(hole.disc);
  const auto rim = std::ranges::find(plate.contact, name, &formats::ContactRim::hole);
  if (rim != plate.contact.end()) return 2 * rim->radius;
  const int at = index_of(plate.stresses.rim_hole, name);
  return at < count_of(plate.stresses.rim_hole) ? 2 * plate.stresses.rim_radius[at] : 0;
}

}  // namespace

std::vector<program::Warning> diameter_warnings(const JointScene& scene, const JointModel& joint) {
  std::vector<Doubt> given, of_sheets;
  for (Index i = 0; i < std::ssize(scene.fasteners); ++i) {
    const FastenerScene& fastener = scene.fasteners[i];
    for (Index at = 0; at < std::ssize(fastener.hole_diameter); ++at) {
      const HoleModel& hole = joint.fasteners[i].holes[at];
      const double here = fastener.hole_diameter[at], in_sheet = diameter_in_sheet(joint, hole);
      if (in_sheet > 0 && std::abs(here - in_sheet) > same * in_sheet)
        given.emplace_back(
            std::abs(here - in_sheet) / in_sheet,
            fmt::format("{}/hole_diameter: {:.6g} for hole \"{}\", whose diameter in its sheet is {:.6g}: "
                        "one of them may be a radius, another hole's, or in another unit of length",
                        fastener.where, here, joint.name(hole), in_sheet));
    }
  }
  for (const ShearPlane& plane : joint.planes) {
    const FastenerScene& fastener = scene.fasteners[plane.fastener];
    if (joint.is_to_ground(plane) || fastener.diameter) continue;  // the gaps follow from that diameter
    const HoleModel &first = joint.first_hole(plane), &second = joint.second_hole(plane);
    const double one = diameter_in_sheet(joint, first), other = diameter_in_sheet(joint, second);
    const double apart = std::abs((one - 2 * first.gap) - (other - 2 * second.gap));
    if (std::min(one, other) > 0 && apart > same * std::max(one, other) + 2 * plane.clearance)
      of_sheets.emplace_back(apart / std::min(one, other),
                             fmt::format("{}/between: holes \"{}\" and \"{}\" have the diameters {:.6g} and {:.6g} in "
                                         "their sheets, which the gaps and the clearance of their one fastener do not "
                                         "explain: one of them may be another fastener's hole, or in another unit of "
                                         "length",
                                         fastener.where, joint.name(first), joint.name(second), one, other));
  }
  std::vector<program::Warning> result;
  add_worst(result, "hole-diameter-unlike", given);
  add_worst(result, "sheet-diameters-unlike", of_sheets);
  return result;
}

}  // namespace fastjoint::stage3
