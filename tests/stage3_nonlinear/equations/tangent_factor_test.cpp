// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/tangent_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "stage3_nonlinear/equations/joint_equations.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr Index n_planes = 6, n_rims = 5, size = 21;
const std::vector<Index> rims(n_rims, size);

/// A tangent of rims whose wave n reaches the waves m of others by coupling * fade^(n + m), at random.
MatrixXd fading(std::mt19937& random, double coupling, double fade) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Index r = n_planes + n_rims * size;
  const auto wave = [&](Index i) { return i < n_planes ? 0.0 : double(((i - n_planes) % size + 1) / 2); };
  const auto rim = [&](Index i) { return i < n_planes ? -1 : (i - n_planes) / size; };
  return MatrixXd::NullaryExpr(r, r, [&](Index i, Index j) {
    const double own = rim(i) == rim(j) ? 0.3 / double(size) : coupling * std::pow(fade, wave(i) + wave(j));
    return (i == j ? 1 : 0) + own * uniform(random);
  });
}

TEST(TangentFactor, SolvesAsTheWholeMatrixDoes) {
  std::mt19937 random(31);
  for (const double fade : {0.0, 0.1, 0.3, 0.6, 0.9}) {
    const MatrixXd J = fading(random, 0.05, fade), b = MatrixXd::Random(J.rows(), 3);
    const TangentFactor factor(J, rims);
    const MatrixXd x = J.partialPivLu().solve(b), y = J.transpose().partialPivLu().solve(b);
    EXPECT_LT((factor.solve(b) - x).norm(), 1e-12 * x.norm()) << fade;
    EXPECT_LT((factor.solve_transposed(b) - y).norm(), 1e-12 * y.norm()) << fade;
  }
}

/// The sooner waves fade, the fewer are kept; without rims all are.
TEST(TangentFactor, KeepsTheWavesThatReachFar) {
  std::mt19937 random(32);
  Index before = n_planes;
  for (const double fade : {0.01, 0.3, 0.6, 0.75}) {
    const TangentFactor factor(fading(random, 0.05, fade), rims);
    EXPECT_GT(factor.n_kept(), before) << fade;
    before = factor.n_kept();
  }
  EXPECT_LT(before, n_planes + n_rims * size);
  EXPECT_EQ(TangentFactor(fading(random, 0.05, 0.1), {}).n_kept(), n_planes + n_rims * size);
}

/// Two waves that hardly differ: what little they exchange with planes then matters, the corrections do not converge,
/// and the whole matrix is taken.
TEST(TangentFactor, SolvesWhereCorrectionsDoNotConverge) {
  std::mt19937 random(33);
  MatrixXd J = fading(random, 0.05, 0.1);
  const Index last = J.rows() - 1;
  J.bottomRows(2).setZero();
  J.rightCols(2).setZero();
  J.bottomRightCorner(2, 2) << 1, 1, 1, 1 + 1e-6;
  J.bottomLeftCorner(2, n_planes) = MatrixXd::Random(2, n_planes) / 200;
  J.topRightCorner(n_planes, 2) = MatrixXd::Random(n_planes, 2) / 200;
  const VectorXd b = VectorXd::Random(J.rows()), x = matrices::Lu(J).solve(b);
  const TangentFactor factor(J, rims);
  EXPECT_LT(factor.n_kept(), last - 1);
  EXPECT_LT((factor.solve(b) - x).norm(), 1e-10 * x.norm());
}

TEST(TangentFactor, HasNoStretchWhereTheMatrixIsSingular) {
  std::mt19937 random(34);
  MatrixXd J = fading(random, 0.05, 0.1);
  EXPECT_GT(TangentFactor(J, rims).rcond(), 1e-3);
  J.row(1) = J.row(0);
  EXPECT_LT(TangentFactor(J, rims).rcond(), 1e-15);
}

/// A tangent whose one entry is rounding, of either sign.
TEST(TangentFactor, SolvesByLeastSquaresWhereAllIsRounding) {
  for (const double entry : {-1.8e-13, 1.8e-13, 0.0}) {
    const TangentFactor factor(MatrixXd::Constant(1, 1, entry), {});
    EXPECT_LT(factor.solve_singular(MatrixXd::Ones(1, 1)).norm(), 1e-12) << entry;
    EXPECT_NEAR(factor.free_motions().norm(), 1, 1e-12) << entry;
  }
}

/// Tangents of joints in contact, with friction too.
TEST_F(ContactJoint, HaveTangentsThatAreSolvedRimByRim) {
  for (int i = 0; i < 40; ++i) {
    ContactKind its = kind(i);
    its.mu = i % 2 == 0 ? 0 : 0.3;
    const JointEquations equations = make_equations(random_contact_joint(random_, its));
    const VectorXd c = VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return uniform(random_, -1, 1); });
    const MatrixXd J = tangent(*equations.system, contact_state(equations, c));
    const VectorXd b = VectorXd::Random(J.rows()), x = matrices::Lu(J).solve(b);
    EXPECT_LT((TangentFactor(J, equations.system->rim_sizes).solve(b) - x).norm(), 1e-8 * x.norm()) << "joint " << i;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
