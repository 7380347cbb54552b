// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element_map.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {

ElementMap::ElementMap(const Mesh& mesh, const Edges& edges, int element)
    : curves_{edge_curve(mesh, edges, element, 0), edge_curve(mesh, edges, element, 1),
              edge_curve(mesh, edges, element, 2), edge_curve(mesh, edges, element, 3)} {
  for (int v = 0; v < 4; ++v) vertices_.col(v) = mesh.nodes.col(mesh.quads(v, element));
}

Eigen::Vector2d ElementMap::point(double xi, double eta) const {
  const auto& [bottom, right, top, left] = curves_;
  const Eigen::Vector4d bilinear =
      Eigen::Vector4d((1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)) / 4;
  return (1 - eta) / 2 * bottom.point(xi) + (1 + eta) / 2 * top.point(xi) + (1 - xi) / 2 * left.point(eta) +
         (1 + xi) / 2 * right.point(eta) - vertices_ * bilinear;
}

Eigen::Matrix2d ElementMap::jacobian(double xi, double eta) const {
  const auto& [bottom, right, top, left] = curves_;
  const Eigen::Vector4d bilinear_xi = Eigen::Vector4d(-(1 - eta), 1 - eta, 1 + eta, -(1 + eta)) / 4;
  const Eigen::Vector4d bilinear_eta = Eigen::Vector4d(-(1 - xi), -(1 + xi), 1 + xi, 1 - xi) / 4;
  Eigen::Matrix2d J;
  J.col(0) = (1 - eta) / 2 * bottom.derivative(xi) + (1 + eta) / 2 * top.derivative(xi) +
             (right.point(eta) - left.point(eta)) / 2 - vertices_ * bilinear_xi;
  J.col(1) = (1 - xi) / 2 * left.derivative(eta) + (1 + xi) / 2 * right.derivative(eta) +
             (top.point(xi) - bottom.point(xi)) / 2 - vertices_ * bilinear_eta;
  return J;
}

bool ElementMap::is_curved() const {
  return std::any_of(curves_.begin(), curves_.end(), [](const Curve& c) { return c.is_arc(); });
}

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

}  // namespace fastjoint::pfem
