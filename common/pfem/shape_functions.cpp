// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/shape_functions.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <new>

namespace fastjoint::pfem {

Rule gauss(int n) {
  assert(n >= 1);
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(n), &gsl_integration_glfixed_table_free);
  if (!table) throw std::bad_alloc();
  Rule rule{Eigen::VectorXd(n), Eigen::VectorXd(n)};
  for (int i = 0; i < n; ++i) gsl_integration_glfixed_point(-1, 1, i, &rule.x[i], &rule.w[i], table.get());
  return rule;
}

Eigen::MatrixXd legendre(int p, const Eigen::VectorXd& x) {
  const Eigen::RowVectorXd t = x.transpose();
  Eigen::MatrixXd P = Eigen::MatrixXd::Ones(p + 1, x.size());
  if (p > 0) P.row(1) = t;
  for (int k = 2; k <= p; ++k) P.row(k) = ((2 * k - 1) * t.cwiseProduct(P.row(k - 1)) - (k - 1) * P.row(k - 2)) / k;
  return P;
}

Values integrated_legendre(int p, const Eigen::VectorXd& x) {
  assert(p >= 1);
  const Eigen::RowVectorXd t = x.transpose();
  const Eigen::MatrixXd P = legendre(p, x);
  Values v{Eigen::MatrixXd(p + 1, x.size()), Eigen::MatrixXd(p + 1, x.size())};
  v.N.row(0) = (P.row(0) - t) / 2;
  v.N.row(1) = (P.row(0) + t) / 2;
  v.dN.row(0).setConstant(-0.5);
  v.dN.row(1).setConstant(0.5);
  for (int k = 2; k <= p; ++k) {
    v.N.row(k) = (P.row(k) - P.row(k - 2)) / std::sqrt(2.0 * (2 * k - 1));
    v.dN.row(k) = std::sqrt((2 * k - 1) / 2.0) * P.row(k - 1);  // since (2k-1) P_{k-1} = (P_k - P_{k-2})'
  }
  return v;
}

std::vector<Mode> modes(Space space, int p) {
  assert(p >= 1);
  std::vector<Mode> list = {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  for (int edge = 0; edge < n_local_edges; ++edge)
    for (int k = 2; k <= p; ++k) {
      const int across = edge == 1 || edge == 2 ? 1 : 0;
      list.push_back(edge % 2 == 0 ? Mode{k, across, k} : Mode{across, k, k});
    }
  for (int degree = 2; degree <= p; ++degree)
    for (int i = 2; i <= degree; ++i)
      for (int j = 2; j <= degree; ++j)
        if (degree == (space == Space::trunk ? i + j : std::max(i, j))) list.push_back({i, j, degree});
  return list;
}

std::vector<int> modes_on_edge(int p, int edge) {
  const auto [first, second] = natural_ends(edge);
  std::vector<int> list = {first, second};
  for (int k = 2; k <= p; ++k) list.push_back(edge_mode(p, edge, k));
  return list;
}

Eigen::Matrix2Xd along_edge(int local_edge, const Eigen::VectorXd& s) {
  Eigen::Matrix2Xd points(2, s.size());
  points.row(local_edge % 2) = s.transpose();
  points.row(1 - local_edge % 2).setConstant(local_edge == 0 || local_edge == 3 ? -1 : 1);
  return points;
}

ShapeValues shape_values(Space space, int p, const Eigen::VectorXd& xi, const Eigen::VectorXd& eta) {
  const auto list = modes(space, p);
  const Eigen::Index n_modes = list.size();
  const Values X = integrated_legendre(p, xi);
  const Values Y = integrated_legendre(p, eta);
  ShapeValues v{Eigen::MatrixXd(n_modes, xi.size()), Eigen::MatrixXd(n_modes, xi.size()),
                Eigen::MatrixXd(n_modes, xi.size())};
  for (Eigen::Index m = 0; m < n_modes; ++m) {
    const auto [i, j, degree] = list[m];
    v.N.row(m) = X.N.row(i).cwiseProduct(Y.N.row(j));
    v.dN_dxi.row(m) = X.dN.row(i).cwiseProduct(Y.N.row(j));
    v.dN_deta.row(m) = X.N.row(i).cwiseProduct(Y.dN.row(j));
  }
  return v;
}

}  // namespace fastjoint::pfem
