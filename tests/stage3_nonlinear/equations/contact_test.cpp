// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/first_guesses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using test::power_law;

ContactState at(const Contact& contact, double c) { return test::state_of({contact}, VectorXd::Constant(1, c)); }

/// A = 100, n = 1/2: F = 10 at a stretch of 0.01, where c = F + k delta with k = 50 is 10 + 50 (0.02 + 0.01).
const Contact gapped{.law = power_law(100, 0.5), .clearance = 0.02, .stiffness = 50};

TEST(Contact, MovesFreelyInTheGapAndFollowsTheLawBeyond) {
  EXPECT_EQ(at(gapped, 0.5).F[0], 0);
  EXPECT_DOUBLE_EQ(at(gapped, 0.5).delta[0], 0.01);
  EXPECT_EQ(at(gapped, 0.5).along(&Response::dF, 0), 0);
  EXPECT_DOUBLE_EQ(at(gapped, 0.5).along(&Response::ddelta, 0), 1.0 / 50);
  EXPECT_DOUBLE_EQ(at(gapped, 11.5).F[0], 10);
  EXPECT_DOUBLE_EQ(at(gapped, 11.5).delta[0], 0.03);
  EXPECT_DOUBLE_EQ(at(gapped, 1).delta[0], 0.02);
}

TEST(Contact, IsOdd) {
  for (const double c : {0.3, 1.0, 1.7, 40.0}) {
    EXPECT_EQ(at(gapped, -c).F[0], -at(gapped, c).F[0]);
    EXPECT_EQ(at(gapped, -c).delta[0], -at(gapped, c).delta[0]);
    EXPECT_EQ(at(gapped, -c).along(&Response::dF, 0), at(gapped, c).along(&Response::dF, 0));
    EXPECT_EQ(at(gapped, -c).along(&Response::ddelta, 0), at(gapped, c).along(&Response::ddelta, 0));
  }
}

TEST(Contact, OneSidedStaysOpenOnTheOtherSide) {
  const Contact contact{.law = power_law(100, 1), .clearance = 0.02, .stiffness = 50, .one_sided = true};
  EXPECT_EQ(at(contact, -1000).F[0], 0);
  EXPECT_DOUBLE_EQ(at(contact, -1000).delta[0], -20);
  EXPECT_DOUBLE_EQ(at(contact, 4).F[0], 2);
}

TEST(Contact, WithoutGapIsNeverOpen) {
  const Contact contact{.law = power_law(100, 1), .stiffness = 50};
  EXPECT_DOUBLE_EQ(at(contact, 0).along(&Response::dF, 0), 100.0 / 150);
  EXPECT_DOUBLE_EQ(at(contact, 0).along(&Response::ddelta, 0), 1.0 / 150);
}

TEST(Contact, FindsTheCoordinateOfAForce) {
  Contact one_sided = gapped;
  one_sided.one_sided = true;
  const std::vector<Contact> contacts{gapped, gapped, one_sided, gapped};
  const JointEquations equations = test::equations_of(MatrixXd::Identity(4, 4), Eigen::Vector4d::Ones(), contacts);
  const VectorXd c = guessed_coordinates(equations, Eigen::Vector4d(30, -30, -30, 0));
  const ContactState state = contact_state(equations, c);
  EXPECT_DOUBLE_EQ(state.F[0], 30);
  EXPECT_DOUBLE_EQ(state.F[1], -30);
  EXPECT_EQ(state.F[2], 0) << "a one-sided fastener cannot pull";
  EXPECT_LT(state.delta[2], 0);
  EXPECT_EQ(state.delta[3], 0);
}

TEST(Contact, IsRadialInThePlane) {
  // Along any direction the law of one dimension, F and delta along c.
  for (double angle = 0; angle < 6.28; angle += 0.37) {
    const Vector2d e(std::cos(angle), std::sin(angle));
    for (const double c : {0.4, 1.0, 1.2, 11.5, 200.0}) {
      const ContactState state = test::state_of({gapped}, c * e);
      const ContactState line = at(gapped, c);
      EXPECT_LT((state.F - line.F[0] * e).norm(), 1e-12 * c);
      EXPECT_LT((state.delta - line.delta[0] * e).norm(), 1e-14 * c);
      EXPECT_NEAR(magnitudes(state.F, 2)[0], line.F[0], 1e-12 * c);
    }
  }
  EXPECT_EQ(test::state_of({gapped}, Vector2d(0, 0)).F.norm(), 0);
}

/// Order 2 of central differences, the tangent blocks of several planes at once.
TEST(Contact, BlocksAreTheDerivativeInThePlane) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-20, 20);
  const Contact linear{.law = test::linear_law(30), .stiffness = 50};
  const std::vector<Contact> contacts{gapped, linear, gapped};
  const MatrixXd I = MatrixXd::Identity(6, 6);
  for (int i = 0; i < 100; ++i) {
    const VectorXd c = VectorXd::NullaryExpr(6, [&] { return coordinate(random); });
    const ContactState state = test::state_of(contacts, c);
    const MatrixXd dF = state.times(I, &Response::dF), ddelta = state.times(I, &Response::ddelta);
    for (Index j = 0; j < 6; ++j) {
      const Vector2d here = c.segment(j / 2 * 2, 2);
      if (std::abs(here.norm() - 1) < 0.1) continue;  // the corner at contact
      constexpr double h = 1e-5;
      const auto above = test::state_of(contacts, c + h * VectorXd::Unit(6, j));
      const auto below = test::state_of(contacts, c - h * VectorXd::Unit(6, j));
      EXPECT_LT((dF.col(j) - (above.F - below.F) / (2 * h)).norm(), 1e-7);
      EXPECT_LT((ddelta.col(j) - (above.delta - below.delta) / (2 * h)).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace fastjoint::stage3
