// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/strain.hpp"

#include <Eigen/LU>
#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {

Eigen::MatrixXd strain_operator(const ElementMap& map, Space space, int p, const Eigen::VectorXd& xi,
                                const Eigen::VectorXd& eta) {
  const ShapeValues shape = shape_values(space, p, xi, eta);
  const auto n = shape.N.rows();
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(3 * xi.size(), 2 * n);
  for (Eigen::Index q = 0; q < xi.size(); ++q) {
    const Eigen::Matrix2d to_physical = map.jacobian(xi[q], eta[q]).inverse();
    const Eigen::RowVectorXd Nx =
        to_physical(0, 0) * shape.dN_dxi.col(q).transpose() + to_physical(1, 0) * shape.dN_deta.col(q).transpose();
    const Eigen::RowVectorXd Ny =
        to_physical(0, 1) * shape.dN_dxi.col(q).transpose() + to_physical(1, 1) * shape.dN_deta.col(q).transpose();
    B.row(3 * q) << Nx, Eigen::RowVectorXd::Zero(n);
    B.row(3 * q + 1) << Eigen::RowVectorXd::Zero(n), Ny;
    B.row(3 * q + 2) << Ny, Nx;
  }
  return B;
}

Eigen::Matrix2Xd along_edge(int local_edge, const Eigen::VectorXd& s) {
  const double fixed = local_edge == 0 || local_edge == 3 ? -1 : 1;
  const Eigen::RowVectorXd constant = Eigen::RowVectorXd::Constant(s.size(), fixed);
  Eigen::Matrix2Xd points(2, s.size());
  points.row(local_edge % 2 == 0 ? 0 : 1) = s.transpose();
  points.row(local_edge % 2 == 0 ? 1 : 0) = constant;
  return points;
}

Eigen::Matrix3d polar_stress(double theta) {
  const double c = std::cos(theta);
  const double s = std::sin(theta);
  Eigen::Matrix3d T;
  T << c * c, s * s, 2 * c * s,  //
      s * s, c * c, -2 * c * s,  //
      -c * s, c * s, c * c - s * s;
  return T;
}

}  // namespace fastjoint::pfem
