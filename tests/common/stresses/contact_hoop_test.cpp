// SPDX-License-Identifier: GPL-3.0-or-later
// Hoop stress around a hole in an infinite isotropic sheet, whose rigid disc moves by a against it and pushes by
// springs that do not pull, p = K max(a cos(theta - direction) - gap, 0). Waves n >= 2 of pressure without shear make
// sigma_tt = sigma_rr there (Airy's functions r^-n cos n theta and r^(2-n) cos n theta; Timoshenko & Goodier, Theory of
// Elasticity, section 43). The hoop stress less the radial one, of waves 0 and 1 and of loads far away, is smooth: here
// sin(2 theta) + 2 cos(theta).
#include "common/stresses/contact_hoop.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fastjoint::stresses::contact_hoop_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double K = 3, a = 0.7;

double smooth(double theta) { return std::sin(2 * theta) + 2 * std::cos(theta); }

struct Case {
  double direction, gap, start = 0, sweep = rim::full_turn;
};

double pressure(const Case& given, double theta) {
  return K * std::max(a * std::cos(theta - given.direction) - given.gap, 0.0);
}

/// Amounts of the distributions of what contact adds to springs that also pull: means over fine steps of the rim.
VectorXd added(const Case& given, const rim::Harmonics& waves) {
  constexpr int n = 20000;
  VectorXd amounts = VectorXd::Zero(waves.size());
  for (int i = 0; i < n; ++i) {
    const double theta = waves.start + waves.sweep * (i + 0.5) / n;
    amounts += waves.at(theta) * (pressure(given, theta) - K * a * std::cos(theta - given.direction)) / n;
  }
  return amounts;
}

/// Largest errors over the fine points, from `n_steps` points around a whole circle: of the stress of the unit cases,
/// whose pressure has the waves only, at its points, and under contact.
struct Errors {
  double waves = 0, contact = 0;
};
Errors errors(const Case& given, int n_steps, int highest) {
  const rim::Harmonics waves{highest, given.start, given.sweep};
  const Contacts contacts{{{"1", waves, K, 1, 1}}, added(given, waves), VectorXd::Constant(1, given.gap)};
  const Index n = std::lround(n_steps * given.sweep / rim::full_turn) + (waves.is_whole() ? 0 : 1);
  RimHoop at{VectorXd(n), MatrixXd(n, 1)};
  MatrixXd radial(n, 1);
  Errors result;
  for (Index i = 0; i < n; ++i) {
    const double theta = given.start + double(i) * rim::full_turn / n_steps;
    radial(i, 0) = -K * a * std::cos(theta - given.direction) - waves.at(theta).dot(contacts.added);
    at.angle[i] = theta / rim::degree;
    at.hoop(i, 0) = smooth(theta) + radial(i, 0);
    result.waves = std::max(result.waves, std::abs(radial(i, 0) + pressure(given, theta)));
  }
  const RimHoop fine = under_contact(at, radial, VectorXd::Ones(n), contacts, 0);
  EXPECT_EQ(fine.angle.size(), 10 * (waves.is_whole() ? n : n - 1) + (waves.is_whole() ? 0 : 1));
  for (Index i = 0; i < fine.angle.size(); ++i) {
    const double theta = fine.angle[i] * rim::degree;
    result.contact = std::max(result.contact, std::abs(fine.hoop(i, 0) - smooth(theta) + pressure(given, theta)));
  }
  return result;
}

/// The kink is there whatever the waves; cubic interpolation of what is smooth leaves the fourth power of the step.
TEST(ContactHoop, ConvergesWithTheFourthPowerOfTheStep) {
  for (const Case& given : {Case{0.3, 0}, Case{2, 0.2}, Case{-1, -0.3}, Case{0, 0.1, 0, rim::full_turn / 2},
                            Case{0, 0.1, rim::full_turn / 4, rim::full_turn / 4}}) {
    const Errors coarse = errors(given, 36, 16), fine = errors(given, 72, 16);
    EXPECT_GT(fine.waves, 200 * fine.contact);
    // A cubic through equal steps h is off by h^4 / 24 times the fourth derivative at most.
    EXPECT_LT(fine.contact, std::pow(rim::full_turn / 72, 4) / 24 * (16 + 2 + K * a));
    EXPECT_NEAR(std::log2(coarse.contact / fine.contact), 4, 0.3);
    EXPECT_NEAR(errors(given, 72, 8).contact, fine.contact, 0.1 * fine.contact);
  }
}

}  // namespace
}  // namespace fastjoint::stresses::contact_hoop_test
