// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/grid_cracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

std::string text(const Point& at) { return fmt::format("({:g}, {:g})", at.x(), at.y()); }

void check_inside(const PlateScene& scene, const GridGeometry& grid, int at) {
  const double margin = same * grid.size();
  for (const Point& end : {scene.cracks[at].from, scene.cracks[at].to})
    for (const int axis : {0, 1})
      if (end[axis] < grid.lines(axis).front() - margin || end[axis] > grid.lines(axis).back() + margin)
        reject_crack(scene, at, fmt::format("it ends at {}, outside the plate", text(end)), "cracks inside the plate");
}

double distance(const Point& at, const Crack& crack) {
  const Point along = crack.to - crack.from;
  const double fraction = std::clamp((at - crack.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (at - crack.from - fraction * along).norm();
}

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Refuses cracks that cross, and cracks along the same line that overlap.
void check_apart(const PlateScene& scene, int at, int other) {
  const Crack &a = scene.cracks[at], &b = scene.cracks[other];
  const Point u = a.to - a.from, v = b.to - b.from, between = b.from - a.from;
  const double area = cross(u, v), scale = u.norm() * v.norm();
  const auto refuse = [&](const char* what, const Point& place) {
    reject_crack(scene, at, fmt::format("it {} crack {} at {}", what, other + 1, text(place)),
                 "cracks apart from each other");
  };
  if (std::abs(area) > same * scale) {
    const double s = cross(between, v) / area, t = cross(between, u) / area;  // of the way along each
    if (s > -same && s < 1 + same && t > -same && t < 1 + same) refuse("meets", a.from + s * u);
  } else if (std::abs(cross(between, u)) < same * scale) {
    const double from = between.dot(u) / u.squaredNorm(), to = (b.to - a.from).dot(u) / u.squaredNorm();
    const double low = std::max(std::min(from, to), 0.0), high = std::min(std::max(from, to), 1.0);
    if (low < high + same) refuse("overlaps", a.from + low * u);
  }
}

double element_size(const PlateScene& scene, const GridGeometry& grid, int at, const Point& tip) {
  constexpr double least = 1e-6;  // of the plate's size
  const double plate = grid.size();
  const Crack& own = scene.cracks[at];
  double size = (own.to - own.from).norm() / (own.tips == 2 ? 2 : 1);
  std::string what = "its other end";
  const auto consider = [&](double other, const std::string& name) {
    if (other < size) size = other, what = name;
  };
  for (const Hole& hole : scene.holes) {
    const double from_rim = (tip - hole.center).norm() - hole.radius;
    if (from_rim < same * plate)
      reject_crack(scene, at, fmt::format("its tip at {} is in hole \"{}\"", text(tip), hole.id),
                   "tips inside the sheet; a crack up to another hole: \"to\": \"hole:ID\"");
    consider(from_rim, fmt::format("hole \"{}\"", hole.id));
  }
  consider(
      std::min({tip.x() - grid.x.front(), grid.x.back() - tip.x(), tip.y() - grid.y.front(), grid.y.back() - tip.y()}),
      "the border");
  for (int i = 0; i < count_of(scene.cracks); ++i)
    if (i != at) consider(distance(tip, scene.cracks[i]), fmt::format("crack {}", i + 1));
  if (size < least * plate)
    reject_crack(scene, at, fmt::format("its tip at {} is {:.2g} from {}", text(tip), size, what),
                 fmt::format("{:.2g} at least, {:g} of the plate's diagonal", least * plate, least));
  return size;
}

/// The new place of a cell line.
struct Move {
  double to;
  int crack;  ///< for messages
  Point tip;
};

class Lines {
 public:
  Lines(const PlateScene& scene, const GridGeometry& grid, const std::vector<std::vector<TipPlace>>& tips)
      : scene_(scene),
        tips_(tips),
        size_(grid.size()),
        result_{grid},
        moves_{std::vector<std::optional<Move>>(grid.x.size()), std::vector<std::optional<Move>>(grid.y.size())} {}

  MovedGrid run() {
    for (int crack = 0; crack < count_of(tips_); ++crack)
      for (const TipPlace& tip : tips_[crack])
        for (const int axis : {0, 1})
          for (int i = 0; i < count_of(lines(axis)); ++i)
            if (std::abs(tip.at[axis] - lines(axis)[i]) < near * tip.size) ask(axis, i, {tip.at[axis], crack, tip.at});
    const auto holes = find_hole_cells(scene_, result_.grid);
    for (int crack = 0; crack < count_of(tips_); ++crack) put_corner_on_ray(crack, holes);
    for (const int axis : {0, 1})
      for (int i = 0; i < count_of(lines(axis)); ++i)
        if (moves_[axis][i]) move(axis, i, *moves_[axis][i]);
    return std::move(result_);
  }

 private:
  /// Share of the size of its elements within which a tip is too near to a line.
  static constexpr double near = 0.35;

  [[nodiscard]] const std::vector<double>& lines(int axis) const { return result_.grid.lines(axis); }

  void ask(int axis, int line, const Move& move) {
    auto& known = moves_[axis][line];
    if (known && std::abs(known->to - move.to) > same * size_)
      reject_crack(
          scene_, move.crack,
          fmt::format("its tip at {} and that of crack {} at {} are both near to the cell line {} = {:g}",
                      text(move.tip), known->crack + 1, text(known->tip), axis == 0 ? "x" : "y", lines(axis)[line]),
          "a cell line through each tip instead");
    known = move;
  }

  /// Moves a side of a hole's cell so that its corner is on the ray of a slanted crack that passes it closely.
  void put_corner_on_ray(int crack, const std::vector<HoleCell>& holes) {
    const auto& hole = scene_.cracks[crack].hole;
    const auto cell = hole ? std::ranges::find(holes, *hole, &HoleCell::hole) : holes.end();
    if (cell == holes.end() || tips_[crack].empty()) return;
    const TipPlace& tip = tips_[crack].front();
    const Point ray = tip.at - cell->center;
    for (const int right : {0, 1})
      for (const int above : {0, 1}) {
        const int column = cell->index[0] + right, row = cell->index[1] + above;
        const Point corner = Point(result_.grid.x[column], result_.grid.y[row]) - cell->center;
        const double off = std::abs(corner.x() * ray.y() - corner.y() * ray.x()) / corner.norm();
        if (corner.dot(ray) < 0 || off > near * tip.size || moves_[0][column] || moves_[1][row]) continue;
        const bool along_x =
            std::abs(corner.x() * ray.y()) < std::abs(corner.y() * ray.x());  // the corner moves inwards
        const bool x_is_border = column == 0 || column + 1 == count_of(lines(0));
        const bool y_is_border = row == 0 || row + 1 == count_of(lines(1));
        if (x_is_border && y_is_border) continue;
        if (y_is_border || (along_x && !x_is_border))
          ask(0, column, {cell->center.x() + corner.y() * ray.x() / ray.y(), crack, tip.at});
        else
          ask(1, row, {cell->center.y() + corner.x() * ray.y() / ray.x(), crack, tip.at});
      }
  }

  void move(int axis, int line, const Move& move) {
    const double from = lines(axis)[line];
    if (std::abs(move.to - from) < same * size_) return;
    const auto refuse = [&](const std::string& why) {
      reject_crack(scene_, move.crack,
                   fmt::format("its tip at {} is near to the cell line {} = {:g}, which cannot be moved through it: {}",
                               text(move.tip), axis == 0 ? "x" : "y", from, why),
                   "a cell line through the tip, or another length");
    };
    auto& grid = result_.grid;
    const auto changes = [&](const auto& values) {
      return axis == 0 ? values.col(line - 1) != values.col(line) : values.row(line - 1) != values.row(line);
    };
    if (changes(grid.thickness) || changes(grid.material)) refuse("the thickness or the material changes there");
    const double low = std::min(from, move.to), high = std::max(from, move.to);
    for (const Hole& hole : scene_.holes)
      if (hole.center[axis] + hole.radius > low && hole.center[axis] - hole.radius < high)
        refuse(fmt::format("hole \"{}\" is in its way", hole.id));
    (axis == 0 ? grid.x : grid.y)[line] = move.to;
    result_.moves.push_back(
        fmt::format("{} = {:g} to {:g}, for the tip at {}", axis == 0 ? "x" : "y", from, move.to, text(move.tip)));
  }

  const PlateScene& scene_;
  const std::vector<std::vector<TipPlace>>& tips_;
  double size_;
  MovedGrid result_;
  std::array<std::vector<std::optional<Move>>, 2> moves_;  ///< of each line of both axes
};

}  // namespace

void reject_crack(const PlateScene& scene, int crack, const std::string& found, const std::string& allowed) {
  reject(scene, fmt::format("/cracks/{}", crack), found, allowed);
}

std::vector<std::vector<TipPlace>> place_tips(const PlateScene& scene, const GridGeometry& grid) {
  const int n = count_of(scene.cracks);
  for (int i = 0; i < n; ++i) check_inside(scene, grid, i);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < i; ++k) check_apart(scene, i, k);
  std::vector<std::vector<TipPlace>> tips(n);
  for (int i = 0; i < n; ++i) {
    const auto add = [&](const Point& tip) { tips[i].push_back({tip, element_size(scene, grid, i, tip)}); };
    if (scene.cracks[i].tips == 2) add(scene.cracks[i].from);
    if (scene.cracks[i].tips > 0) add(scene.cracks[i].to);
  }
  return tips;
}

MovedGrid lines_through_tips(const PlateScene& scene, const GridGeometry& grid,
                             const std::vector<std::vector<TipPlace>>& tips) {
  return Lines(scene, grid, tips).run();
}

}  // namespace fastjoint::stage1
