// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/hole_cells.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

/// The interval between cell lines of one axis in which a centre lies.
struct Interval {
  int index;
  double center;
  bool at_low_border, at_high_border;
};

class Locator {
 public:
  Locator(const PlateScene& scene, std::size_t hole)
      : scene_(scene), hole_(scene.holes[hole]), pointer_(fmt::format("/holes/{}", hole)) {}

  Interval locate(const std::vector<double>& lines, int axis) const {
    const double c = hole_.center[axis];
    const double same = 1e-9 * (lines.back() - lines.front());
    const int last = count_of(lines) - 2;
    if (std::abs(c - lines.front()) < same) return check({0, lines.front(), true, false}, lines, axis);
    if (std::abs(c - lines.back()) < same) return check({last, lines.back(), false, true}, lines, axis);
    for (int i = 0; i <= last; ++i)
      if (c > lines[i] && c < lines[i + 1]) return check({i, c, false, false}, lines, axis);
    if (c < lines.front() || c > lines.back()) outside();
    over_line(axis, c);
  }

 private:
  Interval check(const Interval& at, const std::vector<double>& lines, int axis) const {
    if (!at.at_low_border && at.center - hole_.radius <= lines[at.index]) touches(at.index == 0, axis, lines[at.index]);
    if (!at.at_high_border && at.center + hole_.radius >= lines[at.index + 1])
      touches(at.index + 2 == count_of(lines), axis, lines[at.index + 1]);
    return at;
  }

  std::string circle() const {
    return fmt::format("hole \"{}\" of radius {:g} about ({:g}, {:g})", hole_.id, hole_.radius, hole_.center.x(),
                       hole_.center.y());
  }
  [[noreturn]] void touches(bool is_border, int axis, double line) const {
    if (is_border) outside();
    over_line(axis, line);
  }
  [[noreturn]] void outside() const {
    reject(scene_, pointer_, circle() + " reaches outside the plate",
           "a hole inside a cell, or centred on the plate's border (half) or corner (quarter)");
  }
  [[noreturn]] void over_line(int axis, double line) const {
    reject(scene_, pointer_,
           fmt::format("{} reaches over the cell line {} = {:g}", circle(), axis == 0 ? "x" : "y", line),
           "a hole inside one cell; move the cell line");
  }

  const PlateScene& scene_;
  const Hole& hole_;
  std::string pointer_;
};

}  // namespace

std::vector<HoleCell> find_hole_cells(const PlateScene& scene, const GridGeometry& grid) {
  std::vector<HoleCell> cells;
  for (int i = 0; i < count_of(scene.holes); ++i) {
    const Locator locator(scene, i);
    const Interval x = locator.locate(grid.x, 0);
    const Interval y = locator.locate(grid.y, 1);
    for (const auto& other : cells)
      if (other.column == x.index && other.row == y.index)
        reject(scene, fmt::format("/holes/{}", i),
               fmt::format("holes \"{}\" and \"{}\" are in one cell", scene.holes[other.hole].id, scene.holes[i].id),
               "one hole in a cell; draw a cell line between them");
    cells.push_back({i,
                     x.index,
                     y.index,
                     {x.center, y.center},
                     {y.at_low_border, x.at_high_border, y.at_high_border, x.at_low_border}});
  }
  return cells;
}

}  // namespace fastjoint::stage1
