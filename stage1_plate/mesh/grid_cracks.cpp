// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/grid_cracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/count.hpp"
#include "common/rim/angles.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

class Planner {
 public:
  Planner(const PlateScene& scene, const GridGeometry& grid, const std::vector<HoleCell>& holes)
      : scene_(scene), grid_(grid), holes_(holes), margin_(same * grid.size()) {
    result_.tips.resize(holes.size());
    result_.nodes = {std::vector(grid.y.size() - 1, std::vector<std::vector<CrackNode>>(grid.x.size())),
                     std::vector(grid.x.size() - 1, std::vector<std::vector<CrackNode>>(grid.y.size()))};
  }

  GridCracks run(const std::vector<std::vector<TipPlace>>& tips) {
    for (crack_ = 0; crack_ < count_of(scene_.cracks); ++crack_) plan(scene_.cracks[crack_], tips[crack_]);
    for (int i = 0; i < count_of(holes_); ++i) {
      refine(result_.tips[i]);
      for (const CellTip& tip : result_.tips[i]) add_rays_beside(holes_[i].hole, tip);
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const {
    reject_crack(scene_, crack_, found, allowed);
  }

  void plan(const Crack& crack, const std::vector<TipPlace>& tips) {
    const Point along = (crack.to - crack.from).normalized();
    const bool is_on_axis = along.cwiseAbs().minCoeff() < same;
    if (is_on_axis)
      add_line(crack.from, crack.to, std::abs(along.y()) < std::abs(along.x()) ? 0 : 1);
    else
      check_inside_cell(crack);
    for (const TipPlace& tip : tips) add_tip(tip.at, tip.size);
    if (!is_on_axis) add_ray(*crack.hole, along);
  }

  /// Adds a node to a side of a cell on a cell line across an axis.
  void add_node(int axis, int strip, int line, double at, double step = 0) {
    result_.nodes[axis][strip][line].push_back({at, step});
  }

  /// Index of the hole cell at (column, row); the number of these if it has no hole.
  [[nodiscard]] int hole_cell(int column, int row) const {
    return index_of(holes_, std::array{column, row}, &HoleCell::index);
  }

  /// Index of the interval between lines that holds a coordinate, -1 if it is on a line.
  [[nodiscard]] int interval(const std::vector<double>& lines, double at) const {
    for (int i = 0; i + 1 < count_of(lines); ++i)
      if (at > lines[i] + margin_ && at < lines[i + 1] - margin_) return i;
    return -1;
  }

  /// Mesh lines along a crack parallel to an axis.
  void add_line(const Point& from, const Point& to, int axis) {
    const auto& along = grid_.lines(axis);
    const double low = std::min(from[axis], to[axis]), high = std::max(from[axis], to[axis]), at = from[1 - axis];
    const int strip = interval(grid_.lines(1 - axis), at);
    if (strip < 0) return;  // along a cell line
    for (int i = 0; i + 1 < count_of(along); ++i) {
      if (high <= along[i] + margin_ || low >= along[i + 1] - margin_) continue;
      const int column = axis == 0 ? i : strip, row = axis == 0 ? strip : i;
      if (const int cell = hole_cell(column, row); cell < count_of(holes_)) {
        const HoleCell& hole = holes_[cell];
        const Hole& of = scene_.holes[hole.hole];
        if (std::abs(hole.center[1 - axis] - at) > rim::same_place * of.radius)
          fail(fmt::format("it runs through the cell of hole \"{}\", but not towards its centre", of.id),
               "cracks towards the centre of each hole in whose cell they are; draw cell lines between the two");
        if (low < hole.center[axis] - margin_ && high > hole.center[axis] + margin_)
          fail(fmt::format("it runs through hole \"{}\"", of.id), "one crack on each side of a hole");
        if (low < along[i] - margin_) add_node(axis, strip, i, at);
        if (high > along[i + 1] + margin_) add_node(axis, strip, i + 1, at);
        // A tip inside needs the whole ray, up to the side of the cell.
        if (low > hole.center[axis]) add_node(axis, strip, i + 1, at);
        if (high < hole.center[axis]) add_node(axis, strip, i, at);
      } else {
        add_node(axis, strip, i, at);
        add_node(axis, strip, i + 1, at);
      }
    }
  }

  /// True if a point is inside a cell by more than a margin; a negative margin admits points that far outside too.
  static bool is_in(const Cell& cell, const Point& at, double margin) {
    return ((at - cell.low).array() > margin).all() && ((cell.high - at).array() > margin).all();
  }

  void check_inside_cell(const Crack& crack) const {
    if (!crack.hole)
      fail("a crack that is neither along x nor along y and does not begin at a hole",
           "cracks along x or y, or from a hole inside its cell");
    if (!is_in(*std::ranges::find(holes_, *crack.hole, &HoleCell::hole), crack.to, -margin_))
      fail(fmt::format("it leaves the cell of hole \"{}\"", scene_.holes[*crack.hole].id),
           "cracks that end inside the hole's cell, or along x or y");
  }

  void add_tip(const Point& tip, double size) {
    for (int i = 0; i < count_of(holes_); ++i) {
      const HoleCell& cell = holes_[i];
      if (!is_in(cell, tip, -margin_)) continue;
      const Point ray = tip - cell.center;
      // Wide sectors next to a tip fold: the circle inside bulges beyond the diagonal from the tip.
      result_.tips[i].push_back({std::atan2(ray.y(), ray.x()), ray.norm(), std::min(size, sliver * ray.norm())});
      if (is_in(cell, tip, margin_)) return;
      add_ray(cell.hole, ray);  // on the outline, where a crack along it has no node otherwise
    }
    for (const int axis : {0, 1})
      for (const double sign : {-1.0, 0.0, 1.0})
        for (double offset = sign == 0 ? 0 : size, step = offset; offset <= 20 * size; step *= growth, offset += step) {
          add_tip_line(axis, tip[axis] + sign * offset, tip[1 - axis], sign == 0 ? 0 : step);
          if (sign == 0) break;
        }
  }

  /// Makes elements around tips of a cell as small as the lines of the other tips ask: the gap between them, or the
  /// size at the other tip where these are so near that one line goes through both.
  static void refine(std::vector<CellTip>& tips) {
    for (CellTip& tip : tips)
      for (CellTip& other : tips) {
        const double gap = std::abs(tip.radius - other.radius), least = std::min(tip.size, other.size);
        for (CellTip* each : {&tip, &other}) each->size = std::min(each->size, gap > sliver * least ? gap : least);
      }
  }

  void add_rays_beside(int hole, const CellTip& tip) {
    for (double offset = tip.size / tip.radius, step = offset; offset < 0.7; step *= growth, offset += step)
      for (const double sign : {-1.0, 1.0}) add_ray(hole, unit(tip.angle + sign * offset), step);
  }

  static Point unit(double angle) { return {std::cos(angle), std::sin(angle)}; }

  /// A mesh line across an axis at a coordinate, through the cells without a hole at the tip's place across.
  /// @param step Size of the elements there; within 0.3 of it of a cell line it is left out.
  void add_tip_line(int axis, double at, double across, double step) {
    const auto &lines = grid_.lines(axis), &others = grid_.lines(1 - axis);
    const int strip = interval(lines, at);
    if (strip < 0 || std::min(at - lines[strip], lines[strip + 1] - at) < sliver * step) return;
    for (int i = 0; i + 1 < count_of(others); ++i) {
      if (across < others[i] - margin_ || across > others[i + 1] + margin_) continue;
      const int column = axis == 0 ? strip : i, row = axis == 0 ? i : strip;
      if (hole_cell(column, row) < count_of(holes_)) continue;
      add_node(1 - axis, strip, i, at, step);
      add_node(1 - axis, strip, i + 1, at, step);
    }
  }

  /// A ray from a hole's centre to the outline of its cell.
  /// @param turn Angle to the ray before, 0 for the ray of a tip. Near corners, as seen from there, it is left out.
  void add_ray(int hole, const Point& direction, double turn = 0) {
    const HoleCell& cell = *std::ranges::find(holes_, hole, &HoleCell::hole);
    double reach = std::numeric_limits<double>::infinity();
    int axis = 0;
    for (const int each : {0, 1}) {
      if (direction[each] == 0) continue;
      const double distance =
          ((direction[each] > 0 ? cell.high : cell.low)[each] - cell.center[each]) / direction[each];
      if (distance < reach) reach = distance, axis = each;
    }
    const CellSide side = axis == 0 ? (direction.x() > 0 ? right : left) : (direction.y() > 0 ? top : bottom);
    if (cell.cuts[side]) return;
    const double at = cell.center[1 - axis] + reach * direction[1 - axis];
    const double from_corner = std::min(at - cell.low[1 - axis], cell.high[1 - axis] - at), step = turn * reach;
    if (from_corner < std::max(sliver * step, margin_)) return;
    add_node(axis, cell.index[1 - axis], cell.index[axis] + (direction[axis] > 0 ? 1 : 0), at, step);
  }

  const PlateScene& scene_;
  const GridGeometry& grid_;
  const std::vector<HoleCell>& holes_;
  double margin_;  ///< of places that count as one, length
  int crack_ = 0;
  GridCracks result_;
};

}  // namespace

GridCracks plan_cracks(const PlateScene& scene, const GridGeometry& grid, const std::vector<HoleCell>& holes,
                       const std::vector<std::vector<TipPlace>>& tips) {
  return Planner(scene, grid, holes).run(tips);
}

std::vector<CrackPath> crack_paths(const PlateScene& scene, const PlateMesh& plate) {
  const double size = (plate.mesh.nodes.rowwise().maxCoeff() - plate.mesh.nodes.rowwise().minCoeff()).norm();
  std::vector<CrackPath> paths;
  for (int i = 0; i < count_of(scene.cracks); ++i) {
    const Point &from = scene.cracks[i].from, &to = scene.cracks[i].to;
    const double length = (to - from).norm();
    const Point along = (to - from) / length;
    const auto is_on = [&](int node) {
      const Point way = plate.mesh.nodes.col(node) - from;
      const double ahead = way.dot(along);
      return (way - ahead * along).norm() < 1e-8 * size && ahead > -1e-8 * size && ahead < length + 1e-8 * size;
    };
    CrackPath path{i, fmt::format("/cracks/{}", i), {}};
    for (int edge = 0; edge < plate.edges.size(); ++edge) {
      const int a = plate.edges.nodes(0, edge), b = plate.edges.nodes(1, edge);
      if (plate.edges.arc[edge] < 0 && is_on(a) && is_on(b)) path.edges.emplace_back(a, b);
    }
    double covered = 0;
    for (const auto& [a, b] : path.edges) covered += (plate.mesh.nodes.col(b) - plate.mesh.nodes.col(a)).norm();
    if (std::abs(covered - length) > 1e-6 * length)
      reject_crack(scene, i, fmt::format("edges of elements lie along {:.6g} of its length {:.6g}", covered, length),
                   "cracks along cell lines, through cells without holes, or towards the centre of a hole in its cell");
    paths.push_back(std::move(path));
  }
  return paths;
}

}  // namespace fastjoint::stage1
