// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "common/matrices/decompositions.hpp"
#include "stage3_nonlinear/equations/solved_point.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::ElementsAre;

VectorXd residual_at(const JointEquations& equations, const VectorXd& c) {
  const ContactState state = contact_state(equations, c);
  return equations.residual(state, 1);
}

TEST(JointEquations, TangentIsTheDerivative) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-3000, 3000);
  for (int i = 0; i < 200; ++i) {
    const auto joint = test::random_joint(
        random, {.cubics = true, .friction = i % 2 == 0, .one_sided = i % 3 == 0, .floating = i % 5 == 0});
    const JointEquations equations = make_equations(joint);
    const VectorXd c = VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return coordinate(random); });
    const MatrixXd J = tangent(*equations.system, contact_state(equations, c));
    for (Index j = 0; j < std::ssize(c); ++j) {
      // Far from a corner the functions are smooth: error of central differences ~ h^2 + eps / h, relative.
      const double h = 1e-5 * std::abs(c[j]);
      const Contact& contact = equations.contacts[j];
      if (std::abs(std::abs(c[j]) - contact.stiffness * contact.law->gap(contact.clearance)) < 2e-2 * std::abs(c[j]))
        continue;
      VectorXd above = c, below = c;
      above[j] += h;
      below[j] -= h;
      const VectorXd difference = (residual_at(equations, above) - residual_at(equations, below)) / (2 * h);
      const double rounding = 1e-15 * residual_at(equations, c).norm() / h;
      EXPECT_LT((difference - J.col(j)).norm(), 1e-6 * J.col(j).norm() + 1e2 * rounding) << "joint " << i;
    }
  }
}

/// K - S_ud > 0 and its inverse, whatever the joint: what the guarantee of damped Newton stands on.
TEST(JointEquations, MetricIsPositiveDefinite) {
  std::mt19937 random(12);
  for (int i = 0; i < 200; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {.floating = i % 3 == 0}));
    MatrixXd W = -equations.system->S_ud;
    for (Index j = 0; j < W.rows(); ++j) W(j, j) += equations.contacts[j].stiffness;
    EXPECT_GT(matrices::symmetric_eigenvalues(W)[0], 0.01 * W.diagonal().minCoeff()) << i;
    const VectorXd f = VectorXd::Random(W.rows());
    EXPECT_LT((W * equations.system->metric_times(f) - f).norm(), 1e-9 * f.norm()) << i;
  }
}

/// W^-1 J, the Hessian behind damped Newton (docs/theory.md, section 8.4), also where all fasteners of a sheet that
/// nothing else holds are open: the small stiffness in the Jacobian sees to that.
TEST(JointEquations, HessianOfTheEnvelopeIsPositiveDefinite) {
  std::mt19937 random(13);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const JointEquations equations =
        make_equations(test::random_joint(random, {.cubics = true, .one_sided = i % 2 == 0, .floating = i % 3 != 0}));
    const double load = equations.q.cwiseAbs().maxCoeff();  // 0 at a floating sheet with one fastener
    const auto problem = root_problem(equations, 1, load > 0 ? load : 1);
    const double size = i % 4 == 0 ? 0 : 10;  // at 0 all are open or begin to bear
    const VectorXd x = size * VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return coordinate(random); });
    const CondensedSystem& system = *equations.system;
    const MatrixXd metric = (MatrixXd(system.K.asDiagonal()) - system.S_ud).inverse();
    const MatrixXd J = problem.jacobian(x), H = metric * J;
    EXPECT_LT((H - H.transpose()).norm(), 1e-10 * H.norm()) << i;
    const VectorXd r = VectorXd::Random(x.size()), y = problem.solve(x, r);
    EXPECT_LT((J * y - r).norm(), 1e-4 * r.norm()) << i;  // the Hessian knows a stiffness of 1e-11 to so much
    // The small stiffness is at least 1e-11 of the reference stiffness; rounding takes a little.
    EXPECT_GT(matrices::symmetric_eigenvalues(H)[0], 1e-12 * metric.norm()) << i;
  }
}

/// Slopes by the inverse of the Hessian, which is taken without friction, and those of the tangent's own factor.
TEST(JointEquations, SlopesByTheHessianAreThoseOfTheTangent) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const JointEquations equations = make_equations(test::random_joint(random, {.cubics = true}));
    const double size = 10 * equations.q.cwiseAbs().maxCoeff();
    const VectorXd c = size * VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return coordinate(random); });
    const auto state = contact_state(equations, c);
    const MatrixXd J = tangent(*equations.system, state), identity = MatrixXd::Identity(J.rows(), J.rows());
    const MatrixXd F = -state.times(identity, &Response::dF) * J.partialPivLu().solve(identity);
    const SolvedPoint point(equations, 1, c);
    EXPECT_LT((point.estimated_slopes().F - F).norm(), 1e-9 * F.norm()) << i;
    const MatrixXd residual = MatrixXd::Random(J.rows(), 2);
    EXPECT_LT((point.slopes(residual).F - F * residual).norm(), 1e-9 * residual.norm()) << i;
  }
}

/// A law that falls has no energy to descend on.
TEST(JointEquations, GradientNeedsLawsThatRise) {
  const auto falling = test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4});
  const JointEquations equations = make_equations(test::joint_of(test::two_fastener_lap(), falling));
  EXPECT_FALSE(root_problem(equations, 1, 1).metric);
}

TEST(JointEquations, ASheetOnOneFastenerStillHasAReferenceStiffness) {
  const auto joint = test::joint_of(
      {test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}}), 10},
      test::linear_law(5));
  EXPECT_GT(make_equations(joint).contacts[0].stiffness, 0);
}

TEST(JointEquations, TellsASheetThatNothingHolds) {
  // Plate b floats: with both fasteners in their gaps nothing holds it, with one closed all is determined.
  auto lap = test::two_fastener_lap();
  lap.a = test::chain(2, 1, 1000, {{1, 2, 1000}, {0, test::ground, 1000}});
  lap.b = test::chain(2, 0, 1000, {});
  auto joint = test::joint_of(lap, test::linear_law(5));
  joint.clearance.assign(joint.n_planes(), 1);
  const JointEquations equations = make_equations(joint);
  const auto open_at = [&](double c0, double c1) {
    return SolvedPoint(equations, 1, Eigen::Vector2d(c0, c1)).check().mechanism;
  };
  ASSERT_TRUE(open_at(0, 0));
  EXPECT_THAT(open_at(0, 0)->open, ElementsAre(0, 1));
  EXPECT_FALSE(open_at(1e5, 0));
  EXPECT_FALSE(open_at(1e5, 1e5));
}

/// F = x (1.1 - 0.1 x) in parallel with plates of 0.5: 1.6 x - 0.1 x^2 rises to x = 8 and falls beyond.
TEST(JointEquations, TellsASolutionPastTheLargestLoad) {
  const test::Lap lap{test::spring_plate(1, 1, {{0, 1, 1000}, {0, test::ground, 0.5}}),
                      test::spring_plate(1, 0, {{0, test::ground, 1e6}}), 1};
  const auto falling = test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4});
  const JointEquations equations = make_equations(test::joint_of(lap, falling));
  const auto unstable_at = [&](double delta) {
    const double c = equations.contacts[0].stiffness * delta;
    return SolvedPoint(equations, 1, VectorXd::Constant(1, c)).check().unstable;
  };
  EXPECT_EQ(unstable_at(7.9), 0);
  EXPECT_EQ(unstable_at(8.1), 1);
  EXPECT_THAT(planes_that_may_snap(equations), ElementsAre(0));
}

}  // namespace
}  // namespace fastjoint::stage3
