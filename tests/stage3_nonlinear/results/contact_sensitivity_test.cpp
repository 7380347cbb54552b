// SPDX-License-Identifier: GPL-3.0-or-later
// What the forces and the stiffness of joints depend on whose rims push but do not pull.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "stage3_nonlinear/results/load_stiffness.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/sweep.hpp"

namespace fastjoint::stage3 {
namespace {

/// The same plate with its external, which a force loads, among what is eliminated: a traction on a boundary that moves
/// as one.
PlateModel under_traction(PlateModel plate) {
  const Index e = plate.n_disc_unknowns(), n = plate.n_unknowns();
  std::vector<Index> rest;
  for (Index i = 0; i < n; ++i)
    if (i != e) rest.push_back(i);
  const double S_ee = plate.S(e, e);
  const MatrixXd S = plate.S;
  plate.T = S(rest, {e}) / S_ee;
  plate.S = S(rest, rest) - S(rest, {e}) * S({e}, rest) / S_ee;
  plate.R = MatrixXd::Zero(n - 1, 0);
  plate.C.setConstant(1, 1, 1 / S_ee);
  plate.S_error = MatrixXd::Zero(n - 1, n - 1);
  plate.traction_id = std::exchange(plate.external_id, {});
  plate.traction_axis = std::exchange(plate.external_axis, {});
  return plate;
}

/// Stiffness is that of differences, and a boundary that moves as one has the same under a traction.
TEST_F(ContactJoint, HaveTheStiffnessOfDifferences) {
  constexpr double change = 1e-5;
  int compared = 0;
  for (int i = 0; i < test::scenes(90); ++i) {
    ContactKind its = kind(i);
    if (i % 3 == 2) its.mu = 0.2;
    test::HandMade joint = random_contact_joint(random_, its);
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {1, 1 - change, 1 + change, 1 - change / 2, 1 + change / 2}, test::tight);
    ASSERT_FALSE(path.failure);
    const auto between = [&](std::size_t low, std::size_t high) {
      const PlateState a = joint_state(joint, equations, path.steps[low]).plates[0];
      const PlateState b = joint_state(joint, equations, path.steps[high]).plates[0];
      return (b.Pe[0] - a.Pe[0]) / (b.De[0] - a.De[0]);
    };
    const double stiffness = tangent_stiffness(joint, test::point_of(equations, path.steps[0])).at(0).stiffness;
    if (std::abs(between(1, 2) / between(3, 4) - 1) < 1e-6) {  // no corner is near
      ++compared;
      EXPECT_NEAR(stiffness / between(3, 4), 1, 1e-5) << "joint " << i;
    }
    if (joint.displacement.contains({0, 0}) || its.mu > 0) continue;
    joint.plates[0] = under_traction(joint.plates[0]);
    joint.traction = joint.force;
    const JointEquations others = make_equations(joint);
    const auto other =
        tangent_stiffness(joint, test::point_of(others, follow(others, {1}, test::tight).steps.at(0))).at(0);
    EXPECT_EQ(other.external, "a:P");
    EXPECT_NEAR(other.stiffness / stiffness, 1, 1e-7) << "joint " << i;
  }
  EXPECT_GT(compared, test::scenes(60));
}

/// dF by each gap against central differences of joints solved anew.
TEST_F(ContactJoint, SensitivitiesToGapsAreDifferences) {
  constexpr double step = 1e-6;
  int compared = 0;
  for (int i = 0; i < test::scenes(60); ++i) {
    ContactKind its = kind(i);
    if (i % 3 == 2) its.mu = 0.2;
    test::HandMade joint = random_contact_joint(random_, its);
    const JointEquations equations = make_equations(joint);
    const LoadPath path = follow(equations, {1}, test::tight);
    ASSERT_FALSE(path.failure);
    const test::Sensitivity by =
        test::sensitivity_at(joint_numbers(joint, joint.numbers()), test::point_of(equations, path.steps[0]));
    const MatrixXd& by_gap = by.gap;
    EXPECT_EQ(joint_numbers(joint, joint.numbers()).n_derivatives(), 1 + by.clearance.cols() + by.law.cols() +
                                                                         by.mu.cols() + by.force.cols() +
                                                                         by.displacement.cols() + by_gap.cols());
    ASSERT_EQ(by_gap.cols(), 2 * std::ssize(joint.fasteners));
    for (Index rim = 0; rim < by_gap.cols(); ++rim) {
      const Index n = std::ssize(joint.fasteners);
      double& gap = joint.gap[joint.at(joint.fasteners[rim % n].holes[rim / n])];  // rims stand plate after plate
      const auto at = [&](double change) {
        gap += change;
        const LoadPath changed = follow(make_equations(joint), {1}, test::tight);
        gap -= change;
        return magnitudes(changed.steps.at(0).F, joint.n_directions());
      };
      const VectorXd difference = (at(step) - at(-step)) / (2 * step), finer = (at(step / 2) - at(-step / 2)) / step;
      if ((difference - finer).norm() > 1e-3 * (1 + finer.norm())) continue;  // a corner is near
      ++compared;
      EXPECT_LT((by_gap.col(rim) - finer).norm(), 2e-3 * (1 + finer.norm())) << "joint " << i << ", rim " << rim;
    }
  }
  EXPECT_GT(compared, test::scenes(120));
}

}  // namespace
}  // namespace fastjoint::stage3
