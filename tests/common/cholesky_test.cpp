// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/cholesky.hpp"

#include <gmock/gmock.h>

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

TEST(Cholesky, SolvesAllColumnsAtOnce) {
  for (const int n : {1, 5, 400}) {
    const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, 7);
    const Eigen::MatrixXd X = Cholesky(chain(n, 2)).solve(B);
    const Eigen::MatrixXd A = Eigen::MatrixXd(chain(n, 2)).selfadjointView<Eigen::Lower>();
    EXPECT_LT((A * X - B).norm(), 1e-15 * n * n * B.norm());
  }
}

TEST(Cholesky, NothingToSolveIsNoError) { EXPECT_EQ(Cholesky(chain(5, 2)).solve(Eigen::MatrixXd(5, 0)).cols(), 0); }

TEST(Cholesky, NamesTheIndefiniteRow) {
  EXPECT_THAT([] { Cholesky c(chain(50, -4.0)); }, ThrowsMessage<NumericalError>(HasSubstr("of 50 is not positive")));
}

TEST(Cholesky, RefusesAMatrixThatIsSingularToWorkingPrecision) {
  const double floats = 1.0 - 1.0 / 50;  // the value at which the chain of 50 is singular
  for (const double above : {0.0, 1e-15}) EXPECT_THROW(Cholesky c(chain(50, floats + above)), NumericalError) << above;
  EXPECT_THAT([&] { Cholesky c(chain(50, floats + 1e-15)); },
              ThrowsMessage<NumericalError>(HasSubstr("singular to working precision")));
  EXPECT_NO_THROW(Cholesky c(chain(50, floats + 1e-11)));
}

TEST(LeadingBlock, IsTheTopLeftCorner) {
  Sparse A = chain(9, 3);
  A.coeffRef(8, 0) = 5;
  A.makeCompressed();
  for (const int n : {0, 1, 4, 9})
    EXPECT_EQ(Eigen::MatrixXd(leading_block(A, n)), Eigen::MatrixXd(A).topLeftCorner(n, n)) << n;
}

}  // namespace
}  // namespace fastjoint::linalg
