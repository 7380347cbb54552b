// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "common/rim/angles.hpp"
#include "stage1_plate/scene/read_parts.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

const std::string hole_prefix = "hole:";
// The low and the high border of x, then of y: read_cut and read_from_border count on this order.
const std::vector<std::string> borders = {"left", "right", "bottom", "top"};

/// Reads "hole:ID" as the hole's index.
int read_hole(const Value& value, const std::vector<Hole>& holes) {
  std::vector<std::string> names;
  for (const auto& hole : holes) names.push_back(hole_prefix + hole.id);
  if (names.empty())
    value.fail("\"" + value.text() + "\", but the plate has no holes", "the name of an edge of the grid");
  return index_of(names, value.choice(names));
}

/// Reads a crack between two points inside the sheet.
void read_between_points(const Value& value, Crack& crack) {
  value.only({"id", "from", "to"});
  crack.from = read_point(value.at("from"));
  crack.to = read_point(value.at("to"));
  if (crack.from == crack.to) value.at("to").not_allowed("another point than \"from\"");
  crack.tips = 2;
}

/// Unit vector at an angle; exact along an axis, so that nodes along a crack have equal digits.
Eigen::Vector2d direction_at(double angle) {
  const double quarters = 4 * angle / rim::full_turn;
  const auto nearest = std::lround(quarters);
  if (std::abs(quarters - double(nearest)) > 1e-12) return {std::cos(angle), std::sin(angle)};
  const Eigen::Vector2d along(nearest % 2 == 0 ? 1 : 0, nearest % 2 == 0 ? 0 : 1);
  return (nearest % 4 + 4) % 4 < 2 ? along : Eigen::Vector2d(-along);
}

/// Reads a crack that cuts the sheet from a hole to another one or to an edge of the grid.
void read_cut(const Value& to, const PlateScene& scene, const Hole& hole, Crack& crack) {
  crack.tips = 0;
  if (const int border = index_of(borders, to.text()); border < count_of(borders)) {
    const int axis = border / 2;
    const auto& grid = std::get<GridGeometry>(scene.geometry);
    const double place = border % 2 == 0 ? grid.lines(axis).front() : grid.lines(axis).back();
    const double across = hole.center[1 - axis];
    const bool is_on_border = across == grid.lines(1 - axis).front() || across == grid.lines(1 - axis).back();
    if (std::abs(place - hole.center[axis]) <= hole.radius || is_on_border)
      to.fail(fmt::format("\"{}\", to which hole \"{}\" has no ligament", to.text(), hole.id),
              "an edge beyond a ligament");
    crack.from = crack.to = hole.center;
    crack.to[axis] = place;
    crack.from[axis] += std::copysign(hole.radius, crack.to[axis] - hole.center[axis]);
    return;
  }
  if (!to.text().starts_with(hole_prefix)) to.not_allowed("\"hole:ID\", left, right, bottom or top");
  const Hole& other = scene.holes[read_hole(to, scene.holes)];
  if (&other == &hole) to.not_allowed("another hole than that of \"from\"");
  const Eigen::Vector2d way = other.center - hole.center;
  crack.from = hole.center + hole.radius * direction_at(std::atan2(way.y(), way.x()));
  crack.to = other.center - other.radius * (other.center - crack.from).normalized();
}

void read_from_hole(const Value& value, const PlateScene& scene, Crack& crack) {
  crack.hole = read_hole(value.at("from"), scene.holes);
  const Hole& hole = scene.holes[*crack.hole];
  if (const auto to = value.find("to")) {
    value.only({"id", "from", "to"});
    read_cut(*to, scene, hole, crack);
    return;
  }
  value.only({"id", "from", "angle", "length"});
  const Eigen::Vector2d along = direction_at(value.at("angle").number() * rim::degree);
  crack.from = hole.center + hole.radius * along;
  crack.to = crack.from + read_quantity(value.at("length")) * along;
}

void read_from_border(const Value& value, const GridGeometry& grid, Crack& crack) {
  const Value from = value.at("from");
  const int border = index_of(borders, from.text());
  if (border == count_of(borders))
    from.fail(fmt::format("\"{}\"", from.text()), "\"hole:ID\", left, right, bottom, top, or a point [x, y]");
  value.only({"id", "from", "at", "length"});
  const int axis = border / 2;
  const bool is_low = border % 2 == 0;
  const auto& lines = grid.lines(axis);
  crack.from[axis] = is_low ? lines.front() : lines.back();
  crack.from[1 - axis] = read_coordinate(value.at("at"));
  crack.to = crack.from;
  crack.to[axis] += (is_low ? 1 : -1) * read_quantity(value.at("length"));
}

void read_grid_crack(const Value& value, const PlateScene& scene, Crack& crack) {
  const Value from = value.at("from");
  if (from.is_array())
    read_between_points(value, crack);
  else if (from.text().starts_with(hole_prefix))
    read_from_hole(value, scene, crack);
  else
    read_from_border(value, std::get<GridGeometry>(scene.geometry), crack);
}

}  // namespace

std::vector<Crack> read_cracks(const Value& root, const PlateScene& scene) {
  std::vector<Crack> cracks;
  std::set<std::string> ids;
  for (const auto& item : read_items(root, "cracks")) {
    Crack& crack = cracks.emplace_back();
    const auto id = item.find("id");
    crack.id = id ? id->text() : std::to_string(cracks.size());
    if (const auto* mesh = std::get_if<MeshGeometry>(&scene.geometry)) {
      item.only({"id", "on"});
      std::vector<std::string> names;
      for (const auto& [name, edges] : mesh->edges) names.push_back(name);
      crack.on = item.at("on").choice(names);
    } else {
      read_grid_crack(item, scene, crack);
    }
    // Both tips of a crack have names of their own, which no other crack may have either.
    for (const char* end : {"", " start", " end"})
      if (!ids.insert(crack.id + end).second)
        (id ? *id : item).fail(fmt::format("a second crack or tip \"{}{}\"", crack.id, end), "each name once");
  }
  return cracks;
}

}  // namespace fastjoint::stage1
