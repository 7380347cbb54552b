// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/legendre.hpp"

#include <cassert>
#include <cmath>

namespace fastjoint::pfem {

Values integrated_legendre(int p, const Eigen::VectorXd& x) {
  assert(p >= 1);
  const Eigen::RowVectorXd t = x.transpose();
  Eigen::MatrixXd P(p + 1, x.size());  // P(k, q) = P_k(x_q)
  P.row(0).setOnes();
  P.row(1) = t;
  for (int k = 2; k <= p; ++k) P.row(k) = ((2 * k - 1) * t.cwiseProduct(P.row(k - 1)) - (k - 1) * P.row(k - 2)) / k;

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
