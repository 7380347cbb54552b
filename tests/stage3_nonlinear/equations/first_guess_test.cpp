// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/joint_equations.hpp"

#include <gtest/gtest.h>

#include "stage3_nonlinear/equations/first_guesses.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;

TEST(FirstGuess, AreThoseOfThePaper) {
  const JointEquations equations = make_equations(test::joint_of(test::two_fastener_lap(), test::power_law(100, 0.5)));
  const CondensedSystem& system = *equations.system;
  const VectorXd rigid = guessed_forces(equations, {Guess::rigid, {}}, 2);
  EXPECT_LT((rigid - 2 * equations.q).norm(), 1e-12 * rigid.norm());
  const VectorXd equal = guessed_forces(equations, {Guess::equal, {}}, 2);
  EXPECT_NEAR(equal.sum(), rigid.sum(), 1e-12 * rigid.norm());
  EXPECT_EQ(equal[0], equal[1]);
  const VectorXd linear = guessed_forces(equations, {Guess::linear, 300.0}, 2);
  EXPECT_LT((linear + system.S_ud * linear / 300 - 2 * equations.q).norm(), 1e-12 * rigid.norm());
  const double mean = system.S_ud.diagonal().mean();
  EXPECT_EQ(guessed_forces(equations, {}, 2), guessed_forces(equations, {Guess::linear, mean}, 2)) << "the default";
  const auto guesses = guesses_in_order({Guess::equal, {}});
  ASSERT_EQ(guesses.size(), 3U);
  EXPECT_LT((contact_state(equations, first_guess(equations, guesses[0], 2)).F - equal).norm(), 1e-12 * equal.norm())
      << "the user's comes first";
}

}  // namespace
}  // namespace fastjoint::stage3
