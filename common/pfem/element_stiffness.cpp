// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element_stiffness.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/linalg/condensed.hpp"

namespace fastjoint::pfem {
namespace {

// A bilinear map makes the integrand rational, arcs make it transcendental: points beyond the p + 1 that a
// parallelogram needs. The sweep in tests/common/element_stiffness_test.cpp shows that more changes nothing.
constexpr int extra_straight = 3;
constexpr int extra_curved = 7;

}  // namespace

ElementStiffness::ElementStiffness(Space space, int p, int extra)
    : straight_(tabulate(space, p, p + extra_straight + extra)),
      curved_(tabulate(space, p, p + extra_curved + extra)) {}

ElementStiffness::Table ElementStiffness::tabulate(Space space, int p, int n_points) {
  const Rule rule = gauss(n_points);
  Table table;
  table.xi = rule.x.replicate(n_points, 1);
  table.eta.resize(table.xi.size());
  table.w.resize(table.xi.size());
  for (Eigen::Index j = 0; j < n_points; ++j) {
    table.eta.segment(j * n_points, n_points).setConstant(rule.x[j]);
    table.w.segment(j * n_points, n_points) = rule.w[j] * rule.w;
  }
  table.shape = shape_values(space, p, table.xi, table.eta);
  return table;
}

Eigen::MatrixXd ElementStiffness::operator()(const ElementMap& map, const Eigen::Matrix3d& D, double thickness) const {
  const Table& table = map.is_curved() ? curved_ : straight_;
  const auto n_points = table.w.size();
  const auto n = table.shape.N.rows();
  Eigen::MatrixXd Nx(n, n_points), Ny(n, n_points);  // derivatives by x and y, times the root of the weight
  for (Eigen::Index q = 0; q < n_points; ++q) {
    const Eigen::Matrix2d J = map.jacobian(table.xi[q], table.eta[q]);
    const double det = J.determinant();
    const Eigen::Matrix2d to_physical = J.inverse() * std::sqrt(table.w[q] * det * thickness);
    Nx.col(q) = table.shape.dN_dxi.col(q) * to_physical(0, 0) + table.shape.dN_deta.col(q) * to_physical(1, 0);
    Ny.col(q) = table.shape.dN_dxi.col(q) * to_physical(0, 1) + table.shape.dN_deta.col(q) * to_physical(1, 1);
  }
  const Eigen::MatrixXd XX = linalg::product_transposed(Nx, Nx);
  const Eigen::MatrixXd XY = linalg::product_transposed(Nx, Ny);
  const Eigen::MatrixXd YY = linalg::product_transposed(Ny, Ny);
  const Eigen::MatrixXd YX = XY.transpose();
  Eigen::MatrixXd K(2 * n, 2 * n);
  K.topLeftCorner(n, n) = D(0, 0) * XX + D(0, 2) * (XY + YX) + D(2, 2) * YY;
  K.topRightCorner(n, n) = D(0, 1) * XY + D(0, 2) * XX + D(1, 2) * YY + D(2, 2) * YX;
  K.bottomLeftCorner(n, n) = K.topRightCorner(n, n).transpose();
  K.bottomRightCorner(n, n) = D(1, 1) * YY + D(1, 2) * (XY + YX) + D(2, 2) * XX;
  return K;
}

double jacobian_ratio(const ElementMap& map) {
  constexpr int n_samples = 9;  // vertices and edges included: that is where a map folds first
  double least = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int i = 0; i < n_samples; ++i)
    for (int j = 0; j < n_samples; ++j) {
      const double det = map.jacobian(-1 + 2.0 * i / (n_samples - 1), -1 + 2.0 * j / (n_samples - 1)).determinant();
      least = std::min(least, det);
      sum += det;
    }
  return least / std::abs(sum / (n_samples * n_samples));
}

}  // namespace fastjoint::pfem
