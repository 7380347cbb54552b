// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/force_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/matrices/stiffness_error.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double k_a = 1000, k_b = 700, k_law = 400, pull = 0.01;

/// One fastener: a spring k_a from disc to external, which is pulled, and a disc on a spring k_b to the ground.
test::Lap one_fastener() {
  return {test::spring_plate(1, 1, {{0, 1, k_a}}), test::spring_plate(1, 0, {{0, test::ground, k_b}})};
}

/// A degree below, at which all of S is larger by this factor.
void add_degree_below(formats::PlateMatrices& a, double factor) {
  a.p = Eigen::VectorXi::LinSpaced(2, a.p[0] - 1, a.p[0]);
  a.ndof = Eigen::VectorXi::LinSpaced(2, 1, 2);
  for (auto* S : {&a.S_dd, &a.S_ed, &a.S_ee}) S->insert(S->begin(), factor * S->front());
  for (auto* R : {&a.R_df, &a.R_ef, &a.T_d, &a.T_e, &a.C_t}) R->insert(R->begin(), R->front());
}

struct Solution {
  double F;
  std::optional<VectorXd> error;
};

/// Errors of the forces of the first increment, if they are known.
std::optional<VectorXd> errors_of(const test::HandMade& joint, const stage3::JointEquations& equations,
                                  const stage3::LoadPath& path) {
  const stage3::ForceErrors errors(joint, equations);
  if (!errors.are_known()) return std::nullopt;
  const auto& step = path.steps.at(0);
  return errors.at(test::point_of(equations, step), stage3::joint_state(joint, equations, step));
}

Solution solve(const test::Lap& lap, double displacement = pull) {
  auto joint = test::joint_of(lap, test::linear_law(k_law));
  joint.displacement[{0, 0}] = displacement;
  const auto equations = make_equations(joint);
  const auto path = stage3::follow(equations, {1}, {});
  return {path.steps.at(0).F[0], errors_of(joint, equations, path)};
}

/// F = pull / (1/k_a + 1/k_b + 1/k_law), whose change by k_a is (F^2 / pull) dk_a / k_a^2.
TEST(ForceError, OfSpringsInSeries) {
  auto lap = one_fastener();
  add_degree_below(lap.a, 1.02);
  add_degree_below(lap.b, 1.05);
  const auto [F, error] = solve(lap);
  const double more = matrices::extrapolated_error(Eigen::Vector2d(2, 1), Eigen::VectorXi::LinSpaced(2, 7, 8));
  const double change = F * F / pull * (0.02 / k_a + 0.05 / k_b);
  constexpr double with_bound = 1.0307764064044151;  // hypot(1, 1/4): of one spring the bound is the change
  ASSERT_TRUE(error);
  EXPECT_NEAR((*error)[0] / (with_bound * more * change), 1, 1e-9);
}

TEST(ForceError, IsNoneUnderAGivenForceThatOneFastenerCarries) {
  auto lap = one_fastener();
  add_degree_below(lap.a, 1.02);
  add_degree_below(lap.b, 1.05);
  auto joint = test::joint_of(lap, test::linear_law(k_law));
  const auto equations = make_equations(joint);
  const auto path = stage3::follow(equations, {1}, {});
  const auto error = errors_of(joint, equations, path);
  ASSERT_TRUE(error);
  EXPECT_LT((*error)[0], 1e-9 * lap.force);
}

/// A sheet of one degree has the errors of S that its file gives, entry by entry; what the file does not know is not
/// made up.
TEST(ForceError, OfOneDegree) {
  auto lap = one_fastener();
  EXPECT_EQ((*solve(lap).error)[0], 0);  // the file says exact
  lap.b.S_dd_error(0, 0) = 7;
  const auto [F, error] = solve(lap);
  EXPECT_NEAR((*error)[0] / (F * F / pull * 7 / (k_b * k_b)), 1, 1e-9);
  lap.b.S_dd_error(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(solve(lap).error);
}

/// The first order against the forces of slightly stiffer plates, friction and power laws among them: never beyond the
/// bar, which adds all plates and the extrapolation.
TEST(ForceError, CoversTheChangeOfRandomJoints) {
  std::mt19937 random(3);
  const double more = matrices::extrapolated_error(Eigen::Vector2d(2, 1), Eigen::VectorXi::LinSpaced(2, 7, 8));
  for (int trial = 0; trial < 50; ++trial) {
    auto joint = test::random_joint(random, {.friction = trial % 2 == 1, .floating = trial % 3 == 0});
    auto stiffer = joint;
    for (Eigen::Index i = 0; i < std::ssize(joint.plates); ++i) {
      auto& plate = joint.plates[i];
      const MatrixXd S = plate.S;
      const double factor = 1 + 1e-6 * (1 + static_cast<double>(i));
      stiffer.plates[i].S = factor * S;
      plate.degree = 8;
      plate.C.setZero(plate.T.cols(), plate.T.cols());
      plate.lower = {{7, factor * S, plate.R, plate.T, plate.C}};
    }
    const auto equations = make_equations(joint);
    const stage3::PathOptions tight{{}, {.tolerance = 1e-13}};
    const auto path = stage3::follow(equations, {1}, tight);
    const auto other = stage3::follow(make_equations(stiffer), {1}, tight);
    ASSERT_EQ(path.steps.size() + other.steps.size(), 2U) << trial;
    const auto error = errors_of(joint, equations, path);
    ASSERT_TRUE(error);
    const VectorXd change = (other.steps[0].F - path.steps[0].F).cwiseAbs();
    const double rounding = 1e-10 * path.steps[0].F.cwiseAbs().maxCoeff();
    for (Eigen::Index j = 0; j < change.size(); ++j)
      EXPECT_LE(change[j], 1.001 * (*error)[j] / more + rounding) << trial << " " << j;
  }
}

}  // namespace
}  // namespace fastjoint
