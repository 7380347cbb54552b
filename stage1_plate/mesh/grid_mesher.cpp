// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/mesh/plate_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "common/count.hpp"
#include "stage1_plate/mesh/grid_cracks.hpp"

namespace fastjoint::stage1 {
namespace {

using Point = Eigen::Vector2d;

/// Collects nodes and elements. Both neighbours of a cell line give its points with equal digits.
class Builder {
 public:
  explicit Builder(const GridGeometry& grid) : grid_(grid) {}
  int shared_node(const Point& at) {
    const auto [found, is_new] = index_.try_emplace({at.x(), at.y()}, count_of(nodes_));
    return is_new ? own_node(at) : found->second;
  }
  int own_node(const Point& at) {
    nodes_.push_back(at);
    return count_of(nodes_) - 1;
  }
  void quad(const Eigen::Vector4i& nodes, const Cell& cell) {
    const auto [column, row] = cell.index;
    quads_.push_back(nodes);
    thickness_.push_back(grid_.thickness(row, column));
    material_.push_back(grid_.material(row, column));
  }
  void arc(int a, int b, const Point& center) { arcs_.push_back({a, b, center}); }
  [[nodiscard]] int n_elements() const { return count_of(quads_); }
  [[nodiscard]] const Point& at(int node) const { return nodes_[node]; }
  [[nodiscard]] pfem::Mesh mesh() const {
    using Eigen::Map;
    return {Map<const Eigen::Matrix2Xd>(nodes_.data()->data(), 2, nodes_.size()),
            Map<const Eigen::Matrix4Xi>(quads_.data()->data(), 4, n_elements()), arcs_,
            Map<const Eigen::VectorXd>(thickness_.data(), n_elements()),
            Map<const Eigen::VectorXi>(material_.data(), n_elements())};
  }

 private:
  const GridGeometry& grid_;
  std::map<std::pair<double, double>, int> index_;
  std::vector<Point> nodes_;
  std::vector<Eigen::Vector4i> quads_;
  std::vector<double> thickness_;
  std::vector<int> material_;
  std::vector<pfem::Arc> arcs_;
};

std::vector<double> with_ends(double low, const std::vector<double>& inner, double high) {
  std::vector<double> all = {low};
  all.insert(all.end(), inner.begin(), inner.end());
  all.push_back(high);
  return all;
}

void mesh_plain_cell(Builder& builder, const SideNodes& nodes, const Cell& cell) {
  const auto x = with_ends(cell.low.x(), nodes.of(cell, bottom), cell.high.x());
  const auto y = with_ends(cell.low.y(), nodes.of(cell, left), cell.high.y());
  for (int j = 0; j + 1 < count_of(y); ++j)
    for (int i = 0; i + 1 < count_of(x); ++i)
      builder.quad({builder.shared_node({x[i], y[j]}), builder.shared_node({x[i + 1], y[j]}),
                    builder.shared_node({x[i + 1], y[j + 1]}), builder.shared_node({x[i], y[j + 1]})},
                   cell);
}

/// Points of one side in counter-clockwise order, without the last.
std::vector<Point> side_points(const SideNodes& nodes, const Cell& cell, int side) {
  const std::array<Point, n_cell_sides> corners = {
      cell.low, {cell.high.x(), cell.low.y()}, cell.high, {cell.low.x(), cell.high.y()}};
  const Point& corner = corners[side];
  auto at = nodes.of(cell, static_cast<CellSide>(side));
  if (side == top || side == left) std::reverse(at.begin(), at.end());
  std::vector<Point> points = {corner};
  for (const double t : at)
    points.push_back(side == bottom || side == top ? Point(t, corner.y()) : Point(corner.x(), t));
  return points;
}

/// The cell's outline around the hole, counter-clockwise: closed (first point repeated) for a whole hole, else from
/// edge to edge of the plate.
std::vector<Point> outline(const SideNodes& nodes, const HoleCell& hole) {
  int first = 0;  // the side after a cut that is not cut itself
  for (int side = 0; side < n_cell_sides; ++side)
    if (hole.cuts[side] && !hole.cuts[(side + 1) % n_cell_sides]) first = (side + 1) % n_cell_sides;
  std::vector<Point> points;
  int last = first;
  for (int i = 0; i < n_cell_sides; ++i) {
    const int side = (first + i) % n_cell_sides;
    if (hole.cuts[side]) continue;
    const auto next = side_points(nodes, hole, side);
    points.insert(points.end(), next.begin(), next.end());
    last = side;
  }
  points.push_back(side_points(nodes, hole, (last + 1) % n_cell_sides).front());
  return points;
}

/// Distance from a hole's centre to the nearest side of its cell that does not cut the hole.
double nearest_side(const HoleCell& hole) {
  const Point below = hole.center - hole.low, above = hole.high - hole.center;
  const std::array<double, n_cell_sides> distance = {below.y(), above.x(), above.y(), below.x()};
  double nearest = std::numeric_limits<double>::infinity();
  for (int side = 0; side < count_of(distance); ++side)
    if (!hole.cuts[side]) nearest = std::min(nearest, distance[side]);
  return nearest;
}

/// The hole's rim and its extra rings, in geometric progression up to the nearest side of the cell.
std::vector<RingLine> ring_lines(double nearest, double radius, int n_rings, Eigen::Index n_rays) {
  std::vector<RingLine> lines;
  for (int k = 0; k <= n_rings; ++k) {
    const double at = radius * std::pow(nearest / radius, double(k) / (n_rings + 1));
    lines.push_back({Eigen::VectorXd::Constant(n_rays, at), Eigen::VectorXd::Ones(n_rays - 1)});
  }
  return lines;
}

/// Centre of the arc between two points around a hole whose rise over their chord is `roundness` times that of a circle
/// about the hole's centre.
Point arc_center(const Point& a, const Point& b, const Point& center, double roundness) {
  const Point chord = b - a, from = a - center, to = b - center;
  const double half_angle = std::acos(from.normalized().dot(to.normalized())) / 2;
  const double rise = roundness * (from.norm() + to.norm()) / 2 * (1 - std::cos(half_angle));
  const double radius = (chord.squaredNorm() / 4 + rise * rise) / (2 * rise);
  return (a + b) / 2 + (rise - radius) * Point(chord.y(), -chord.x()).normalized();
}

/// Nodes of a line around a hole, one on the ray to each point of the outline. A closed line ends with its first node.
std::vector<int> line_nodes(Builder& builder, const std::vector<Point>& points, const Point& center,
                            const RingLine& line) {
  const bool closed = points.front() == points.back();
  const auto& [radii, roundness] = line;
  std::vector<int> nodes;
  for (int i = 0; i < count_of(points); ++i)
    nodes.push_back(closed && i + 1 == count_of(points)
                        ? nodes.front()
                        : builder.own_node(center + radii[i] * (points[i] - center).normalized()));
  for (int i = 0; i + 1 < count_of(nodes); ++i) {
    const bool is_circle = roundness[i] == 1 && radii[i] == radii[i + 1];
    builder.arc(nodes[i], nodes[i + 1],
                is_circle ? center : arc_center(builder.at(nodes[i]), builder.at(nodes[i + 1]), center, roundness[i]));
  }
  return nodes;
}

void mesh_hole_cell(Builder& builder, const SideNodes& nodes, const HoleCell& cell, const Hole& hole,
                    const std::vector<CellTip>& tips) {
  const auto points = outline(nodes, cell);
  const double nearest = nearest_side(cell);
  const auto lines = tips.empty() ? ring_lines(nearest, hole.radius, hole.rings, std::ssize(points))
                                  : tip_layers(tips, hole.radius, cell.center, points, nearest);
  std::vector<std::vector<int>> layers;
  for (const auto& line : lines) layers.push_back(line_nodes(builder, points, cell.center, line));
  layers.emplace_back();
  for (const auto& point : points) layers.back().push_back(builder.shared_node(point));
  for (int k = 0; k + 1 < count_of(layers); ++k)
    for (int i = 0; i + 1 < count_of(points); ++i)
      builder.quad({layers[k][i], layers[k + 1][i], layers[k + 1][i + 1], layers[k][i + 1]}, cell);
}

/// Range of elements of a cell with a hole: [first, last).
struct CellElements {
  const HoleCell* cell;
  int first, last;
};

/// Sides of elements [first, last) on the line where coordinate `axis` has the value `line`.
std::vector<pfem::Side> sides_on(const PlateMesh& plate, int first, int last, int axis, double line) {
  std::vector<pfem::Side> sides;
  for (int element = first; element < last; ++element)
    for (int edge = 0; edge < n_cell_sides; ++edge) {
      const auto nodes = plate.edges.nodes.col(plate.edges.of_element(edge, element));
      if (plate.mesh.nodes(axis, nodes[0]) == line && plate.mesh.nodes(axis, nodes[1]) == line)
        sides.push_back({element, edge});
    }
  return sides;
}

void name_border(const GridGeometry& grid, PlateMesh& plate) {
  const auto border = [&](int axis, double line) { return sides_on(plate, 0, plate.mesh.n_elements(), axis, line); };
  plate.sets = {{"left", border(0, grid.x.front())},
                {"right", border(0, grid.x.back())},
                {"bottom", border(1, grid.y.front())},
                {"top", border(1, grid.y.back())}};
}

/// Adds the sides of a hole's cell across each direction of the discs, unless they run through the hole.
void add_sections(const PlateScene& scene, const CellElements& at, PlateMesh& plate) {
  for (const rim::Axis direction : scene.disc_directions) {
    const int axis = rim::coordinate(direction);
    const auto add = [&](CellSide side, int sign, const Point& corner) {
      if (!at.cell->cuts[side])
        plate.sections.push_back(
            {at.cell->hole, rim::name_of({direction, sign}), sides_on(plate, at.first, at.last, axis, corner[axis])});
    };
    add(axis == 0 ? right : top, 1, at.cell->high);
    add(axis == 0 ? left : bottom, -1, at.cell->low);
  }
}

}  // namespace

PlateMesh mesh_grid(const PlateScene& scene, const GridGeometry& given) {
  auto tips = place_tips(scene, given);
  const auto [grid, moves] = lines_through_tips(scene, given, tips);
  const auto holes = find_hole_cells(scene, grid);
  const GridCracks cracks = plan_cracks(scene, grid, holes, tips);
  const SideNodes nodes = place_nodes(scene, grid, holes, cracks.nodes);
  Builder builder(grid);
  std::vector<CellElements> with_hole;
  for (int row = 0; row < grid.thickness.rows(); ++row)
    for (int column = 0; column < grid.thickness.cols(); ++column) {
      const int first = builder.n_elements();
      const Cell cell = cell_at(grid, column, row);
      const auto hole = std::ranges::find(holes, cell.index, &HoleCell::index);
      if (hole == holes.end()) {
        mesh_plain_cell(builder, nodes, cell);
      } else {
        mesh_hole_cell(builder, nodes, *hole, scene.holes[hole->hole], cracks.tips[hole - holes.begin()]);
        with_hole.push_back({&*hole, first, builder.n_elements()});
      }
    }
  PlateMesh plate;
  plate.mesh = builder.mesh();
  plate.edges = pfem::find_edges(plate.mesh);
  name_border(grid, plate);
  for (const auto& at : with_hole) add_sections(scene, at, plate);
  open_cracks(scene, crack_paths(scene, plate), plate);
  plate.moved_lines = moves;
  return plate;
}

}  // namespace fastjoint::stage1
