// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/stresses/section_force.hpp"

#include "common/count.hpp"
#include "common/pfem/legendre.hpp"
#include "common/pfem/shape_functions.hpp"
#include "common/pfem/strain.hpp"
#include "common/rim/bearing.hpp"
#include "stage2_extract/matrices/friction_constants.hpp"

namespace fastjoint::stage2 {
namespace {

/// The side itself, and the same edge seen from the element beyond, if there is one.
std::vector<pfem::Side> both_sides(const pfem::Edges& edges, const pfem::Side& side) {
  const int edge = edges.of_element(side.local_edge, side.element);
  std::vector<pfem::Side> result;
  for (int element = 0; element < edges.of_element.cols(); ++element)
    for (int local = 0; local < pfem::n_local_edges; ++local)
      if (edges.of_element(local, element) == edge) result.push_back({element, local});
  return result;
}

/// int n.sigma.n t ds over one side of an element; n along x or y.
Eigen::RowVectorXd side_force(const UnitFields& fields, const pfem::Side& side, Eigen::Index component) {
  const auto& mesh = fields.plate().mesh;
  const auto rule = pfem::gauss(fields.p() + 3);  // a rational integrand: see element_stiffness.cpp
  const pfem::ElementMap map(mesh, fields.edges(), side.element);
  const auto curve = pfem::edge_curve(mesh, fields.edges(), side.element, side.local_edge);
  const Eigen::Matrix2Xd at = pfem::along_edge(side.local_edge, rule.x);
  const Eigen::MatrixXd B =
      pfem::strain_operator(map, fields.space(), fields.p(), at.row(0).transpose(), at.row(1).transpose());
  Eigen::RowVectorXd per_coefficient = Eigen::RowVectorXd::Zero(B.cols());
  for (Eigen::Index q = 0; q < rule.x.size(); ++q)
    per_coefficient += rule.w[q] * curve.derivative(rule.x[q]).norm() * mesh.thickness[side.element] *
                       fields.elasticity(side.element).row(component) * B.middleRows<3>(3 * q);
  return per_coefficient * fields.coefficients(side.element);
}

}  // namespace

Eigen::RowVectorXd section_force(const UnitFields& fields, const rim::Section& section) {
  const Eigen::Index component = section.side[1] == 'x' ? 0 : 1;
  Eigen::RowVectorXd force = Eigen::RowVectorXd::Zero(fields.n_cases());
  for (const auto& side : section.sides) {
    const auto sides = both_sides(fields.edges(), side);
    for (const auto& one : sides) force += side_force(fields, one, component) / count_of(sides);
  }
  return force;
}

SectionArea section_area(const UnitFields& fields, const rim::Section& section) {
  const auto& plate = fields.plate();
  const auto& edges = fields.edges();
  double gross = 0;
  for (const auto& side : section.sides)
    gross += plate.mesh.thickness[side.element] * pfem::side_rule(plate.mesh, edges, side, 1).ds.sum();
  return {gross,
          gross - rim::bearing(plate.mesh, edges, plate.hole_rim[section.hole], bearing_direction(section.side)).area};
}

}  // namespace fastjoint::stage2
