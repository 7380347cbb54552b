// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/sections.hpp"

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::plate {
namespace {

/// Integral of a component of the stress, xx, yy or xy, times t ds over one side of an element as a function of the
/// element's coefficients.
Eigen::VectorXd side_force(const pfem::Mesh& mesh, const pfem::Edges& edges, const pfem::Numbering& numbering,
                           const Eigen::Matrix3d& elasticity, const pfem::Side& side, Eigen::Index component) {
  // The integrand is rational, with poles near the side where the element is as thin as beside a large hole.
  const auto rule = pfem::gauss(2 * numbering.p + 8);
  const pfem::ElementMap map(mesh, edges, side.element);
  const auto curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
  const Eigen::Matrix2Xd at = pfem::along_edge(side.local_edge, rule.x);
  const Eigen::MatrixXd B =
      pfem::strain_operator(map, numbering.space, numbering.p, at.row(0).transpose(), at.row(1).transpose());
  Eigen::RowVectorXd per_coefficient = Eigen::RowVectorXd::Zero(B.cols());
  for (Eigen::Index q = 0; q < rule.x.size(); ++q)
    per_coefficient += rule.w[q] * curve.derivative(rule.x[q]).norm() * mesh.thickness[side.element] *
                       elasticity.row(component) * B.middleRows<3>(3 * q);
  return per_coefficient.transpose();
}

}  // namespace

PlateFactor::Functions section_forces(const PlateFactor& factor, const pfem::Mesh& mesh, const pfem::Edges& edges,
                                      const pfem::Numbering& numbering, const std::vector<Eigen::Matrix3d>& elasticity,
                                      const std::vector<rim::Section>& sections) {
  PlateFactor::Functions forces;
  const auto add = [&](const rim::Section& section, Eigen::Index component) {
    forces.emplace_back();
    for (const auto& side : section.sides) {
      const auto& sides = edges.sides[edges.of(side)];
      for (const auto& one : sides) {
        const Eigen::VectorXd force =
            side_force(mesh, edges, numbering, elasticity[mesh.material[one.element]], one, component);
        forces.back().push_back(factor.condense_functions(one.element, force / count_of(sides)));
      }
    }
  };
  constexpr Eigen::Index shear = 2;
  for (const auto& section : sections) add(section, rim::coordinate(rim::signed_axis_named(section.side).axis));
  for (const auto& section : sections) add(section, shear);
  return forces;
}

}  // namespace fastjoint::plate
