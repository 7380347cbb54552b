// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/matrices/inverse.hpp"

#include <gtest/gtest.h>

namespace fastjoint::matrices {
namespace {

using Eigen::MatrixXd;

/// R R^T + I of a random R, shape (n, n).
MatrixXd positive(Eigen::Index n) {
  std::srand(7);  // Eigen's random numbers
  const MatrixXd R = MatrixXd::Random(n, n);
  return R * R.transpose() + MatrixXd::Identity(n, n);
}

TEST(Inverse, TimesTheMatrixIsTheIdentity) {
  for (const Eigen::Index n : {0, 1, 2, 7, 150}) {
    const MatrixXd A = positive(n), inverse = inverse_of_positive(A).value();
    EXPECT_LT((A * inverse - MatrixXd::Identity(n, n)).norm(), 1e-11) << n;
    EXPECT_EQ(inverse, inverse.transpose()) << n;
  }
}

TEST(Inverse, ReadsTheLowerTriangleAlone) {
  const MatrixXd A = positive(5);
  EXPECT_EQ(inverse_of_positive(A.triangularView<Eigen::Lower>()), inverse_of_positive(A));
}

TEST(Inverse, IsEmptyOfAMatrixThatIsNotPositiveDefinite) {
  MatrixXd A = positive(5);
  A(3, 3) = -1;
  EXPECT_FALSE(inverse_of_positive(A));
  EXPECT_FALSE(inverse_of_positive(MatrixXd::Zero(2, 2)));
}

}  // namespace
}  // namespace fastjoint::matrices
