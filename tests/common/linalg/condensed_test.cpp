// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/condensed.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "common/errors.hpp"

namespace fastjoint::linalg {
namespace {

using Eigen::MatrixXd;

MatrixXd positive_definite(Eigen::Index n) {
  const MatrixXd A = MatrixXd::Random(n, n);
  return A * A.transpose() + MatrixXd::Identity(n, n);
}

TEST(Condensed, LeavesTheSchurComplement) {
  for (const Eigen::Index n : {0, 1, 7, 90})
    for (const Eigen::Index m : {0, 1, 33}) {
      const MatrixXd M = positive_definite(n + m);
      const MatrixXd B = M.bottomLeftCorner(m, n);
      MatrixXd schur = M.bottomRightCorner(m, m);
      if (n > 0) schur -= B * M.topLeftCorner(n, n).inverse() * B.transpose();
      const Condensed condensed(M, n);
      const MatrixXd difference = MatrixXd(condensed.schur_complement()) - schur;
      EXPECT_LT(MatrixXd(difference.triangularView<Eigen::Lower>()).norm(), 1e-11 * (1 + M.norm())) << n << " " << m;
    }
}

TEST(Condensed, SolvesInTwoSteps) {
  constexpr Eigen::Index n = 12, m = 5, k = 3;
  const MatrixXd M = positive_definite(n + m), b = MatrixXd::Random(n + m, k);
  const Condensed condensed(M, n);
  MatrixXd interior = b.topRows(n), boundary = b.bottomRows(m);
  condensed.eliminate(interior, boundary);
  const MatrixXd C = MatrixXd(condensed.schur_complement()).selfadjointView<Eigen::Lower>();
  const MatrixXd u = C.inverse() * boundary;
  condensed.restore(interior, u);
  MatrixXd x(n + m, k);
  x << interior, u;
  EXPECT_LT((M * x - b).norm(), 1e-12 * M.norm());
}

TEST(Condensed, NeedsAPositiveDefiniteInside) {
  MatrixXd M = MatrixXd::Identity(4, 4);
  M(1, 1) = 0;
  EXPECT_THROW(Condensed(M, 2), NumericalError);
  EXPECT_NO_THROW(Condensed(M, 1)) << "what is left may be singular";
}

}  // namespace
}  // namespace fastjoint::linalg
