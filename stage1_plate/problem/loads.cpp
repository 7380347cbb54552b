// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/loads.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/count.hpp"
#include "common/rim/bearing.hpp"
#include "stage1_plate/problem/assembler.hpp"

namespace fastjoint::stage1 {
namespace {

/// Uniform traction of unit total force on an edge.
void add_uniform(const PlateMesh& plate, const External& external, int p, int column, LoadAssembler& loads) {
  const auto& sides = plate.sets.at(external.on);
  double area = 0;
  for (const auto& side : sides)
    area += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, plate.edges, side, 1).ds.sum();
  for (const auto& side : sides) {
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, p);
    const Eigen::VectorXd spread = plate.mesh.thickness[side.element] / area * (rule.N * rule.ds);
    loads.add(side.element, {rule.modes, rim::axis(external.direction) * spread.transpose()}, column);
  }
}

/// Cosine pressure on the half of an open hole that bears along the external's direction, of unit force along it.
void add_pressure(const PlateScene& scene, const PlateMesh& plate, int external_index, int p, int column,
                  LoadAssembler& loads) {
  const External& external = scene.externals[external_index];
  const auto is_meant = [&](const Hole& hole) { return hole.id == external.on; };
  const auto hole = std::find_if(scene.holes.begin(), scene.holes.end(), is_meant) - scene.holes.begin();
  const rim::Rim& rim = plate.rims[hole];
  const Eigen::Vector2d d = rim::axis(external.direction);
  const double unit_force = rim::bearing(plate.mesh, plate.edges, rim, d).unit_force;
  constexpr double nothing = 1e-12;  // of what a whole rim bears; rounding leaves about 1e-16
  if (unit_force < nothing * plate.mesh.thickness.maxCoeff() * rim.radius)
    reject(scene, fmt::format("/external/{}", external_index),
           fmt::format("the model has no rim of hole \"{}\" on the side that bears along +{}", external.on,
                       external.direction),
           "a hole with a rim on that side");
  for (const auto& side : rim.sides) {
    const auto rule = rim::rim_rule(plate.mesh, plate.edges, side, p);
    ElementVector load{rule.modes, Eigen::Matrix2Xd::Zero(2, rule.N.rows())};
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q);
      const double pressure = rim::cosine_bearing(n, d).contact / unit_force;
      load.values += plate.mesh.thickness[side.element] * rule.ds[q] * pressure * n * rule.N.col(q).transpose();
    }
    loads.add(side.element, load, column);
  }
}

}  // namespace

void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const auto& list = problem.unknowns.traction;
  LoadAssembler loads(problem.numbering, problem.unknowns, count_of(list));
  for (std::size_t column = 0; column < list.size(); ++column) {
    const External& external = scene.externals[list[column]];
    if (external.kind == ExternalKind::bearing)
      add_pressure(scene, plate, list[column], problem.numbering.p, static_cast<int>(column), loads);
    else
      add_uniform(plate, external, problem.numbering.p, static_cast<int>(column), loads);
  }
  problem.T_f = loads.free();
  problem.T_c = loads.controlled();
  for (std::size_t column = 0; column < list.size(); ++column) {
    if (Eigen::VectorXd(problem.T_f.col(column)).isZero(0) && problem.T_c.col(column).isZero(0))
      reject(scene, fmt::format("/external/{}", list[column]), "supports hold all that it loads against it",
             "a load along a direction in which the plate can move there");
  }
}

}  // namespace fastjoint::stage1
