// SPDX-License-Identifier: GPL-3.0-or-later
// Joints whose rims push but do not pull: elastic bodies of random stiffness with discs in their holes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "common/matrices/decompositions.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/increments.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/sweep.hpp"

namespace fastjoint::stage3 {
namespace {

TEST_F(ContactJoint, AThousandAreSolvedFromNothingAndHaveOneSolution) {
  Index most = 0;
  for (int i = 0; i < test::scenes(1000); ++i) {
    const test::HandMade joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const double scale = force_scale(equations, 1);
    const RootProblem problem = root_problem(equations, 1, scale);
    const Index n = equations.n_unknowns();
    const VectorXd far = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -10, 10); });
    std::vector<VectorXd> F;
    for (const VectorXd& start : {VectorXd(VectorXd::Zero(n)), far}) {
      const Root root = newton_root(problem, start, {1e-12, 200});
      EXPECT_LT(root.residual.lpNorm<Eigen::Infinity>(), 1e-10) << "joint " << i;
      F.push_back(contact_state(equations, scale * root.x).F);
      if (start.isZero(0)) most = std::max<Index>(most, root.iterations);
    }
    EXPECT_LT((F[0] - F[1]).lpNorm<Eigen::Infinity>(), 1e-8 * scale) << "joint " << i;
  }
  EXPECT_LE(most, 60);
  RecordProperty("most_iterations", static_cast<int>(most));
}

/// The Hessian is the derivative of the gradient, and positive semi-definite.
TEST_F(ContactJoint, HaveAConvexFunction) {
  constexpr double step = 1e-7;
  for (int i = 0; i < 60; ++i) {
    const test::HandMade joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const RootProblem problem = root_problem(equations, 1, 1);
    const Index n = equations.n_unknowns();
    const VectorXd x = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -1, 1); });
    const VectorXd direction = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -1, 1); });
    const auto gradient = [&](const VectorXd& at) { return problem.metric(problem.residual(at)); };
    const auto slope = [&](double side) { return gradient(x + side * step * direction); };
    const VectorXd difference = (slope(1) - slope(-1)) / (2 * step);
    const MatrixXd J = tangent(*equations.system, contact_state(equations, x));
    MatrixXd H(n, n);
    for (Index j = 0; j < n; ++j) H.col(j) = problem.metric(J.col(j));
    EXPECT_LT((H * direction - difference).norm(), 1e-4 * (H * direction).norm()) << "joint " << i;
    EXPECT_LT((H - H.transpose()).norm(), 1e-12 * H.norm());
    EXPECT_GT(matrices::symmetric_eigenvalues(H)[0], -1e-12 * H.norm()) << "joint " << i;
  }
}

TEST_F(ContactJoint, PathsAreFollowedAndUnloadedToWhereTheyBegan) {
  for (int i = 0; i < 60; ++i) {
    const test::HandMade joint = random_contact_joint(random_, kind(i));
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {0.5, 1, -1, 0.5, 0}, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    const double scale = force_scale(equations, 1);
    EXPECT_LT((path.steps[0].F - path.steps[3].F).norm(), 1e-8 * scale) << "joint " << i;
    EXPECT_LT((path.steps[0].rim_F - path.steps[3].rim_F).norm(), 1e-7 * scale) << "joint " << i;
    if (!equations.has_interference()) {
      EXPECT_LT(path.steps[4].F.norm(), 1e-9 * scale) << "joint " << i;
    }
  }
}

/// A load that vanishes beside what gaps would take, or a displacement that takes less than them, balances as any
/// other: fasteners that do not touch carry nothing, exactly.
TEST_F(ContactJoint, AreFollowedWhereLoadsVanishAndNothingTouches) {
  int loose = 0;
  for (int i = 0; i < test::scenes(80); ++i) {
    ContactKind its = kind(i);
    its.gaps = decades(random_, 0.1, 100), its.mu = i % 4 == 0 ? 0.3 : 0;
    test::HandMade joint = random_contact_joint(random_, its);
    if (i % 2 == 0)
      for (auto& fastener : joint.fasteners)
        for (auto& hole : fastener.holes) joint.gap[joint.at(hole)] = std::abs(joint.gap[joint.at(hole)]);
    const JointEquations equations = make_equations(joint);
    const auto [path, increments] =
        follow_with_results(joint, equations, {1e-6, 0.3, 1, 1.2e-16, -1, 1e-3}, {}, {.tolerance = 1e-10});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps) {
      if (!step.rim_F.isZero(0)) continue;
      EXPECT_TRUE(step.F.isZero(0)) << "joint " << i << " at " << step.load_factor << ": " << step.F.transpose();
      ++loose;
    }
  }
  EXPECT_GT(loose, test::scenes(20));
}

/// Friction leaves no convex function. Joints are still solved, whatever the coefficient, and hardly one has other
/// forces when it is solved from far away; none has with small coefficients.
TEST_F(ContactJoint, WithFrictionAreSolvedFromNothingAndFromFarAway) {
  for (const double mu : {0.15, 0.3, 0.6, 1.0, 2.0}) {
    int different = 0;
    for (int i = 0; i < test::scenes(40); ++i) {
      ContactKind its = kind(i);
      its.mu = mu;
      const JointEquations equations = make_equations(random_contact_joint(random_, its));
      const double scale = force_scale(equations, 1);
      const LoadPath path = follow(equations, {1}, {});
      ASSERT_FALSE(path.failure) << "joint " << i << ", friction " << mu;
      const Index n = equations.n_unknowns();
      const VectorXd far = VectorXd::NullaryExpr(n, [&] { return uniform(random_, -10, 10); });
      const Root root = newton_root(root_problem(equations, 1, scale), far, {1e-12, 200});
      const VectorXd F = contact_state(equations, scale * root.x).F;
      different += root.converged &&
                   !((F - contact_state(equations, path.steps[0].c).F).lpNorm<Eigen::Infinity>() < 1e-8 * scale);
    }
    EXPECT_LE(different, mu < 0.5 ? 0 : 1) << mu;
  }
}

TEST_F(ContactJoint, TellWhatEachIterationDoes) {
  std::ostringstream log;
  const JointEquations equations = make_equations(random_contact_joint(random_, {3, 2, false, 1}));
  const LoadPath path = follow(equations, {0.5, 1}, {{}, {.method = Method::damped_newton}, &log});
  ASSERT_EQ(path.steps.size(), 2U);
  const std::string text = log.str();
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != text.npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("  try at load factor 0.5: residual "), 1U) << text;
  EXPECT_EQ(count("  try at load factor 1: residual "), 1U);
  EXPECT_GT(count(", corners passed by "), std::size_t(path.steps[0].iterations + path.steps[1].iterations))
      << "those at no load too, as interference has it";
  EXPECT_EQ(count("    converged\n"), 3U) << "no load too, as interference has it";
}

/// Friction takes few steps more, also where everything is loose at first.
TEST_F(ContactJoint, OfLooseFastenersTakeFewStepsWithFriction) {
  std::vector<int> steps;
  for (int i = 0; i < 100; ++i) {
    ContactKind its = kind(i);
    its.mu = 0.2;
    test::HandMade joint = random_contact_joint(random_, its);
    for (auto& fastener : joint.fasteners)
      for (auto& hole : fastener.holes) joint.gap[joint.at(hole)] = std::abs(joint.gap[joint.at(hole)]);
    const LoadPath path = follow(make_equations(joint), {1}, {{}, {.method = Method::damped_newton}});
    ASSERT_FALSE(path.failure) << "joint " << i;
    steps.push_back(path.steps[0].iterations);
  }
  std::ranges::sort(steps);
  EXPECT_LE(steps[50], 10);
  EXPECT_LE(steps[95], 25);
  EXPECT_LE(steps.back(), 60);
}

/// Laws that end level: a hundredth of a percent below the bound there is a solution, above it there is none.
TEST_F(ContactJoint, HaveTheLimitLoadThatRigidMotionsTell) {
  for (int i = 0; i < test::scenes(60); ++i) {
    ContactKind its = kind(i);
    its.floating = true, its.gaps = 0.01, its.mu = i % 5 == 0 ? 0.2 : 0;
    test::HandMade joint = random_contact_joint(random_, its);
    for (auto& law : joint.law) law = test::bilinear_law(decades(random_, 100, 10000), decades(random_, 0.1, 10), 0);
    const JointEquations equations = make_equations(joint);
    const auto limit = limit_load(equations, 1);
    ASSERT_TRUE(limit) << "joint " << i;
    EXPECT_FALSE(follow(equations, {0.9999 * limit->factor}, {}).failure) << "joint " << i;
    const LoadPath path = follow(equations, {0.5 * limit->factor, 1.0001 * limit->factor}, {});
    ASSERT_TRUE(path.failure) << "joint " << i;
    EXPECT_EQ(path.steps.size(), 1U);
    EXPECT_EQ(path.failure->limit, limit->factor);
    EXPECT_EQ(path.failure->level, limit->planes);
    EXPECT_GT(path.failure->reached, 0.98 * limit->factor);
  }
}

TEST_F(ContactJoint, UnknownsBelongToPlanesAndRims) {
  const JointEquations equations = make_equations(random_contact_joint(random_, {3, 2, false, 1}));
  Index row = 0;
  for (Index plane = 0; plane < 3; ++plane)
    for (Index d = 0; d < 2; ++d) EXPECT_EQ(equations.entry_of(row++), plane);
  for (Index rim = 0; rim < 6; ++rim)
    for (Index i = 0; i < equations.rims[rim]->n_long(); ++i) EXPECT_EQ(equations.entry_of(row++), 3 + rim);
  EXPECT_EQ(row, equations.n_unknowns());
}

TEST_F(ContactJoint, TheTangentKnowsFriction) {
  constexpr double step = 1e-7;
  for (int i = 0; i < 60; ++i) {
    ContactKind its = kind(i);
    its.mu = 0.3;
    const JointEquations equations = make_equations(random_contact_joint(random_, its));
    const RootProblem problem = root_problem(equations, 1, 1);
    const auto random = [&] { return uniform(random_, -1, 1); };
    const VectorXd x = VectorXd::NullaryExpr(equations.n_unknowns(), random);
    const VectorXd direction = VectorXd::NullaryExpr(equations.n_unknowns(), random);
    const VectorXd difference =
        (problem.residual(x + step * direction) - problem.residual(x - step * direction)) / (2 * step);
    const VectorXd slope = tangent(*equations.system, contact_state(equations, x)) * direction;
    EXPECT_LT((slope - difference).norm(), 1e-4 * slope.norm()) << "joint " << i;
  }
}

/// Number of ways in which a joint is unstable at random coordinates, which is that of all eigenvalues of its tangent;
/// none of a mechanism.
std::optional<Index> checked_instability(const JointEquations& equations, std::mt19937& random) {
  const VectorXd c = VectorXd::NullaryExpr(equations.n_unknowns(), [&] { return uniform(random, -1, 1); });
  const SolvedPoint point(equations, 1, c);
  const TangentCheck& check = point.check();
  if (check.mechanism) return std::nullopt;
  const Eigen::VectorXcd values = matrices::eigenvalues(tangent(*equations.system, point.beyond()));
  EXPECT_EQ(check.unstable, (values.real().array() < -1e-10).count());
  return check.unstable;
}

/// Where friction is large a count of eigenvalues tells of instability, unless the symmetric part rules it out.
TEST_F(ContactJoint, AreUnstableWhereTheirTangentHasSuchEigenvalues) {
  int unstable = 0;
  for (int i = 0; i < 200; ++i) {
    ContactKind its = kind(i);
    its.mu = decades(random_, 0.5, 20);
    const JointEquations equations = make_equations(random_contact_joint(random_, its));
    const auto found = checked_instability(equations, random_);
    if (!found) continue;
    if (*found > 0) ++unstable;
  }
  RecordProperty("unstable", unstable);
}

/// Krylov's spaces of large tangents tell whether eigenvalues must be counted; the count is that of all eigenvalues.
TEST_F(ContactJoint, LargeOnesAreUnstableWhereTheirTangentHasSuchEigenvalues) {
  int unstable = 0, stable = 0;
  for (int i = 0; i < test::scenes(16); ++i) {
    ContactKind its{24, 2, i % 2 == 0, decades(random_, 1e-4, 1e2), decades(random_, 0.1, 20), i % 4 < 2};
    const JointEquations equations = make_equations(random_contact_joint(random_, its));
    ASSERT_GT(equations.n_unknowns(), 400);
    const auto found = checked_instability(equations, random_);
    if (!found) continue;
    (*found > 0 ? unstable : stable) += 1;
  }
  EXPECT_GE(unstable, test::scenes(3));
  EXPECT_GE(stable, test::scenes(3));
}

}  // namespace
}  // namespace fastjoint::stage3
