// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

/// An edge of the sheet through the centre of a half or quarter hole.
struct Line {
  int hole;          ///< the first hole on it
  rim::Axis across;  ///< the axis perpendicular to it
  double at;         ///< coordinate along this axis, length
  bool is_half;      ///< true for a half hole, false for a quarter hole
  int more = 0;      ///< number of other holes on it
};

/// True if a side of an element lies on the line.
bool is_on(const PlateScene& scene, const PlateMesh& plate, const Line& line, const pfem::Side& side) {
  const auto ends = plate.edges.nodes.col(plate.edges.of(side));
  const double tolerance = rim::same_place * scene.holes[line.hole].radius;
  return ((plate.mesh.nodes(rim::coordinate(line.across), ends).array() - line.at).abs() < tolerance).all();
}

/// True if a support or a rigid external prescribes the displacement across the line on some part of it.
bool is_fixed_across(const PlateScene& scene, const PlateMesh& plate, const Line& line) {
  const auto is_there = [&](const std::string& set) {
    return std::ranges::any_of(plate.sets.at(set), [&](const auto& side) { return is_on(scene, plate, line, side); });
  };
  return std::ranges::any_of(scene.supports,
                             [&](const Support& support) {
                               return std::ranges::count(support.fix, line.across) > 0 && is_there(support.on);
                             }) ||
         std::ranges::any_of(rigid_externals(scene), [&](int i) {
           return scene.externals[i].direction == line.across && is_there(scene.externals[i].on);
         });
}

/// Lines of a hole on which a support is missing.
std::vector<Line> lines_of(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns, int hole) {
  const auto pieces = rim::open_pieces(rim::side_angles(plate.mesh, plate.edges, plate.rims[hole]));
  if (!scene.holes[hole].spring || pieces.size() != 1) return {};
  const auto [from, to] = pieces[0];
  const auto covers = [&](double angle) { return std::abs(to - from - angle) < rim::same_angle; };
  const bool is_half = covers(rim::full_turn / 2);
  if (!is_half && !covers(rim::full_turn / 4)) return {};
  std::vector<Line> lines;
  for (const double end : is_half ? std::vector{from} : std::vector{from, to})
    for (const rim::Axis across : rim::both_axes) {
      if (!rim::is_along(end, rim::other(across))) continue;
      const auto* const first = unknowns.disc_direction.data() + unknowns.first_disc[hole];
      const auto* const last = unknowns.disc_direction.data() + unknowns.first_disc[hole + 1];
      const bool disc_moves_across = std::find(first, last, across) != last;
      const Line line{hole, across, scene.holes[hole].center[rim::coordinate(across)], is_half};
      // A half hole whose disc moves across the edge is a notch that a pin may press on.
      if (!(is_half && disc_moves_across) && !is_fixed_across(scene, plate, line)) lines.push_back(line);
    }
  return lines;
}

/// Advice on the support that makes it a line of symmetry, in the words of PLATE.json.
std::string support_on(const PlateScene& scene, const PlateMesh& plate, const Line& line) {
  for (const auto& [name, sides] : plate.sets)
    if (std::ranges::all_of(sides, [&](const auto& side) { return is_on(scene, plate, line, side); }))
      return fmt::format(R"(add {{"on": "{}", "fix": ["{}"]}} to "supports")", name, rim::name_of(line.across));
  return fmt::format(
      R"(name the edges on this line in /geometry/mesh/edges and add {{"on": that name, "fix": ["{}"]}} to "supports")",
      rim::name_of(line.across));
}

}  // namespace

bool ends_on_symmetry(const PlateScene& scene, const PlateMesh& plate, int hole) {
  const auto pieces = rim::open_pieces(rim::side_angles(plate.mesh, plate.edges, plate.rims[hole]));
  if (pieces.size() > 1) return false;
  const auto is_symmetric = [&](double end) {
    for (const rim::Axis across : rim::both_axes)
      if (rim::is_along(end, rim::other(across)))
        return is_fixed_across(scene, plate, {hole, across, scene.holes[hole].center[rim::coordinate(across)], false});
    return false;
  };
  return pieces.empty() || (is_symmetric(pieces[0].from) && is_symmetric(pieces[0].to));
}

std::vector<std::string> missing_symmetry(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  std::vector<Line> lines;
  for (int hole = 0; hole < count_of(scene.holes); ++hole)
    for (const Line& line : lines_of(scene, plate, unknowns, hole)) {
      const double tolerance = rim::same_place * scene.holes[hole].radius;
      const auto known = std::ranges::find_if(lines, [&](const Line& other) {
        return other.across == line.across && std::abs(other.at - line.at) < tolerance;
      });
      if (known == lines.end())
        lines.push_back(line);
      else
        ++known->more;
    }
  std::vector<std::string> result;
  for (const Line& line : lines) {
    const std::string more = line.more > 0 ? fmt::format(" (and {} more)", line.more) : "";
    result.push_back(fmt::format(
        "/holes/{}: hole \"{}\"{} is {} of a hole, cut by the line {} = {:g}, which no support fixes along {}: "
        "the disc alone carries the load of the missing part. If the sheet is symmetric about this line, {}",
        line.hole, scene.holes[line.hole].id, more, line.is_half ? "half" : "a quarter", rim::name_of(line.across),
        line.at, rim::name_of(line.across), support_on(scene, plate, line)));
  }
  return result;
}

}  // namespace fastjoint::stage1
