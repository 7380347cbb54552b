// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/read_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

using input::Value;

int read_hole(const Value& value, const PlateScene& scene) {
  std::vector<std::string> ids;
  for (const auto& hole : scene.holes) ids.push_back(hole.id);
  if (ids.empty()) value.fail("the plate has no holes", "sections beside holes");
  return index_of(ids, value.choice(ids));
}

std::string read_side(const Value& value, const PlateScene& scene) {
  std::string side = value.choice({"+x", "-x", "+y", "-y"});
  const std::string direction = side.substr(1);
  const auto& directions = scene.disc_directions;
  if (std::find(directions.begin(), directions.end(), direction) == directions.end())
    value.fail(fmt::format("\"{}\", but \"{}\" is not one of \"disc_directions\"", side, direction),
               fmt::format("\"+{0}\", \"-{0}\"", directions.front()));
  return side;
}

std::vector<std::pair<int, int>> read_cut(const Value& value, int n_nodes) {
  const auto items = value.items();
  auto edges = read_edges(value, n_nodes);
  std::set<std::pair<int, int>> seen;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto [a, b] = edges[i];
    if (!seen.insert(std::minmax({a, b})).second)
      items[i].fail(fmt::format("the edge between nodes {} and {} stands twice", a, b), "each edge once");
  }
  return edges;
}

}  // namespace

void read_sections(const Value& root, PlateScene& scene) {
  auto* const mesh = std::get_if<MeshGeometry>(&scene.geometry);
  if (!mesh) return;
  const auto list = root.at("geometry").at("mesh").find("sections");
  if (!list) return;
  std::set<std::pair<int, std::string>> seen;
  for (const auto& item : list->items()) {
    item.only({"hole", "side", "edges"});
    MeshSection section{read_hole(item.at("hole"), scene), read_side(item.at("side"), scene),
                        read_cut(item.at("edges"), count_of(mesh->nodes))};
    if (!seen.insert({section.hole, section.side}).second)
      item.fail(
          fmt::format("a second section of hole \"{}\" on its side {}", scene.holes[section.hole].id, section.side),
          "one on each side of a hole");
    mesh->sections.push_back(std::move(section));
  }
}

}  // namespace fastjoint::stage1
