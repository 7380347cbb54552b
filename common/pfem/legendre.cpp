// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/legendre.hpp"

#include <gsl/gsl_integration.h>

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

}  // namespace fastjoint::pfem
