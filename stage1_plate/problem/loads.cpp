// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "common/rim/bearing.hpp"
#include "stage1_plate/problem/assembler.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

/// Uniform traction of unit total force on an edge.
void add_uniform(const PlateMesh& plate, const External& external, int p, int column, Assembler& loads) {
  const auto& sides = plate.sets.at(external.on);
  double area = 0;
  for (const auto& side : sides)
    area += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, plate.edges, side, 1).ds.sum();
  for (const auto& side : sides) {
    const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, p);
    const Eigen::VectorXd spread = plate.mesh.thickness[side.element] / area * (rule.N * rule.ds);
    loads.add(side.element, rule.modes, (spread * rim::axis(external.direction).transpose()).reshaped(), column);
  }
}

/// Cosine pressure on the half of an open hole that bears along the external's direction, of unit force along it.
void add_pressure(const PlateScene& scene, const PlateMesh& plate, int external_index, int p, int column,
                  Assembler& loads) {
  const External& external = scene.externals[external_index];
  const rim::Rim& rim = plate.rims[index_of(scene.holes, external.on, &Hole::id)];
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
    Eigen::MatrixX2d load = Eigen::MatrixX2d::Zero(rule.N.rows(), 2);
    for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
      const Eigen::Vector2d n = -rule.normal.col(q);
      const double pressure = rim::cosine_bearing(n, d).contact / unit_force;
      load += plate.mesh.thickness[side.element] * rule.ds[q] * pressure * rule.N.col(q) * n.transpose();
    }
    loads.add(side.element, rule.modes, load.reshaped(), column);
  }
}

}  // namespace

void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const auto& list = problem.unknowns.traction;
  Assembler loads(problem.numbering, problem.unknowns, count_of(list));
  for (int column = 0; column < count_of(list); ++column) {
    const External& external = scene.externals[list[column]];
    if (external.kind == ExternalKind::bearing)
      add_pressure(scene, plate, list[column], problem.numbering.p, column, loads);
    else
      add_uniform(plate, external, problem.numbering.p, column, loads);
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
