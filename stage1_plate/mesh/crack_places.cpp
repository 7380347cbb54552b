// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/grid_cracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

/// Least size of the elements around a tip, of the plate's size.
constexpr double least_size = 1e-6;

std::string text(const Point& at) { return fmt::format("({:g}, {:g})", at.x(), at.y()); }

void check_inside(const PlateScene& scene, const GridGeometry& grid, int at) {
  const double margin = same * grid.size();
  for (const Point& end : {scene.cracks[at].from, scene.cracks[at].to})
    for (const int axis : {0, 1})
      if (end[axis] < grid.lines(axis).front() - margin || end[axis] > grid.lines(axis).back() + margin)
        reject_crack(scene, at, fmt::format("it ends at {}, outside the plate", text(end)), "cracks inside the plate");
}

/// Size that the elements around a tip may have beside another crack: the distance, half of it to a tip, whose elements
/// need the other half.
double room_beside(const Point& tip, const Crack& crack) {
  const Point along = crack.to - crack.from;
  const double fraction = std::clamp((tip - crack.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  const bool is_tip = (fraction == 1 && crack.tips > 0) || (fraction == 0 && crack.tips == 2);
  return (tip - crack.from - fraction * along).norm() / (is_tip ? 2 : 1);
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
    if (i != at) consider(room_beside(tip, scene.cracks[i]), fmt::format("crack {}", i + 1));
  if (size < least_size * plate)
    reject_crack(scene, at, fmt::format("its tip at {} is {:.2g} from {}", text(tip), size, what),
                 fmt::format("{:.2g} at least, {:g} of the plate's diagonal", least_size * plate, least_size));
  return size;
}

/// Moves cell lines for tips, one after the other. Elements around a tip are made smaller where a line near it stays.
class Lines {
 public:
  Lines(const PlateScene& scene, const GridGeometry& grid, std::vector<std::vector<TipPlace>>& tips)
      : scene_(scene),
        tips_(tips),
        size_(grid.size()),
        result_{grid},
        is_fixed_{std::vector<bool>(grid.x.size()), std::vector<bool>(grid.y.size())} {}

  MovedGrid run() {
    for (auto& of_crack : tips_)
      for (TipPlace& tip : of_crack)
        for (const int axis : {0, 1})
          for (int i = 0; i < count_of(lines(axis)); ++i)
            if (const double off = std::abs(tip.at[axis] - lines(axis)[i]); off < near * tip.size)
              move_or_refine(axis, i, tip.at[axis], off, tip);
    const auto holes = find_hole_cells(scene_, result_.grid);
    for (int crack = 0; crack < count_of(tips_); ++crack) put_corner_on_ray(crack, holes);
    for (int crack = 0; crack < count_of(tips_); ++crack)
      for (const TipPlace& tip : tips_[crack])
        if (tip.size < least_size * size_)
          reject_crack(scene_, crack,
                       fmt::format("its tip at {} is {:.2g} from a cell line that cannot be moved through it",
                                   text(tip.at), near * tip.size),
                       "a cell line through the tip, or another length");
    return std::move(result_);
  }

 private:
  /// Share of the size of its elements within which a tip is too near to a line.
  static constexpr double near = 0.35;

  [[nodiscard]] const std::vector<double>& lines(int axis) const { return result_.grid.lines(axis); }

  /// Moves a line, or makes the elements around the tip so small that it is not too near to them.
  /// @param off Distance from the tip to what the line passes there.
  void move_or_refine(int axis, int line, double to, double off, TipPlace& tip) {
    if (off < same * size_)
      is_fixed_[axis][line] = true;
    else if (can_move(axis, line, to))
      move(axis, line, to, tip.at);
    else
      tip.size = off / near;
  }

  /// Moves a side of a hole's cell so that its corner is on the ray of a slanted crack that passes it closely.
  void put_corner_on_ray(int crack, const std::vector<HoleCell>& holes) {
    const auto& hole = scene_.cracks[crack].hole;
    const auto cell = hole ? std::ranges::find(holes, *hole, &HoleCell::hole) : holes.end();
    if (cell == holes.end() || tips_[crack].empty()) return;
    TipPlace& tip = tips_[crack].front();
    const Point ray = tip.at - cell->center;
    for (const int right : {0, 1})
      for (const int above : {0, 1}) {
        const int column = cell->index[0] + right, row = cell->index[1] + above;
        const Point corner = Point(lines(0)[column], lines(1)[row]) - cell->center;
        const double off = std::abs(cross(corner, ray)) / corner.norm();
        if (corner.dot(ray) < 0 || off > near * tip.size) continue;
        const double x = cell->center.x() + corner.y() * ray.x() / ray.y();
        const double y = cell->center.y() + corner.x() * ray.y() / ray.x();
        const bool is_flat = std::abs(corner.x() * ray.y()) < std::abs(corner.y() * ray.x());
        // The corner moves inwards if it may.
        if (can_move(0, column, x) && (is_flat || !can_move(1, row, y)))
          move_or_refine(0, column, x, off, tip);
        else
          move_or_refine(1, row, y, off, tip);
      }
  }

  /// True if a line is free to move: no border, no step of the sheet, not near another line, and no hole in its way.
  [[nodiscard]] bool can_move(int axis, int line, double to) const {
    const auto& at = lines(axis);
    if (is_fixed_[axis][line] || line == 0 || line + 1 == count_of(at)) return false;
    const auto changes = [&](const auto& values) {
      return axis == 0 ? values.col(line - 1) != values.col(line) : values.row(line - 1) != values.row(line);
    };
    if (changes(result_.grid.thickness) || changes(result_.grid.material)) return false;
    const double least_gap = std::abs(to - at[line]);  // else two lines could end at one place
    if (to - at[line - 1] < least_gap || at[line + 1] - to < least_gap) return false;
    const double low = std::min(at[line], to), high = std::max(at[line], to);
    return std::ranges::none_of(scene_.holes, [&](const Hole& hole) {
      return hole.center[axis] + hole.radius > low && hole.center[axis] - hole.radius < high;
    });
  }

  void move(int axis, int line, double to, const Point& tip) {
    double& at = (axis == 0 ? result_.grid.x : result_.grid.y)[line];
    result_.moves.push_back(
        fmt::format("{} = {:g} to {:g}, for the tip at {}", axis == 0 ? "x" : "y", at, to, text(tip)));
    at = to;
    is_fixed_[axis][line] = true;
  }

  const PlateScene& scene_;
  std::vector<std::vector<TipPlace>>& tips_;
  double size_;
  MovedGrid result_;
  std::array<std::vector<bool>, 2> is_fixed_;  ///< lines of both axes that have been moved or must stay
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
                             std::vector<std::vector<TipPlace>>& tips) {
  return Lines(scene, grid, tips).run();
}

}  // namespace fastjoint::stage1
