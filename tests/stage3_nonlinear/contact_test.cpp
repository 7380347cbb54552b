// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/contact.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;
using test::power_law;

ContactState at(const Contact& contact, double c) { return contact_state({contact}, VectorXd::Constant(1, c)); }

TEST(Contact, MovesFreelyInTheGapAndFollowsTheLawBeyond) {
  const Contact contact{.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50};  // w = 1
  EXPECT_EQ(at(contact, 0.5).F[0], 0);
  EXPECT_DOUBLE_EQ(at(contact, 0.5).delta[0], 0.01);
  EXPECT_EQ(at(contact, 0.5).dF[0], 0);
  EXPECT_DOUBLE_EQ(at(contact, 0.5).ddelta[0], 1.0 / 50);
  EXPECT_DOUBLE_EQ(at(contact, 11).F[0], 10);
  EXPECT_DOUBLE_EQ(at(contact, 11).delta[0], 0.02 + 0.01);
  EXPECT_DOUBLE_EQ(at(contact, 1).delta[0], 0.02);
}

TEST(Contact, IsOdd) {
  const Contact contact{.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50};
  for (const double c : {0.3, 1.0, 1.7, 40.0}) {
    EXPECT_EQ(at(contact, -c).F[0], -at(contact, c).F[0]);
    EXPECT_EQ(at(contact, -c).delta[0], -at(contact, c).delta[0]);
    EXPECT_EQ(at(contact, -c).dF[0], at(contact, c).dF[0]);
    EXPECT_EQ(at(contact, -c).ddelta[0], at(contact, c).ddelta[0]);
  }
}

TEST(Contact, OneSidedStaysOpenOnTheOtherSide) {
  const Contact contact{.law = power_law(100, 1), .gap = 0.02, .stiffness = 50, .one_sided = true};
  EXPECT_EQ(at(contact, -1000).F[0], 0);
  EXPECT_DOUBLE_EQ(at(contact, -1000).delta[0], -20);
  EXPECT_DOUBLE_EQ(at(contact, 3).F[0], 2);
}

TEST(Contact, WithoutGapIsNeverOpen) {
  const Contact contact{.law = power_law(100, 1), .gap = 0, .stiffness = 50};
  EXPECT_EQ(at(contact, 0).dF[0], 1);
  EXPECT_DOUBLE_EQ(at(contact, 0).ddelta[0], 0.01);
}

TEST(Contact, FindsTheCoordinateOfAForce) {
  const std::vector<Contact> contacts{{.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50},
                                      {.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50},
                                      {.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50, .one_sided = true},
                                      {.law = power_law(100, 0.5), .gap = 0.02, .stiffness = 50}};
  const VectorXd c = contact_coordinates(contacts, Eigen::Vector4d(30, -30, -30, 0));
  const ContactState state = contact_state(contacts, c);
  EXPECT_DOUBLE_EQ(state.F[0], 30);
  EXPECT_DOUBLE_EQ(state.F[1], -30);
  EXPECT_EQ(state.F[2], 0) << "a one-sided fastener cannot pull";
  EXPECT_LT(state.delta[2], 0);
  EXPECT_EQ(state.delta[3], 0);
}

}  // namespace
}  // namespace fastjoint::stage3
