// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/stress.hpp"

#include "common/pfem/element.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::test {

Eigen::Matrix2Xd coefficients(const Plate& plate, const Eigen::VectorXd& free, const Eigen::VectorXd& controlled) {
  const auto& dofs = plate.problem.unknowns.dofs;
  return Eigen::Matrix2Xd::NullaryExpr(2, dofs.cols(), [&](Eigen::Index component, Eigen::Index function) {
    const int dof = dofs(component, function);
    if (pfem::is_controlled(dof)) return controlled[pfem::controlled_index(dof)];
    return pfem::is_free(dof) && dof < free.size() ? free[dof] : 0;
  });
}

Eigen::Vector3d stress_at(const Plate& plate, const Eigen::Matrix2Xd& u, int element, double xi, double eta) {
  const auto& numbering = plate.problem.numbering;
  const pfem::ElementMap map(plate.mesh.mesh, plate.mesh.edges, element);
  const auto n = numbering.function.rows();
  Eigen::VectorXd c(2 * n);  // first those of u_x
  for (Eigen::Index m = 0; m < n; ++m) {
    const Eigen::Vector2d value = numbering.sign(m, element) * u.col(numbering.function(m, element));
    c[m] = value.x();
    c[n + m] = value.y();
  }
  const auto at = [](double x) { return Eigen::VectorXd::Constant(1, x); };
  const auto& D = plate.scene.elasticity[plate.mesh.mesh.material[element]];
  return D * pfem::strain_operator(map, numbering.space, numbering.p, at(xi), at(eta)) * c;
}

double integrated_force(const Plate& plate, const Eigen::Matrix2Xd& u, const std::string& set) {
  const auto rule = pfem::gauss(12);
  double force = 0;
  for (const auto& side : plate.mesh.sets.at(set)) {
    const auto curve = pfem::edge_curve(plate.mesh.mesh, plate.mesh.edges, side.element, side.local_edge);
    const Eigen::Matrix2Xd at = pfem::along_edge(side.local_edge, rule.x);
    for (Eigen::Index q = 0; q < rule.x.size(); ++q)
      force += rule.w[q] * curve.derivative(rule.x[q]).norm() * plate.mesh.mesh.thickness[side.element] *
               stress_at(plate, u, side.element, at(0, q), at(1, q))[0];
  }
  return force;
}

}  // namespace fastjoint::test
