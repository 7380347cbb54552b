// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/cell_lines.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fastjoint::stage1 {
namespace {

/// The node at `center` that a hole wants on the sides across one axis of its cell.
struct Wish {
  double center, radius;
};

/// One strip of cells; the wish of each cell's hole, nothing in a cell without a hole. A hole whose centre line is the
/// border asks for nothing, but still ends a run of cells that pass nodes on.
struct StripCell {
  bool has_hole = false;
  std::optional<Wish> wish;
};

/// Two centre lines this close (in radii of the smaller hole) share a node: thin sectors cost unknowns for nothing.
constexpr double shared_node_distance = 0.5;

std::vector<double> agreed(const std::optional<Wish>& first, const std::optional<Wish>& second) {
  if (!first && !second) return {};
  if (!first) return {second->center};
  if (!second) return {first->center};
  const auto [low, high] = std::minmax(first->center, second->center);
  if (high - low < shared_node_distance * std::min(first->radius, second->radius)) return {(low + high) / 2};
  return {low, high};
}

/// Nodes on the sides between the cells of a strip: the same on all sides of a run of cells without a hole.
std::vector<std::vector<double>> strip_nodes(const std::vector<StripCell>& strip) {
  const std::size_t n = strip.size();
  std::vector<std::vector<double>> nodes(n + 1);
  for (std::size_t begin = 0; begin <= n;) {
    std::size_t end = begin;  // last side of the run that begins at this side
    while (end < n && !strip[end].has_hole) ++end;
    const auto before = begin > 0 ? strip[begin - 1].wish : std::nullopt;
    const auto after = end < n ? strip[end].wish : std::nullopt;
    std::fill(nodes.begin() + begin, nodes.begin() + end + 1, agreed(before, after));
    begin = end + 1;
  }
  return nodes;
}

}  // namespace

CellLines::CellLines(const PlateScene& scene, const GridGeometry& grid, const std::vector<HoleCell>& holes) {
  const std::size_t n_columns = grid.x.size() - 1;
  const std::size_t n_rows = grid.y.size() - 1;
  std::vector<std::vector<StripCell>> columns(n_columns, std::vector<StripCell>(n_rows));
  std::vector<std::vector<StripCell>> rows(n_rows, std::vector<StripCell>(n_columns));
  for (const auto& cell : holes) {
    const double radius = scene.holes[cell.hole].radius;
    columns[cell.column][cell.row].has_hole = rows[cell.row][cell.column].has_hole = true;
    if (!cell.cuts[left] && !cell.cuts[right]) columns[cell.column][cell.row].wish = Wish{cell.center.x(), radius};
    if (!cell.cuts[bottom] && !cell.cuts[top]) rows[cell.row][cell.column].wish = Wish{cell.center.y(), radius};
  }
  for (const auto& strip : columns) horizontal_.push_back(strip_nodes(strip));
  for (const auto& strip : rows) vertical_.push_back(strip_nodes(strip));
}

const std::vector<double>& CellLines::nodes(int column, int row, CellSide side) const {
  switch (side) {
    case bottom:
      return horizontal_[column][row];
    case top:
      return horizontal_[column][row + 1];
    case left:
      return vertical_[row][column];
    default:
      return vertical_[row][column + 1];
  }
}

}  // namespace fastjoint::stage1
