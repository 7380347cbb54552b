// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "common/pfem/element.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

using Piece = pfem::OutlinePiece;
using Sides = std::set<pfem::Side>;

Sides sides_with(const std::map<std::string, std::vector<pfem::Side>>& sets, const std::set<std::string>& names) {
  Sides sides;
  for (const auto& name : names)
    if (const auto found = sets.find(name); found != sets.end())
      sides.insert(found->second.begin(), found->second.end());
  return sides;
}

/// Ends of the chords of a side.
std::vector<Point> points_of(const PlateMesh& plate, const pfem::Side& side) {
  constexpr int chords = 8;
  const auto [element, local_edge] = side;
  const bool is_arc = plate.edges.arc[plate.edges.of(side)] >= 0;
  const pfem::ElementMap map(plate.mesh, plate.edges, element);
  std::vector<Point> points;
  for (int i = 0; i <= (is_arc ? chords : 1); ++i) {
    const double s = is_arc ? -1 + 2.0 * i / chords : -1 + 2.0 * i;
    constexpr double xi[] = {0, 1, 0, -1}, eta[] = {-1, 0, 1, 0};  // of local edges 0 to 3: bottom, right, top, left
    points.push_back(local_edge % 2 == 0 ? map.point(s, eta[local_edge]) : map.point(xi[local_edge], s));
  }
  return points;
}

/// Things at points, found by a point near them.
class PointIndex {
 public:
  explicit PointIndex(double tolerance) : cell_(4 * tolerance) {}

  void add(const Point& at, std::size_t what) { cells_[cell_of(at)].push_back(what); }
  /// Everything within the tolerance of a point, and perhaps more around it.
  [[nodiscard]] std::vector<std::size_t> near(const Point& at) const {
    std::vector<std::size_t> found;
    const auto [x, y] = cell_of(at);
    for (const int i : {-1, 0, 1})
      for (const int j : {-1, 0, 1})
        if (const auto its = cells_.find({x + i, y + j}); its != cells_.end())
          found.insert(found.end(), its->second.begin(), its->second.end());
    return found;
  }

 private:
  using Cell = std::pair<double, double>;
  [[nodiscard]] Cell cell_of(const Point& at) const { return {std::floor(at.x() / cell_), std::floor(at.y() / cell_)}; }

  double cell_;
  std::map<Cell, std::vector<std::size_t>> cells_;
};

/// Extends a piece by another that goes on straight from one of its ends; false if it does not.
bool goes_on(Piece& a, const Piece& b, double tolerance) {
  if (a.is_free != b.is_free) return false;
  for (const bool at_end : {true, false})
    for (const bool its_start : {true, false}) {
      const Point &meets = at_end ? a.to : a.from, &other = its_start ? b.from : b.to;
      if ((meets - other).norm() > tolerance) continue;
      const Point u = (a.to - a.from).normalized(), v = (b.to - b.from).normalized();
      if (std::abs(u.x() * v.y() - u.y() * v.x()) > 1e-9) continue;
      (at_end ? a.to : a.from) = its_start ? b.to : b.from;
      return true;
    }
  return false;
}

/// Joins pieces that go on straight.
std::vector<Piece> joined(std::vector<Piece> pieces, double tolerance) {
  PointIndex ends(tolerance);
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (const Point& end : {pieces[i].from, pieces[i].to}) ends.add(end, i);
  std::vector<bool> is_part(pieces.size(), false);  // of another
  const auto grow = [&](std::size_t i) {
    for (const Point& end : {pieces[i].from, pieces[i].to})
      for (const std::size_t k : ends.near(end))
        if (k != i && !is_part[k] && goes_on(pieces[i], pieces[k], tolerance)) return is_part[k] = true, true;
    return false;
  };
  std::vector<Piece> result;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (is_part[i]) continue;
    while (grow(i)) continue;
    result.push_back(pieces[i]);
  }
  return result;
}

}  // namespace

std::vector<Piece> outline_of(const PlateScene& scene, const PlateMesh& plate) {
  std::set<std::string> held_names;
  for (const auto& support : scene.supports) held_names.insert(support.on);
  for (const auto& external : scene.externals) held_names.insert(external.on);
  const Sides held = sides_with(plate.sets, held_names);
  Sides rims;
  for (const auto& rim : plate.rims) rims.insert(rim.sides.begin(), rim.sides.end());
  const double size = (plate.mesh.nodes.rowwise().maxCoeff() - plate.mesh.nodes.rowwise().minCoeff()).norm();
  const double tolerance = 1e-9 * size;
  std::vector<Piece> pieces;
  for (int edge = 0; edge < plate.edges.size(); ++edge) {
    const pfem::Side& side = plate.edges.sides[edge].front();
    if (!plate.edges.is_border(edge) || rims.contains(side)) continue;
    const auto points = points_of(plate, side);
    for (std::size_t i = 0; i + 1 < points.size(); ++i)
      pieces.push_back({points[i], points[i + 1], !held.contains(side)});
  }
  // The faces of a crack lie on each other.
  const auto middle = [&](std::size_t i) -> Point { return (pieces[i].from + pieces[i].to) / 2; };
  PointIndex middles(tolerance);
  for (std::size_t i = 0; i < pieces.size(); ++i) middles.add(middle(i), i);
  std::vector<Piece> outer;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto lies_on = [&](std::size_t k) { return k != i && (middle(k) - middle(i)).norm() < tolerance; };
    if (std::ranges::none_of(middles.near(middle(i)), lies_on)) outer.push_back(pieces[i]);
  }
  return joined(std::move(outer), tolerance);
}

}  // namespace fastjoint::stage1
