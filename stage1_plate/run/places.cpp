// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/solve.hpp"

#include <algorithm>
#include <limits>

namespace fastjoint::stage1 {
namespace {

/// Least and greatest of some coordinates.
struct Range {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();

  void add(double coordinate) { from = std::min(from, coordinate), to = std::max(to, coordinate); }
  [[nodiscard]] Eigen::RowVector2d row() const {
    return from <= to ? Eigen::RowVector2d(from, to) : Eigen::RowVector2d::Zero().eval();
  }
};

/// Adds the vertices and the points of integration of an edge; these reach beyond the vertices of an arc.
void add_edge(const PlateMesh& plate, const std::string& edge, rim::Axis axis, Range& range) {
  constexpr int degree = 8;
  const int along = rim::coordinate(axis);
  for (const auto& side : plate.sets.at(edge)) {
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, degree);
    for (int q = 0; q < rule.ds.size(); ++q) range.add(rule.x(along, q));
    for (const int node : plate.edges.nodes.col(plate.edges.of(side))) range.add(plate.mesh.nodes(along, node));
  }
}

Eigen::RowVector2d range_of(const PlateScene& scene, const PlateMesh& plate, const External& external) {
  Range range;
  if (external.kind == ExternalKind::bearing) {
    const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
    const double center = rim.center[rim::coordinate(external.direction)];
    range.add(center - rim.radius), range.add(center + rim.radius);
  } else if (external.kind != ExternalKind::moment) {
    add_edge(plate, external.on, external.direction, range);
  }
  return range.row();
}

Eigen::Vector2d center_of(const PlateScene& scene, const PlateMesh& plate, const std::string& hole) {
  const int at = index_of(scene.holes, hole, &Hole::id);
  if (at < count_of(scene.holes)) return plate.rims[at].center;
  return plate.mesh.nodes.col(plate.point_nodes[index_of(scene.points, hole, &PointSpring::id)]);
}

}  // namespace

formats::Places places_of(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem) {
  formats::Places places;
  const Unknowns& unknowns = problem.unknowns;
  places.disc.resize(unknowns.n_discs(), 2);
  for (int i = 0; i < unknowns.n_discs(); ++i) places.disc.row(i) = center_of(scene, plate, unknowns.disc_hole[i]);
  const auto externals = rigid_externals(scene);
  places.external.resize(std::ssize(externals), 2);
  for (int i = 0; i < count_of(externals); ++i)
    places.external.row(i) = range_of(scene, plate, scene.externals[externals[i]]);
  places.traction.resize(std::ssize(problem.tractions), 2);
  for (int i = 0; i < count_of(problem.tractions); ++i)
    places.traction.row(i) = range_of(scene, plate, scene.externals[problem.tractions[i].external]);
  places.support.resize(2, 2);
  places.support_middle.resize(2, 2);
  for (const rim::Axis axis : rim::both_axes) {
    Range range, middle;
    for (const auto& support : scene.supports) {
      if (std::ranges::find(support.fix, axis) == support.fix.end()) continue;
      Range its;
      add_edge(plate, support.on, axis, its);
      for (const double end : {its.from, its.to}) range.add(end);
      middle.add((its.from + its.to) / 2);
    }
    places.support.row(rim::coordinate(axis)) = range.row();
    places.support_middle.row(rim::coordinate(axis)) = middle.row();
  }
  return places;
}

}  // namespace fastjoint::stage1
