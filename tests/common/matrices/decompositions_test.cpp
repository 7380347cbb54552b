// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/matrices/decompositions.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <complex>
#include <limits>
#include <utility>

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

/// Q^T Q = I, and Q Q^T A = A.
TEST(OrthonormalBasis, SpansTheColumns) {
  std::srand(7);
  for (const auto& [m, n] : {std::pair(1, 1), {7, 3}, {150, 150}, {150, 40}, {5, 0}}) {
    const MatrixXd A = MatrixXd::Random(m, n), Q = orthonormal_basis(A);
    ASSERT_EQ(Q.cols(), n);
    EXPECT_LT((Q.transpose() * Q - MatrixXd::Identity(n, n)).norm(), 1e-12) << m;
    EXPECT_LT((Q * (Q.transpose() * A) - A).norm(), 1e-11) << m;
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

TEST(Lu, SolvesAndTellsTheConditionAsEigenDoes) {
  std::srand(9);
  for (const Eigen::Index n : {1, 2, 7, 90}) {
    const MatrixXd A = MatrixXd::Random(n, n), b = MatrixXd::Random(n, 3);
    const Lu lu(A);
    const Eigen::PartialPivLU<MatrixXd> eigen(A);
    EXPECT_LT((A * lu.solve(b) - b).norm(), 1e-10 * b.norm()) << n;
    EXPECT_LT((A.transpose() * lu.solve_transposed(b) - b).norm(), 1e-10 * b.norm()) << n;
    EXPECT_NEAR(lu.rcond() / eigen.rcond(), 1, 0.5) << n << ": two estimates";
    EXPECT_DOUBLE_EQ(lu.norm(), A.cwiseAbs().colwise().sum().maxCoeff());
  }
  EXPECT_EQ(Lu(MatrixXd::Zero(3, 3)).rcond(), 0);
  MatrixXd singular = MatrixXd::Random(4, 4);
  singular.col(2) = singular.col(1);
  EXPECT_LT(Lu(singular).rcond(), 1e-15);
  singular(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(Lu(singular).rcond(), 0);
}

TEST(Decompositions, OfASymmetricMatrixGiveItBackFromItsLowerTriangle) {
  for (const Eigen::Index n : {0, 1, 2, 40}) {
    const MatrixXd A = positive(n) - 3 * MatrixXd::Identity(n, n);
    const auto [values, vectors] = symmetric_eigen(A.triangularView<Eigen::Lower>());
    EXPECT_LT((vectors * values.asDiagonal() * vectors.transpose() - A).norm(), 1e-13 * (1 + A.norm())) << n;
    EXPECT_TRUE(std::ranges::is_sorted(values)) << n;
    EXPECT_LT((symmetric_eigenvalues(A) - values).norm(), 1e-13 * (1 + A.norm())) << n;
    EXPECT_EQ(is_positive_definite(A), (values.array() > 0).all()) << n;
  }
  EXPECT_TRUE(is_positive_definite(positive(5)));
}

TEST(Decompositions, EigenvaluesHaveTheTracesOfTheMatrixAndOfItsSquare) {
  const MatrixXd A = positive(7) * MatrixXd::Random(7, 7);
  const Eigen::VectorXcd values = eigenvalues(A);
  EXPECT_LT(std::abs(values.sum() - A.trace()), 1e-12 * A.norm());
  EXPECT_LT(std::abs(values.array().square().sum() - (A * A).trace()), 1e-12 * A.squaredNorm());
  const Eigen::VectorXcd turning = eigenvalues(Eigen::Matrix2d{{0, -2}, {2, 0}});
  EXPECT_LT((turning.array().square() + 4).abs().maxCoeff(), 1e-14);
  EXPECT_EQ(eigenvalues(MatrixXd(0, 0)).size(), 0);
}

TEST(Decompositions, SingularValuesSolveByLeastSquares) {
  std::srand(7);
  for (const auto& [m, n] : {std::pair{7, 7}, {9, 4}, {4, 9}, {0, 0}}) {
    const MatrixXd A = MatrixXd::Random(m, n), b = MatrixXd::Random(m, 2);
    const SingularValues svd = singular_values(A);
    EXPECT_LT((svd.U * svd.values.asDiagonal() * svd.V.transpose() - A).norm(), 1e-13);
    const MatrixXd x = svd.solve(b, 0);
    EXPECT_LT((A.transpose() * (A * x - b)).norm(), 1e-12) << m << " " << n;
  }
  MatrixXd A = MatrixXd::Random(5, 5);
  A.col(4) = A.col(0) + A.col(1);
  const SingularValues svd = singular_values(A);
  EXPECT_EQ(svd.rank(1e-12), 4);
  EXPECT_LT((A * svd.V.col(4)).norm(), 1e-14);
  EXPECT_LT((svd.V.col(4).transpose() * svd.solve(A, 1e-12)).norm(), 1e-13);
}

TEST(Decompositions, OfWhatIsNoNumberAreNoNumbers) {
  MatrixXd A = positive(4);
  A(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(symmetric_eigenvalues(A).array().isNaN().any());
  EXPECT_TRUE(singular_values(A).values.array().isNaN().any());
}

}  // namespace
}  // namespace fastjoint::matrices
