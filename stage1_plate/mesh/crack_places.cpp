// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/crack_places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/count.hpp"
#include "stage1_plate/mesh/grid_cells.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

double size_of(const GridGeometry& grid) {
  return std::hypot(grid.x.back() - grid.x.front(), grid.y.back() - grid.y.front());
}

[[noreturn]] void fail(const PlateScene& scene, int crack, const std::string& found, const std::string& allowed) {
  reject(scene, fmt::format("/cracks/{}", crack), found, allowed);
}

std::string text(const Point& at) { return fmt::format("({:g}, {:g})", at.x(), at.y()); }

CrackPlace ends_of(const PlateScene& scene, const GridGeometry& grid, int at) {
  const Crack& crack = scene.cracks[at];
  Point from = crack.from, to = crack.to;
  if (crack.hole) from = scene.holes[*crack.hole].center + scene.holes[*crack.hole].radius * crack.direction();
  if (!crack.border.empty()) {
    const bool is_vertical = crack.border == "left" || crack.border == "right";
    const bool is_low = crack.border == "left" || crack.border == "bottom";
    const auto& lines = is_vertical ? grid.x : grid.y;
    from[is_vertical ? 0 : 1] = is_low ? lines.front() : lines.back();
    from[is_vertical ? 1 : 0] = crack.at;
  }
  if (crack.to_hole) {
    const Hole& hole = scene.holes[*crack.to_hole];
    const Point toward = hole.center - from;
    to = hole.center - hole.radius * toward.normalized();
  } else if (crack.length > 0) {
    to = from + crack.length * crack.direction();
  }
  const double margin = same * size_of(grid);
  for (const Point& end : {from, to})
    if (end.x() < grid.x.front() - margin || end.x() > grid.x.back() + margin || end.y() < grid.y.front() - margin ||
        end.y() > grid.y.back() + margin)
      fail(scene, at, fmt::format("it ends at {}, outside the plate", text(end)), "cracks inside the plate");
  return {from, to, {}};
}

double distance(const Point& at, const CrackPlace& crack) {
  const Point along = crack.to - crack.from;
  const double fraction = std::clamp((at - crack.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (at - crack.from - fraction * along).norm();
}

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Refuses cracks that cross, and cracks along the same line that overlap.
void check_apart(const PlateScene& scene, const std::vector<CrackPlace>& cracks, int at, int other) {
  const CrackPlace &a = cracks[at], &b = cracks[other];
  const Point u = a.to - a.from, v = b.to - b.from, between = b.from - a.from;
  const double area = cross(u, v), scale = u.norm() * v.norm();
  const auto refuse = [&](const char* what, const Point& place) {
    fail(scene, at, fmt::format("it {} crack {} at {}", what, other + 1, text(place)), "cracks apart from each other");
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

double element_size(const PlateScene& scene, const GridGeometry& grid, const std::vector<CrackPlace>& cracks, int at,
                    const Point& tip) {
  constexpr double least = 1e-6;  // of the plate's size
  const double plate = size_of(grid);
  const CrackPlace& own = cracks[at];
  double size = (own.to - own.from).norm() / (scene.cracks[at].tips == 2 ? 2 : 1);
  std::string what = "its other end";
  const auto consider = [&](double other, const std::string& name) {
    if (other < size) size = other, what = name;
  };
  for (const Hole& hole : scene.holes) {
    const double from_rim = (tip - hole.center).norm() - hole.radius;
    if (from_rim < same * plate)
      fail(scene, at, fmt::format("its tip at {} is in hole \"{}\"", text(tip), hole.id),
           "tips inside the sheet; a crack up to another hole: \"to\": \"hole:ID\"");
    consider(from_rim, fmt::format("hole \"{}\"", hole.id));
  }
  consider(
      std::min({tip.x() - grid.x.front(), grid.x.back() - tip.x(), tip.y() - grid.y.front(), grid.y.back() - tip.y()}),
      "the border");
  for (int i = 0; i < count_of(cracks); ++i)
    if (i != at) consider(distance(tip, cracks[i]), fmt::format("crack {}", i + 1));
  if (size < least * plate)
    fail(scene, at, fmt::format("its tip at {} is {:.2g} from {}", text(tip), size, what),
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
  Lines(const PlateScene& scene, const GridGeometry& grid, const std::vector<CrackPlace>& cracks)
      : scene_(scene),
        cracks_(cracks),
        size_(size_of(grid)),
        result_{grid},
        moves_{std::vector<std::optional<Move>>(grid.x.size()), std::vector<std::optional<Move>>(grid.y.size())} {}

  MovedGrid run() {
    for (int crack = 0; crack < count_of(cracks_); ++crack)
      for (const TipPlace& tip : cracks_[crack].tips)
        for (const int axis : {0, 1})
          for (int i = 0; i < count_of(lines(axis)); ++i)
            if (std::abs(tip.at[axis] - lines(axis)[i]) < near * tip.size) ask(axis, i, {tip.at[axis], crack, tip.at});
    const auto holes = find_hole_cells(scene_, result_.grid);
    for (int crack = 0; crack < count_of(cracks_); ++crack) put_corner_on_ray(crack, holes);
    for (const int axis : {0, 1})
      for (int i = 0; i < count_of(lines(axis)); ++i)
        if (moves_[axis][i]) move(axis, i, *moves_[axis][i]);
    return std::move(result_);
  }

 private:
  /// Share of the size of its elements within which a tip is too near to a line.
  static constexpr double near = 0.35;

  [[nodiscard]] const std::vector<double>& lines(int axis) const { return axis == 0 ? result_.grid.x : result_.grid.y; }

  void ask(int axis, int line, const Move& move) {
    auto& known = moves_[axis][line];
    if (known && std::abs(known->to - move.to) > same * size_)
      fail(scene_, move.crack,
           fmt::format("its tip at {} and that of crack {} at {} are both near to the cell line {} = {:g}",
                       text(move.tip), known->crack + 1, text(known->tip), axis == 0 ? "x" : "y", lines(axis)[line]),
           "a cell line through each tip instead");
    known = move;
  }

  /// Moves a side of a hole's cell so that its corner is on the ray of a slanted crack that passes it closely.
  void put_corner_on_ray(int crack, const std::vector<HoleCell>& holes) {
    const auto& hole = scene_.cracks[crack].hole;
    const auto cell = hole ? std::ranges::find(holes, *hole, &HoleCell::hole) : holes.end();
    if (cell == holes.end() || cracks_[crack].tips.empty()) return;
    const TipPlace& tip = cracks_[crack].tips.front();
    const Point ray = tip.at - cell->center;
    for (const int right : {0, 1})
      for (const int above : {0, 1}) {
        const int column = cell->column + right, row = cell->row + above;
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
      fail(scene_, move.crack,
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
  const std::vector<CrackPlace>& cracks_;
  double size_;
  MovedGrid result_;
  std::array<std::vector<std::optional<Move>>, 2> moves_;  ///< of each line of both axes
};

}  // namespace

std::vector<CrackPlace> place_cracks(const PlateScene& scene, const GridGeometry& grid) {
  std::vector<CrackPlace> cracks;
  for (int i = 0; i < count_of(scene.cracks); ++i) cracks.push_back(ends_of(scene, grid, i));
  for (int i = 0; i < count_of(cracks); ++i)
    for (int k = 0; k < i; ++k) check_apart(scene, cracks, i, k);
  for (int i = 0; i < count_of(cracks); ++i) {
    const int n = scene.cracks[i].tips;
    for (const Point& tip : n == 2 ? std::vector{cracks[i].from, cracks[i].to} : std::vector{cracks[i].to})
      if (n > 0) cracks[i].tips.push_back({tip, element_size(scene, grid, cracks, i, tip)});
  }
  return cracks;
}

MovedGrid lines_through_tips(const PlateScene& scene, const GridGeometry& grid, const std::vector<CrackPlace>& cracks) {
  return Lines(scene, grid, cracks).run();
}

}  // namespace fastjoint::stage1
