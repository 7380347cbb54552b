// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/grid_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/count.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stage1 {
namespace {

/// The interval between cell lines of one axis that contains a centre.
struct Interval {
  int index;
  double center;
  bool at_low_border, at_high_border;
};

[[noreturn]] void reject_hole(const PlateScene& scene, int index, const std::string& reaches,
                              const std::string& allowed) {
  const Hole& hole = scene.holes[index];
  reject(scene, fmt::format("/holes/{}", index),
         fmt::format("hole \"{}\" of radius {:g} about ({:g}, {:g}) reaches {}", hole.id, hole.radius, hole.center.x(),
                     hole.center.y(), reaches),
         allowed);
}

Interval locate(const PlateScene& scene, int index, const std::vector<double>& lines, rim::Axis axis) {
  const Hole& hole = scene.holes[index];
  const double c = hole.center[rim::coordinate(axis)];
  const double low = lines.front(), high = lines.back(), same = 1e-9 * (high - low);
  const bool at_low = std::abs(c - low) < same, at_high = std::abs(c - high) < same;
  const double center = at_low ? low : at_high ? high : c;
  const auto reaches = [&](double line) {
    if (line <= low || line >= high)
      reject_hole(scene, index, "outside the plate",
                  "a hole inside a cell, or centred on the plate's border (half) or corner (quarter)");
    reject_hole(scene, index, fmt::format("over the cell line {} = {:g}", rim::name_of(axis), line),
                "a hole inside one cell; move the cell line");
  };
  if (center < low || center > high) reaches(center);
  const auto above = at_high ? lines.end() - 1 : std::upper_bound(lines.begin(), lines.end(), center);
  if (!at_low && center - hole.radius <= above[-1]) reaches(above[-1]);
  if (!at_high && center + hole.radius >= *above) reaches(*above);
  return {static_cast<int>(above - lines.begin()) - 1, center, at_low, at_high};
}

/// The nodes that a hole needs on the two sides of its cell across one axis.
struct NeededNodes {
  std::vector<double> low, high;
  double radius;
};

/// Nodes needed on a side at a distance from the centre: one opposite the centre, if the hole is not cut there, and one
/// at half the angle to each corner that is seen from the centre at more than `max_angle` from that line.
/// @param from, to Ends of the side.
std::vector<double> needed_nodes(double distance, double center, double from, double to, bool with_center) {
  constexpr double max_angle = 60 * rim::degree;
  std::vector<double> nodes;
  if (with_center) nodes.push_back(center);
  for (const double corner : {from, to}) {
    const double angle = std::atan2(std::abs(corner - center), distance);
    if (distance > 0 && angle > max_angle)
      nodes.push_back(center + std::copysign(distance * std::tan(angle / 2), corner - center));
  }
  std::ranges::sort(nodes);
  return nodes;
}

/// Nodes closer than this, in radii of the smaller hole, are merged, since thin sectors add unknowns without benefit.
constexpr double shared_node_distance = 0.5;

/// Merged nodes of a run of sides between the hole before and the hole after it.
std::vector<double> merged(const std::optional<NeededNodes>& before, const std::optional<NeededNodes>& after,
                           const std::vector<double>& fixed) {
  std::vector<double> nodes = before ? before->high : std::vector<double>();
  if (after) nodes.insert(nodes.end(), after->low.begin(), after->low.end());
  const double smaller = std::min(before ? before->radius : HUGE_VAL, after ? after->radius : HUGE_VAL);
  const double same = shared_node_distance * smaller;
  std::erase_if(nodes, [&](double node) {
    return std::ranges::any_of(fixed, [&](double each) { return std::abs(each - node) < same; });
  });
  std::ranges::sort(nodes);
  if (!before || !after) return nodes;
  for (std::size_t i = 0; i + 1 < nodes.size();)
    if (nodes[i + 1] - nodes[i] < same) {
      nodes[i] = (nodes[i] + nodes[i + 1]) / 2;
      nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    } else {
      ++i;
    }
  return nodes;
}

/// The nodes that cracks need on several sides, ascending; of those too close to each other the finer ones.
std::vector<double> all_of(const std::vector<std::vector<CrackNode>>& of_cracks, int first, int last) {
  std::vector<CrackNode> wanted;
  for (int side = first; side <= last; ++side)
    wanted.insert(wanted.end(), of_cracks[side].begin(), of_cracks[side].end());
  std::ranges::stable_sort(wanted, {}, &CrackNode::step);
  double size = 0;
  for (const CrackNode& node : wanted) size = std::max(size, std::abs(node.at));
  std::vector<double> nodes;
  for (const CrackNode& node : wanted) {
    const double clear = std::max(sliver * node.step, 1e-9 * size);
    if (std::ranges::none_of(nodes, [&](double other) { return std::abs(other - node.at) <= clear; }))
      nodes.push_back(node.at);
  }
  std::ranges::sort(nodes);
  return nodes;
}

/// Nodes on the sides between the cells of a strip: the same on all sides of a run of cells without a hole.
/// @param strip What the hole of each cell needs, empty without a hole.
std::vector<std::vector<double>> strip_nodes(const std::vector<std::optional<NeededNodes>>& strip,
                                             const std::vector<std::vector<CrackNode>>& of_cracks) {
  const int n = count_of(strip);
  std::vector<std::vector<double>> nodes(n + 1);
  for (int begin = 0; begin <= n;) {
    int end = begin;  // last side of the run that begins at this side
    while (end < n && !strip[end]) ++end;
    const auto before = begin > 0 ? strip[begin - 1] : std::nullopt;
    const auto after = end < n ? strip[end] : std::nullopt;
    const auto fixed = all_of(of_cracks, begin, end);
    auto all = merged(before, after, fixed);
    all.insert(all.end(), fixed.begin(), fixed.end());
    std::ranges::sort(all);
    std::fill(nodes.begin() + begin, nodes.begin() + end + 1, all);
    begin = end + 1;
  }
  return nodes;
}

}  // namespace

Cell cell_at(const GridGeometry& grid, int column, int row) {
  return {{column, row}, {grid.x[column], grid.y[row]}, {grid.x[column + 1], grid.y[row + 1]}};
}

std::vector<HoleCell> find_hole_cells(const PlateScene& scene, const GridGeometry& grid) {
  std::vector<HoleCell> cells;
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const Interval x = locate(scene, i, grid.x, rim::Axis::x);
    const Interval y = locate(scene, i, grid.y, rim::Axis::y);
    const Cell cell = cell_at(grid, x.index, y.index);
    for (const auto& other : cells)
      if (other.index == cell.index)
        reject(scene, fmt::format("/holes/{}", i),
               fmt::format("holes \"{}\" and \"{}\" are in one cell", scene.holes[other.hole].id, scene.holes[i].id),
               "one hole in a cell; draw a cell line between them");
    cells.push_back(
        {cell, i, {x.center, y.center}, {y.at_low_border, x.at_high_border, y.at_high_border, x.at_low_border}});
  }
  return cells;
}

const std::vector<double>& SideNodes::of(const Cell& cell, CellSide side) const {
  const int axis = side == left || side == right ? 0 : 1, line = side == right || side == top ? 1 : 0;
  return on[axis][cell.index[1 - axis]][cell.index[axis] + line];
}

SideNodes place_nodes(const PlateScene& scene, const GridGeometry& grid, const std::vector<HoleCell>& holes,
                      const OfSides<std::vector<CrackNode>>& of_cracks) {
  SideNodes nodes;
  for (const int axis : {0, 1}) {  // sides across it; its strips run along it
    const int n_strips = count_of(of_cracks[axis]), along = 1 - axis;
    std::vector strips(n_strips, std::vector<std::optional<NeededNodes>>(grid.lines(axis).size() - 1));
    for (const auto& cell : holes) {
      const auto& cuts = cell.cuts;
      const bool with_center = axis == 0 ? !cuts[bottom] && !cuts[top] : !cuts[left] && !cuts[right];
      const auto needed = [&](double distance) {
        return needed_nodes(distance, cell.center[along], cell.low[along], cell.high[along], with_center);
      };
      strips[cell.index[along]][cell.index[axis]] =
          NeededNodes{needed(cell.center[axis] - cell.low[axis]), needed(cell.high[axis] - cell.center[axis]),
                      scene.holes[cell.hole].radius};
    }
    for (int i = 0; i < n_strips; ++i) nodes.on[axis].push_back(strip_nodes(strips[i], of_cracks[axis][i]));
  }
  return nodes;
}

}  // namespace fastjoint::stage1
