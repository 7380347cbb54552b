// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/skeleton.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

/// Every row once; unknowns inside cells none.
TEST(Skeleton, HasARowForEachUnknownOnASkeleton) {
  const auto plate = test::make_plate(test::panel(3, 2));
  const plate::Skeleton skeleton(plate.problem);
  for (const int p : {1, 2, 8}) {
    const auto rows = skeleton.rows(plate.problem, p, plate.problem.unknowns.n_prescribed());
    std::vector<int> found(rows.n_skeleton, 0);
    for (const int row : rows.of_unknown)
      if (row >= 0) ++found[row];
    EXPECT_EQ(found, std::vector<int>(found.size(), 1)) << p;
    EXPECT_EQ(rows.n_border, 1 + 6 + 12) << "external, discs, friction cases, no waves";
    // 12 corners and 17 sides of squares with a vertex in the middle of each, 8 rays to the rim of each hole, whose
    // own edges belong to one element; held: left along x, bottom along y, right along x
    const int vertices = 12 + 17 + 6 * 8, edges = 2 * 17 + 6 * 8;
    EXPECT_EQ(rows.n_skeleton, 2 * (vertices + edges * (p - 1)) - (5 + 7 + 5) - (4 + 6 + 4) * (p - 1)) << p;
  }
}

/// The pattern has as many entries as its size says, and a factor has no more than that says.
TEST(Skeleton, KnowsItsSize) {
  const auto plate = test::make_plate(test::panel(4, 3));
  const plate::Skeleton skeleton(plate.problem);
  for (const int p : {1, 3, 6}) {
    const auto rows = skeleton.rows(plate.problem, p, plate.problem.unknowns.n_border());
    const auto size = skeleton.size(rows);
    auto A = skeleton.pattern(rows);
    EXPECT_EQ(size.entries, A.nonZeros());
    for (int column = 0; column < A.cols(); ++column)
      for (Eigen::SparseMatrix<double>::InnerIterator it(A, column); it; ++it)
        it.valueRef() = it.row() == column ? 4.0 * static_cast<double>(A.cols()) : -1;
    const Eigen::MatrixXd L = Eigen::MatrixXd(Eigen::MatrixXd(A).selfadjointView<Eigen::Lower>()).llt().matrixL();
    const auto n_factor = static_cast<double>((L.array() != 0).count());
    EXPECT_LE(n_factor, size.factor) << p;
    EXPECT_GT(n_factor, 0.6 * size.factor) << p << ": blocks are stored whole";
  }
}

}  // namespace
}  // namespace fastjoint
