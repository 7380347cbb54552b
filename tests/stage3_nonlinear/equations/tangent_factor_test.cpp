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

/// A joint of planes and rims whose wave n reaches the waves m of others by coupling * fade^(n + m), at random.
CondensedSystem fading(std::mt19937& random, double coupling, double fade) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Index r = n_planes + n_rims * size;
  const auto wave = [&](Index i) { return i < n_planes ? 0.0 : double(((i - n_planes) % size + 1) / 2); };
  const auto rim = [&](Index i) { return i < n_planes ? -1 : (i - n_planes) / size; };
  MatrixXd S = MatrixXd::NullaryExpr(r, r, [&](Index i, Index j) {
    const double own = rim(i) == rim(j) ? 0.3 / double(size) : coupling * std::pow(fade, wave(i) + wave(j));
    return (i == j ? 1 : 0) + own * uniform(random);
  });
  CondensedSystem system{.S_ud = 0.5 * (S + S.transpose()), .Q = VectorXd::Zero(r), .rim_sizes = rims};
  set_reference(system, VectorXd::Ones(n_planes));
  return system;
}

/// A state in which every interface has a flexibility of its own, and the rims friction as random as it.
ContactState random_state(const CondensedSystem& system) {
  ContactState state{VectorXd(system.S_ud.rows()), {}, {}, {}, {}, {}};
  for (Index row = 0; row < state.F.size();) {
    const Index n = row < n_planes ? 1 : size;
    const MatrixXd A = MatrixXd::Random(n, n) / double(n), dF = 0.1 * A * A.transpose();
    state.parts.push_back({{VectorXd(n), {}, {}, dF, MatrixXd::Identity(n, n) - dF + 0.1 * A, {}}, row, 0});
    row += n;
  }
  return state;
}

TEST(TangentFactor, SolvesAsTheWholeMatrixDoes) {
  std::mt19937 random(31);
  for (const double fade : {0.0, 0.1, 0.3, 0.6, 0.9}) {
    const CondensedSystem system = fading(random, 0.05, fade);
    const ContactState state = random_state(system);
    const MatrixXd J = tangent(system, state), b = MatrixXd::Random(J.rows(), 3);
    const TangentFactor factor(system, state);
    const MatrixXd x = J.partialPivLu().solve(b), y = J.transpose().partialPivLu().solve(b);
    EXPECT_LT((factor.times(b) - J * b).norm(), 1e-13 * J.norm() * b.norm()) << fade;
    EXPECT_LT((factor.solve(b) - x).norm(), 1e-11 * x.norm()) << fade;
    for (const double wanted : {1e-2, 1e-6})
      EXPECT_LT((J * factor.step(b.col(0), wanted) - b.col(0)).norm(), wanted * b.col(0).norm()) << fade;
    EXPECT_LT((factor.estimate_transposed(b) - y).norm(), 0.1 * y.norm()) << fade;
  }
}

/// The sooner waves fade, the fewer are kept.
TEST(TangentFactor, KeepsTheWavesThatReachFar) {
  std::mt19937 random(32);
  Index before = n_planes - 1;
  for (const double fade : {0.01, 0.3, 0.6, 0.75}) {
    const CondensedSystem system = fading(random, 0.5, fade);
    const Index kept = TangentFactor(system, random_state(system)).n_kept();
    EXPECT_GT(kept, before) << fade;
    before = kept;
  }
  EXPECT_LT(before, n_planes + n_rims * size);
}

/// Two waves that hardly differ: what little they exchange with planes then matters, the corrections do not converge,
/// and the whole matrix is taken.
TEST(TangentFactor, SolvesWhereCorrectionsDoNotConverge) {
  std::mt19937 random(33);
  CondensedSystem system = fading(random, 0.05, 0.1);
  ContactState state = random_state(system);
  MatrixXd& S = system.S_ud;
  const Index last = S.rows() - 1;
  S.bottomRows(2).setZero();
  S.bottomRightCorner(2, 2) << 1, 1, 1, 1 + 1e-6;
  S.bottomLeftCorner(2, n_planes) = MatrixXd::Random(2, n_planes) / 200;
  S.rightCols(2) = S.bottomRows(2).transpose();
  for (auto& part : state.parts) part.dF.setZero(), part.ddelta.setIdentity();
  const MatrixXd J = tangent(system, state);
  const VectorXd b = VectorXd::Random(J.rows()), x = matrices::Lu(J).solve(b);
  const TangentFactor factor(system, state);
  EXPECT_LT(factor.n_kept(), last - 1);
  EXPECT_LT((factor.solve(b) - x).norm(), 1e-10 * x.norm());
}

TEST(TangentFactor, IsSingularWhereTheMatrixIs) {
  std::mt19937 random(34);
  CondensedSystem system = fading(random, 0.05, 0.1);
  ContactState state = random_state(system);
  EXPECT_FALSE(TangentFactor(system, state).is_singular());
  state.parts[1].dF.setZero();  // an open plane to which nothing else gives stiffness
  system.S_ud.row(1).setZero();
  EXPECT_TRUE(TangentFactor(system, state).is_singular());
}

/// Planes that lose force as they move make eigenvalues below 0; one that floats makes one of 0.
TEST(TangentFactor, KnowsWhetherAnOddNumberOfEigenvaluesIsNegative) {
  std::mt19937 random(35);
  for (Index falling = 0; falling < 5; ++falling)
    for (const bool floats : {false, true}) {
      CondensedSystem system = fading(random, 0.05, 0.3);
      ContactState state = random_state(system);
      for (Index i = 0; i < falling; ++i) state.parts[i].dF(0, 0) = -3;
      if (floats) {
        state.parts[5].dF.setZero();
        system.S_ud.row(5).setZero();
        system.S_ud.col(5).setZero();
      }
      const TangentFactor factor(system, state);
      EXPECT_EQ(factor.is_singular(), floats);
      const auto values = matrices::eigenvalues(tangent(system, state));
      const auto n = std::ranges::count_if(values, [](const auto& v) { return v.imag() == 0 && v.real() < -1e-10; });
      EXPECT_EQ(n, falling);
      EXPECT_EQ(factor.is_negative(), n % 2 == 1) << falling << floats;
    }
}

/// A tangent whose one entry is rounding, of either sign.
TEST(TangentFactor, SolvesByLeastSquaresWhereAllIsRounding) {
  for (const double entry : {-1.8e-13, 1.8e-13, 0.0}) {
    const MatrixXd one = MatrixXd::Ones(1, 1);
    const CondensedSystem system{.S_ud = one, .Q = one, .K = VectorXd::Ones(1)};
    const ContactState state{one, {}, {}, {{{one, {}, {}, 0 * one, entry * one, {}}, 0, 0}}, {}, {}};
    const TangentFactor factor(system, state);
    EXPECT_LT(factor.solve_singular(one).norm(), 1e-12) << entry;
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
    const ContactState state = contact_state(equations, c);
    const MatrixXd J = tangent(*equations.system, state);
    const VectorXd b = VectorXd::Random(J.rows()), x = matrices::Lu(J).solve(b);
    EXPECT_LT((TangentFactor(*equations.system, state).solve(b) - x).norm(), 1e-8 * x.norm()) << "joint " << i;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
