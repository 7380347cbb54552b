// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/stress.hpp"

#include <Eigen/LU>

#include "common/pfem/element_map.hpp"
#include "common/pfem/gauss.hpp"
#include "common/pfem/trunk_space.hpp"

namespace fastjoint::test {

Eigen::Matrix2Xd coefficients(const Plate& plate, const Eigen::VectorXd& free, const Eigen::VectorXd& controlled) {
  const auto& target = plate.problem.unknowns.target;
  Eigen::Matrix2Xd u = Eigen::Matrix2Xd::Zero(2, static_cast<Eigen::Index>(target.size()) / 2);
  for (std::size_t i = 0; i < target.size(); ++i) {
    double& at = u(static_cast<Eigen::Index>(i % 2), static_cast<Eigen::Index>(i / 2));
    if (stage1::Unknowns::is_free(target[i])) {
      at = target[i] < free.size() ? free[target[i]] : 0;
    } else if (target[i] != stage1::Unknowns::fixed) {
      at = controlled[stage1::Unknowns::controlled_index(target[i])];
    }
  }
  return u;
}

Eigen::Vector3d stress_at(const Plate& plate, const Eigen::Matrix2Xd& u, int element, double xi, double eta) {
  const auto& numbering = plate.problem.numbering;
  const auto shape =
      pfem::shape_values(numbering.p, Eigen::VectorXd::Constant(1, xi), Eigen::VectorXd::Constant(1, eta));
  const pfem::ElementMap map(plate.mesh.mesh, plate.mesh.edges, element);
  Eigen::Matrix2d G = Eigen::Matrix2d::Zero();  // du/d(xi, eta)
  for (Eigen::Index m = 0; m < shape.N.rows(); ++m)
    G += numbering.sign(m, element) * u.col(numbering.function(m, element)) *
         Eigen::RowVector2d(shape.dN_dxi(m, 0), shape.dN_deta(m, 0));
  const Eigen::Matrix2d grad = G * map.jacobian(xi, eta).inverse();
  const auto& D = plate.scene.elasticity[static_cast<std::size_t>(plate.mesh.mesh.material[element])];
  return D * Eigen::Vector3d(grad(0, 0), grad(1, 1), grad(0, 1) + grad(1, 0));
}

double integrated_force(const Plate& plate, const Eigen::Matrix2Xd& u, const std::string& set) {
  const auto rule = pfem::gauss(12);
  double force = 0;
  for (const auto& side : plate.mesh.sets.at(set)) {
    const auto curve = pfem::edge_curve(plate.mesh.mesh, plate.mesh.edges, side.element, side.local_edge);
    for (Eigen::Index q = 0; q < rule.x.size(); ++q) {
      const double s = rule.x[q];
      const Eigen::Vector2d at = side.local_edge == 0   ? Eigen::Vector2d(s, -1)
                                 : side.local_edge == 1 ? Eigen::Vector2d(1, s)
                                 : side.local_edge == 2 ? Eigen::Vector2d(s, 1)
                                                        : Eigen::Vector2d(-1, s);
      force += rule.w[q] * curve.derivative(s).norm() * plate.mesh.mesh.thickness[side.element] *
               stress_at(plate, u, side.element, at.x(), at.y())[0];
    }
  }
  return force;
}

}  // namespace fastjoint::test
