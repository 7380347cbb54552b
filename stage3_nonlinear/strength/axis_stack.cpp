// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/axis_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "stage3_nonlinear/model/disc_rows.hpp"

namespace fastjoint::stage3 {
namespace {

/// Sheets follow from lowest to highest as fasteners name them; a sheet above itself is a contradiction.
void check_order(const JointModel& joint, const JointScene& scene) {
  const Index n = std::ssize(joint.plates);
  Eigen::MatrixXi above = Eigen::MatrixXi::Zero(n, n);
  for (const auto& plane : joint.planes) {
    if (joint.is_to_ground(plane)) continue;
    const Index lower = joint.first_hole(plane).plate, upper = joint.second_hole(plane).plate;
    above(lower, upper) = 1;
    for (Index i = 0; i < n; ++i)  // all below the lower are below all above the upper
      for (Index k = 0; k < n; ++k)
        if ((i == lower || above(i, lower) != 0) && (k == upper || above(upper, k) != 0)) above(i, k) = 1;
    if (above.diagonal().isZero()) continue;
    refuse(scene.fasteners[plane.fastener].where + "/between",
           fmt::format("\"{}\" below \"{}\", against the order of fasteners before", joint.plates[lower].name,
                       joint.plates[upper].name),
           "the holes of every fastener from the lowest sheet to the highest, or \"bending\": \"none\"");
  }
}

/// A sheet as a beam along an axis. @param first_row Is set to its first row among disc_rows, -1 without any.
StackSheet sheet_of(const PlateModel& plate, const BendingScene& scene, int axis, Index& first_row) {
  const double tolerance = row_tolerance(plate, axis);
  std::vector<std::pair<double, bool>> nodes;  // coordinates, and whether a row is there
  const auto rows = disc_rows(plate);
  first_row = -1;
  for (Index i = 0; i < std::ssize(rows); ++i) {
    if (rows[i].axis != axis) continue;
    if (first_row < 0) first_row = i;
    nodes.emplace_back(rows[i].at, true);
  }
  const auto add = [&](double at) {
    const auto is_there = [&](const auto& node) { return std::abs(node.first - at) <= tolerance; };
    if (std::ranges::none_of(nodes, is_there)) nodes.emplace_back(at, false);
  };
  std::vector<formats::Bay> bays;
  for (const auto& bay : plate.bays)
    if (bay.direction == rim::axis_names[axis]) bays.push_back(bay);
  for (const auto& bay : bays) add(bay.from), add(bay.to);
  for (Index i = 0; i < plate.n_externals(); ++i)
    if (plate.external_axis[i] == axis) add(plate.places.external.row(i).mean());
  for (Index i = 0; i < plate.n_tractions(); ++i)
    if (plate.traction_axis[i] == axis && !plate.is_moment(i)) add(plate.places.traction.row(i).mean());
  if (plate.stress_level)  // an open hole has the moment of its place
    for (const double center : plate.stresses.rim_center.col(axis)) add(center);
  std::ranges::sort(nodes);
  StackSheet sheet;
  const Index n = std::ssize(nodes);
  sheet.at.resize(n), sheet.EI.resize(n - 1), sheet.width.resize(n - 1), sheet.thickness.resize(n - 1);
  for (Index i = 0; i < n; ++i) {
    sheet.at[i] = nodes[i].first;
    if (nodes[i].second) sheet.rows.push_back(i);
    if (i == 0) continue;
    const double middle = (nodes[i - 1].first + nodes[i].first) / 2;
    const auto found = std::ranges::find_if(bays, [&](const auto& bay) { return middle < bay.to; });
    const formats::Bay& bay = found == bays.end() ? bays.back() : *found;
    sheet.EI[i - 1] = bay.bending, sheet.width[i - 1] = bay.width, sheet.thickness[i - 1] = bay.thickness;
  }
  const auto given = scene.ends.find(plate.name);
  for (const int end : {0, 1}) {
    const bool is_held = end == 0 ? bays.front().held_from != 0 : bays.back().held_to != 0;
    const auto its = given == scene.ends.end() ? std::nullopt : given->second[2 * axis + end];
    sheet.ends[end] = its.value_or(is_held ? EndHold::hinged : EndHold::free);
  }
  return sheet;
}

/// The stack along a direction of the joint's discs.
AxisStack axis_stack(const JointModel& joint, const BendingScene& scene, Index direction) {
  AxisStack its{direction, joint.axes[direction], {}, {}, {}};
  std::vector<std::vector<DiscRow>> rows;
  for (const auto& plate : joint.plates) {
    its.stack.sheets.push_back(sheet_of(plate, scene, its.axis, its.first_row.emplace_back()));
    rows.push_back(disc_rows(plate));
  }
  const auto row_of = [&](const HoleModel& hole) {
    const auto& all = rows[hole.plate];
    const auto found = std::ranges::find_if(
        all, [&](const DiscRow& row) { return std::ranges::count(row.discs, hole.disc + direction) > 0; });
    return found == all.end() ? -1 : found - all.begin() - its.first_row[hole.plate];
  };
  for (const auto& plane : joint.planes) {
    const HoleModel& first = joint.first_hole(plane);
    StackLink link{first.plate, row_of(first), -1, -1};
    if (!joint.is_to_ground(plane)) {
      const HoleModel& second = joint.second_hole(plane);
      link.upper = second.plate, link.upper_row = row_of(second);
    }
    auto& links = its.stack.links;
    const bool moves = link.lower_row >= 0 && (link.upper < 0 || link.upper_row >= 0);
    const Index at = std::ranges::find(links, link) - links.begin();
    if (moves && at == std::ssize(links)) links.push_back(link);
    its.link_of_plane.push_back(moves ? at : -1);
  }
  return its;
}

}  // namespace

std::vector<AxisStack> axis_stacks(const JointModel& joint, const JointScene& scene) {
  std::vector<AxisStack> axes;
  if (!joint.plates.front().bends) return axes;
  check_order(joint, scene);
  for (Index d = 0; d < joint.n_directions(); ++d) axes.push_back(axis_stack(joint, scene.bending, d));
  return axes;
}

}  // namespace fastjoint::stage3
