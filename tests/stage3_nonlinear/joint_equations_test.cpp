// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/joint_equations.hpp"

#include <gmock/gmock.h>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::ElementsAre;
using testing::IsEmpty;

VectorXd residual_at(const JointEquations& equations, const VectorXd& c) {
  const ContactState state = contact_state(equations.contacts, c);
  return equations.system.residual(state.F, state.delta, 1);
}

TEST(JointEquations, TangentIsTheDerivative) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> coordinate(-3000, 3000);
  for (int i = 0; i < 200; ++i) {
    const auto joint = test::random_joint(
        random, {.cubics = true, .friction = i % 2 == 0, .one_sided = i % 3 == 0, .floating = i % 5 == 0});
    const JointEquations equations = make_equations(joint);
    const VectorXd c = VectorXd::NullaryExpr(equations.n_fasteners(), [&] { return coordinate(random); });
    const MatrixXd J = tangent(equations.system, contact_state(equations.contacts, c));
    for (Index j = 0; j < c.size(); ++j) {
      // Far from a kink the functions are smooth: error of central differences ~ h^2 + eps / h, relative.
      const double h = 1e-5 * std::abs(c[j]);
      const Contact& contact = equations.contacts[static_cast<std::size_t>(j)];
      if (std::abs(std::abs(c[j]) - contact.stiffness * contact.gap) < 2e-2 * std::abs(c[j])) continue;
      VectorXd above = c, below = c;
      above[j] += h;
      below[j] -= h;
      const VectorXd difference = (residual_at(equations, above) - residual_at(equations, below)) / (2 * h);
      const double rounding = 1e-15 * residual_at(equations, c).norm() / h;
      EXPECT_LT((difference - J.col(j)).norm(), 1e-6 * J.col(j).norm() + 1e2 * rounding) << "joint " << i;
    }
  }
}

TEST(JointEquations, ReferenceStiffnessIsThatOfThePlates) {
  const auto lap = test::two_fastener_lap();
  const JointEquations equations = make_equations(test::joint_of(lap, test::linear_law(5)));
  for (Index j = 0; j < 2; ++j)
    EXPECT_EQ(equations.contacts[static_cast<std::size_t>(j)].stiffness, equations.system.S_ud(j, j));
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
  for (auto& fastener : joint.fasteners) fastener.gap = 1;
  const JointEquations equations = make_equations(joint);
  const auto open_at = [&](double c0, double c1) {
    return undetermined(equations.system, contact_state(equations.contacts, Eigen::Vector2d(c0, c1)));
  };
  EXPECT_THAT(open_at(0, 0), ElementsAre(0, 1));
  EXPECT_THAT(open_at(1e5, 0), IsEmpty());
  EXPECT_THAT(open_at(1e5, 1e5), IsEmpty());
}

}  // namespace
}  // namespace fastjoint::stage3
