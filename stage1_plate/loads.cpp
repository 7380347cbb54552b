// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/loads.hpp"

#include <fmt/format.h>

#include "stage1_plate/assembler.hpp"

namespace fastjoint::stage1 {
namespace {

ElementVector friction_load(const pfem::SideRule& rule, double thickness, const Eigen::Vector2d& d) {
  ElementVector load{rule.modes, Eigen::Matrix2Xd::Zero(2, rule.N.rows())};
  for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
    const auto bearing = pfem::cosine_bearing(-rule.normal.col(q), d);
    load.values += thickness * rule.ds[q] * bearing.contact * bearing.tangent * rule.N.col(q).transpose();
  }
  return load;
}

}  // namespace

void add_friction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const Unknowns& unknowns = problem.unknowns;
  LoadAssembler loads(problem.numbering, unknowns, 2 * unknowns.n_discs());
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    if (!scene.holes[hole].spring_modulus) continue;
    for (const auto& direction : scene.disc_directions)
      for (const double sign : {1.0, -1.0}) {
        const int column = static_cast<int>(problem.friction_hole.size());
        problem.friction_hole.push_back(scene.holes[hole].id);
        problem.friction_bearing.push_back((sign > 0 ? "+" : "-") + direction);
        for (const auto& side : plate.rims[hole].sides) {
          const auto rule = pfem::rim_rule(plate.mesh, plate.edges, side, problem.numbering.p);
          const double thickness = plate.mesh.thickness[side.element];
          loads.add(side.element, friction_load(rule, thickness, sign * pfem::axis(direction)), column);
        }
      }
  }
  problem.L_f = loads.free();
  problem.L_c = loads.controlled();
}

void add_traction_loads(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  const auto& list = problem.unknowns.traction;
  LoadAssembler loads(problem.numbering, problem.unknowns, static_cast<int>(list.size()));
  for (std::size_t column = 0; column < list.size(); ++column) {
    const External& external = scene.externals[static_cast<std::size_t>(list[column])];
    const auto& sides = plate.sets.at(external.on);
    double area = 0;
    for (const auto& side : sides)
      area += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, plate.edges, side, 1).ds.sum();
    for (const auto& side : sides) {
      const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, problem.numbering.p);
      const Eigen::VectorXd spread = plate.mesh.thickness[side.element] / area * (rule.N * rule.ds);
      loads.add(side.element, {rule.modes, pfem::axis(external.direction) * spread.transpose()},
                static_cast<int>(column));
    }
  }
  problem.T_f = loads.free();
  problem.T_c = loads.controlled();
  for (std::size_t column = 0; column < list.size(); ++column) {
    const auto c = static_cast<Eigen::Index>(column);
    if (Eigen::VectorXd(problem.T_f.col(c)).isZero(0) && problem.T_c.col(c).isZero(0))
      reject(scene, fmt::format("/external/{}", list[column]), "supports hold the whole edge against this traction",
             "a traction along a direction in which the edge can move");
  }
}

}  // namespace fastjoint::stage1
