// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/gsl_methods.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace fastjoint::stage3 {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::VectorXd;
using testing::HasSubstr;
using testing::ThrowsMessage;

const RootOptions root_options{.tolerance = 1e-12, .max_iterations = 200};

/// Rosenbrock's valley as two equations, root (1, 1).
const RootProblem rosenbrock{
    [](const VectorXd& x) -> VectorXd { return Vector2d(1 - x[0], 10 * (x[1] - x[0] * x[0])); },
    [](const VectorXd& x) -> Eigen::MatrixXd {
      return Matrix2d{{-1, 0}, {-20 * x[0], 10}};
    },
    {}};

class Solves : public testing::TestWithParam<bench::Solver> {};

TEST_P(Solves, FindsTheRootOfRosenbrock) {
  const Root root = GetParam().solve(rosenbrock, Vector2d(-1.2, 1), root_options);
  EXPECT_TRUE(root.converged);
  EXPECT_GT(root.iterations, 0);
  EXPECT_LE(root.residual.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((root.x - Vector2d(1, 1)).norm(), 1e-11);
}

TEST_P(Solves, IsDoneAtTheRoot) {
  const Root root = GetParam().solve(rosenbrock, Vector2d(1, 1), root_options);
  EXPECT_TRUE(root.converged);
  EXPECT_EQ(root.iterations, 0);
}

TEST_P(Solves, StopsAtTheCap) {
  const Root root = GetParam().solve(rosenbrock, Vector2d(-1.2, 1), {.tolerance = 1e-12, .max_iterations = 1});
  EXPECT_FALSE(root.converged);
  EXPECT_EQ(root.ending, Ending::max_iterations);
  EXPECT_EQ(root.iterations, 1);
  EXPECT_TRUE(root.residual.allFinite());
}

TEST_P(Solves, SaysThatThereIsNoRoot) {
  const RootProblem none{[](const VectorXd& x) -> VectorXd { return VectorXd::Constant(1, 1 + x[0] * x[0]); },
                         [](const VectorXd& x) -> Eigen::MatrixXd { return VectorXd::Constant(1, 2 * x[0]); },
                         {}};
  const Root root = GetParam().solve(none, VectorXd::Constant(1, 3), root_options);
  EXPECT_FALSE(root.converged);
  EXPECT_GE(root.residual[0], 1);
}

TEST_P(Solves, StopsWhereTheFunctionHasNoValue) {
  const RootProblem nan{[](const VectorXd& x) -> VectorXd { return VectorXd::Constant(1, std::sqrt(-1 - x[0])); },
                        [](const VectorXd&) -> Eigen::MatrixXd { return VectorXd::Constant(1, 1); },
                        {}};
  const Root root = GetParam().solve(nan, VectorXd::Constant(1, 3), root_options);
  EXPECT_FALSE(root.converged);
  EXPECT_EQ(root.residual[0], std::numeric_limits<double>::infinity());
  EXPECT_EQ(root.ending, Ending::not_finite);
}

TEST_P(Solves, ReportsEveryIterate) {
  std::vector<Root> told;
  RootOptions reporting = root_options;
  reporting.report = [&](const Root& at) { told.push_back(at); };
  const Root root = GetParam().solve(rosenbrock, Vector2d(-1.2, 1), reporting);
  EXPECT_EQ(root.ending, Ending::converged);
  ASSERT_EQ(std::ssize(told), root.iterations + 1);
  EXPECT_EQ(told.front().x, Vector2d(-1.2, 1));
  EXPECT_EQ(told.back().x, root.x);
}

/// The derivative of 0.1 exp(-x) - x, which falls on and on.
TEST(Newton, SaysThatAConvexFunctionHasNoLeastValue) {
  const auto slope = [](double x) { return 0.1 * std::exp(-x); };
  const RootProblem falls{[&](const VectorXd& x) -> VectorXd { return VectorXd::Constant(1, -1 - slope(x[0])); },
                          [&](const VectorXd& x) -> Eigen::MatrixXd { return VectorXd::Constant(1, slope(x[0])); },
                          [](const VectorXd& r) { return r; }};
  const Root root = newton_root(falls, VectorXd::Constant(1, 0), root_options);
  EXPECT_FALSE(root.converged);
  EXPECT_EQ(root.ending, Ending::unbounded);
}

/// Steps of a wrong derivative, which lower the residual by 1e-4 each: it would take 2e5 of them.
TEST(Newton, EndsWhereTheResidualStandsStill) {
  const RootProblem stiff{[](const VectorXd& x) -> VectorXd { return x; },
                          [](const VectorXd&) -> Eigen::MatrixXd { return VectorXd::Constant(1, 1e4); },
                          {}};
  const Root root = newton_root(stiff, VectorXd::Constant(1, 1), root_options);
  EXPECT_FALSE(root.converged);
  EXPECT_EQ(root.ending, Ending::no_progress);
  EXPECT_LT(root.iterations, 30);
}

/// A force that grows as the depth to the power of 1.5 and is 0 at the root, beside one that is solved at once: whole
/// steps alone would take 17.
TEST(Newton, LeavesContactInFewSteps) {
  const RootProblem touching{
      [](const VectorXd& x) -> VectorXd { return Vector2d(std::pow(std::max(x[0], 0.0), 1.5), x[1] - 2 * x[0]); },
      [](const VectorXd& x) -> Eigen::MatrixXd {
        return Matrix2d{{1.5 * std::sqrt(std::max(x[0], 1e-30)), 0}, {-2, 1}};
      },
      {}};
  const Root root = newton_root(touching, Vector2d(1, 1), root_options);
  EXPECT_TRUE(root.converged);
  EXPECT_LE(root.iterations, 6);
}

TEST_P(Solves, LetsExceptionsOut) {
  const RootProblem throwing{
      [](const VectorXd&) -> VectorXd { throw std::runtime_error("from inside"); }, rosenbrock.jacobian, {}};
  EXPECT_THAT([&] { (void)GetParam().solve(throwing, Vector2d(0, 0), root_options); },
              ThrowsMessage<std::runtime_error>(HasSubstr("from inside")));
}

INSTANTIATE_TEST_SUITE_P(Each, Solves, testing::ValuesIn(bench::solvers()), [](const auto& which) {
  std::string name = which.param.name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

}  // namespace
}  // namespace fastjoint::stage3
