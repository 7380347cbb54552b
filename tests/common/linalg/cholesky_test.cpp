// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/cholesky.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/errors.hpp"

namespace fastjoint::linalg {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Sparse = Eigen::SparseMatrix<double>;

/// Chain of springs, lower triangle, with \p last on the last diagonal.
Sparse chain(int n, double last) {
  Sparse A(n, n);
  for (int i = 0; i < n; ++i) {
    A.insert(i, i) = i + 1 < n ? 2 : last;
    if (i + 1 < n) A.insert(i + 1, i) = -1;
  }
  A.makeCompressed();
  return A;
}

TEST(Cholesky, SolvesAllRowsAtOnce) {
  for (const int n : {1, 5, 400}) {
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(7, n);
    const Eigen::MatrixXd X = Cholesky(chain(n, 2)).solve(B);
    const Eigen::MatrixXd A = Eigen::MatrixXd(chain(n, 2)).selfadjointView<Eigen::Lower>();
    EXPECT_LT((X * A - B).norm(), 1e-15 * n * n * B.norm());
  }
}

TEST(Cholesky, NothingToSolveIsNoError) {
  EXPECT_EQ(Cholesky(chain(5, 2)).solve(Eigen::MatrixXd(0, 5)).rows(), 0);
  EXPECT_EQ(Cholesky(chain(5, 2), 0).solve(Eigen::MatrixXd(5, 0)).rows(), 5);
}

TEST(Cholesky, NamesTheIndefiniteRow) {
  for (const int row : {0, 20, 49}) {
    Sparse A = chain(50, 2);
    A.coeffRef(row, row) = -4;
    EXPECT_THAT([&] { Cholesky c(A); },
                ThrowsMessage<NumericalError>(HasSubstr(fmt::format("pivot of row {} of 50 is not positive", row))));
  }
}

/// A matrix that CHOLMOD refuses gives no factor to look at: here one without any entry, for which it returns null.
TEST(Cholesky, SaysThatCholmodRefusesAMatrix) {
  Sparse empty(5, 5);
  empty.makeCompressed();
  const auto refusal =
      ThrowsMessage<NumericalError>(HasSubstr("CHOLMOD cannot factorise the stiffness matrix (it is empty"));
  EXPECT_THAT([&] { Cholesky c(empty); }, refusal);
  EXPECT_THAT([&] { (void)elimination_order(empty); }, refusal);
}

TEST(Cholesky, RefusesAMatrixThatIsSingularToWorkingPrecision) {
  const double floats = 1.0 - 1.0 / 50;  // the value at which the chain of 50 is singular
  for (const double above : {0.0, 1e-15}) EXPECT_THROW(Cholesky c(chain(50, floats + above)), NumericalError) << above;
  EXPECT_THAT([&] { Cholesky c(chain(50, floats + 1e-15)); },
              ThrowsMessage<NumericalError>(HasSubstr("singular to working precision")));
  EXPECT_NO_THROW(Cholesky c(chain(50, floats + 1e-11)));
}

/// Rows in other units, or parts of other stiffness, are no reason to call a matrix singular, nor do they hide that it
/// is.
TEST(Cholesky, JudgesAMatrixWhateverTheScaleOfItsRows) {
  constexpr int n = 50;
  const auto scaled = [](double last) {
    Sparse A = chain(n, last);
    for (int j = 0; j < n; ++j)
      for (Sparse::InnerIterator entry(A, j); entry; ++entry)
        entry.valueRef() *= std::pow(10, (static_cast<double>(entry.row() % 5 + j % 5)) * 4 - 16);
    return A;
  };
  const Eigen::MatrixXd A = Eigen::MatrixXd(scaled(2)).selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd x = A.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::VectorXd found = Cholesky(scaled(2)).solve((A * x).transpose()).transpose();
  EXPECT_LT((found - x).cwiseQuotient(x).norm(), 1e-15 * n * n);
  const double floats = 1.0 - 1.0 / n;
  EXPECT_THAT([&] { Cholesky c(scaled(floats + 1e-14)); },
              ThrowsMessage<NumericalError>(HasSubstr("diagonal entry of row 49 of 50")));
  EXPECT_NO_THROW(Cholesky c(scaled(floats + 1e-11)));
}

/// A random symmetric positive definite matrix of few entries.
Eigen::MatrixXd sparse_matrix(int n) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
  A = (A.array().abs() > 0.9).select(A, 0);
  return A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
}

Sparse lower(const Eigen::MatrixXd& A) { return Eigen::MatrixXd(A.triangularView<Eigen::Lower>()).sparseView(); }

/// What is behind the block does not matter, be it indefinite.
TEST(Cholesky, FactorisesALeadingBlock) {
  Eigen::MatrixXd A = sparse_matrix(90);
  A.bottomRightCorner(20, 20) *= -1;
  for (const int n : {0, 1, 40, 70}) {
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(7, n), block = A.topLeftCorner(n, n);
    EXPECT_LE((Cholesky(lower(A), n).solve(B) * block - B).norm(), 1e-11 * A.norm() * B.norm()) << n;
  }
}

/// Right-hand sides that elimination carries from one row on, which leaves supernodes before it aside, beside full
/// ones.
TEST(Cholesky, SolvesForRightHandSidesThatStartAnywhere) {
  for (const int n : {1, 3, 20, 90})
    for (const int first : {0, n / 2, n - 1}) {
      const Eigen::MatrixXd A = sparse_matrix(n);
      Eigen::MatrixXd B = Eigen::MatrixXd::Random(70, n);
      B.leftCols(first).setZero();
      EXPECT_LT((Cholesky(lower(A)).solve(B) * A - B).norm(), 1e-11 * A.norm() * B.norm()) << n << " " << first;
    }
}

/// Rows that start at the first column, within and at the last, and an empty one; more rows than columns.
TEST(Cholesky, ProductsAreThoseOfTheSolutions) {
  for (const int n : {1, 3, 20, 90, 300})
    for (const int m : {0, 1, 7, 120}) {
      const Eigen::MatrixXd A = sparse_matrix(n);
      Eigen::MatrixXd C = Eigen::MatrixXd::Random(m, n);
      C = (C.array().abs() > 0.95).select(C, 0);
      for (int i = 0; i < m; i += 5) C.row(i).setZero();
      const Eigen::MatrixXd all = C * A.inverse() * C.transpose();
      for (const int k : {0, m / 2, m}) {
        const Eigen::MatrixXd products = Cholesky(lower(A)).products(C.sparseView(), k);
        ASSERT_EQ(products.rows(), k);
        EXPECT_LE((products - all.topRows(k)).norm(), 1e-13 * all.norm()) << n << " " << m << " " << k;
      }
    }
}

/// Lower triangle whose first column is full: eliminated first, it fills all others.
Sparse arrow(int n) {
  Sparse A(n, n);
  A.reserve(Eigen::VectorXi::Constant(n, 1) + (n - 1) * Eigen::VectorXi::Unit(n, 0));
  for (int i = 0; i < n; ++i) {
    A.insert(i, i) = n;
    if (i > 0) A.insert(i, 0) = 1;
  }
  A.makeCompressed();
  return A;
}

TEST(Cholesky, RefusesAFactorOfMoreEntriesThanAnIntCounts) {
  constexpr int n = 46400;  // n^2 > 2^31
  EXPECT_THAT([] { Cholesky factor(arrow(n)); }, ThrowsMessage<NumericalError>(HasSubstr("too large for 32-bit")));
}

TEST(EliminationOrder, FillsAnArrowLittle) {
  constexpr int n = 60;  // the full row must come last
  const Sparse A = arrow(n);
  const auto order = elimination_order(A);
  ASSERT_EQ(order.size(), n);
  EXPECT_GE(std::find(order.begin(), order.end(), 0) - order.begin(), n - 2);
  EXPECT_TRUE(elimination_order(Sparse(0, 0)).empty());
}

}  // namespace
}  // namespace fastjoint::linalg
