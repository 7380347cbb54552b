// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/sensitivity.hpp"
#include "stage3_nonlinear/path/load_path.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/stage3_nonlinear/named_laws.hpp"

namespace fastjoint::stage3::sensitivity_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using test::ground;
using testing::Each;
using testing::ElementsAre;

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Solved {
  LoadPath path;
  JointNumbers numbers;
  std::vector<test::Sensitivity> by;  ///< one per step
};

Solved solved(const test::HandMade& joint, const std::vector<double>& load_factors) {
  const JointEquations equations = make_equations(joint);
  Solved result{follow(equations, load_factors, test::tight), joint_numbers(joint, joint.numbers()), {}};
  for (const auto& step : result.path.steps)
    result.by.push_back(test::sensitivity_at(result.numbers, test::point_of(equations, step)));
  return result;
}

/// Two fasteners K through two chains of flexibility f, the second with a gap g: load_path_test.cpp. Open, F = (P, 0);
/// closed, F_1 - F_2 = g / (1/K + f) and F_1 + F_2 = P.
class TwoFastenerLap : public testing::Test {
 protected:
  static constexpr double K = 2048, f = 1e-3, g = 0.0625, P = 100;
  static test::HandMade joint(double gap = g) {
    auto model = test::joint_of(test::two_fastener_lap(), test::linear_law(K));
    model.clearance[1] = gap;
    return model;
  }
  static constexpr double contact = g / (1 / K + f) / P;  ///< load factor
  /// The state there, on the corner to the last bit.
  static PathStep at_contact(const JointEquations& equations) {
    PathStep at{contact, Vector2d(contact * P, 0), Vector2d(contact * P / K, g), 0, 0, {}};
    at.c = at.F + Vector2d(equations.contacts[0].stiffness, equations.contacts[1].stiffness).cwiseProduct(at.delta);
    return at;
  }
};

TEST_F(TwoFastenerLap, HasItsClosedForm) {
  const Solved a = solved(joint(), {0.5 * contact, 2 * contact, -2 * contact});
  ASSERT_EQ(a.by.size(), 3U);
  EXPECT_THAT(a.numbers.force, ElementsAre("a:P"));
  ASSERT_EQ(a.numbers.law.size(), 1U) << "both planes share it";
  EXPECT_EQ(a.numbers.law[0].second.name, "k");
  EXPECT_LT((a.by[0].load_factor - Vector2d(P, 0)).norm(), 1e-10);
  EXPECT_EQ(a.by[0].clearance.col(1).norm(), 0);
  EXPECT_LT(a.by[0].law.norm(), 1e-14);
  const double by_g = 1 / (1 / K + f) / 2, by_K = g / (2 * std::pow(1 + K * f, 2));
  for (const double sense : {1.0, -1.0}) {
    const test::Sensitivity& by = a.by[sense > 0 ? 1 : 2];
    EXPECT_LT((by.load_factor - Vector2d(P / 2, P / 2)).norm(), 1e-10);
    EXPECT_LT((by.clearance.col(1) - sense * Vector2d(by_g, -by_g)).norm(), 1e-10 * by_g) << "forces have signs";
    EXPECT_LT((by.law.col(0) - sense * Vector2d(by_K, -by_K)).norm(), 1e-10 * by_K);
    EXPECT_LT((by.force.col(0) - sense * 2 * contact * Vector2d(0.5, 0.5)).norm(), 1e-12) << "at load factor 1";
  }
}

TEST_F(TwoFastenerLap, AtFirstContactIsOfTheSideThatBears) {
  // Exact in binary, so that the state is at the corner to the last bit.
  const test::HandMade model = joint();
  const JointEquations equations = make_equations(model);
  const JointNumbers numbers = joint_numbers(model, model.numbers());
  const PathStep at = at_contact(equations);
  const double k = equations.contacts[1].stiffness;
  ASSERT_EQ(contact_state(equations, Vector2d(k, k * g)).F[1], 0);
  const test::Sensitivity by = test::sensitivity_at(numbers, test::point_of(equations, at));
  EXPECT_LT((by.load_factor - Vector2d(P / 2, P / 2)).norm(), 1e-10);
  const double by_g = 1 / (1 / K + f) / 2;
  EXPECT_LT((by.clearance.col(1) - Vector2d(by_g, -by_g)).norm(), 1e-10 * by_g);
}

TEST_F(TwoFastenerLap, SaysTheSameWithPowerAndCubicLawsAtFirstContact) {
  // A power law is rigid there: F_2 grows as if its fastener had no flexibility, g = P* (1/K + f) - F_2 (1/K + 2 f).
  test::HandMade model = joint();
  for (const auto& [law, flexibility] : std::vector<std::pair<std::shared_ptr<const Law>, double>>{
           {test::power_law(300, 0.5), 0.0}, {test::cubic_law({1.0, 2.0, 3.0}, {64.0, 128.0, 192.0}), 1 / 64.0}}) {
    model.law[1] = law;
    model.planes[1].law_name = "other";
    const JointEquations equations = make_equations(model);
    const PathStep at = at_contact(equations);
    const test::Sensitivity by =
        test::sensitivity_at(joint_numbers(model, model.numbers()), test::point_of(equations, at));
    EXPECT_NEAR(by.clearance(1, 1) * (1 / K + 2 * f + flexibility), -1, 1e-12);
    EXPECT_NEAR(by.load_factor[1] * (1 / K + 2 * f + flexibility), P * (1 / K + f), 1e-9);
    EXPECT_TRUE(by.law.allFinite());
  }
}

TEST_F(TwoFastenerLap, WithoutLoadAClearanceChangesNothing) {
  const Solved a = solved(joint(0), {0});
  EXPECT_LT((a.by[0].load_factor - Vector2d(P / 2, P / 2)).norm(), 1e-10);
  EXPECT_EQ(a.by[0].clearance.norm() + a.by[0].law.norm() + a.by[0].force.norm(), 0);
}

TEST(JointNumbers, HaveAColumnForEachDerivative) {
  std::mt19937 random(74);
  for (int i = 0; i < 30; ++i) {
    auto joint = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(joint.equations());
    const Solved a = solved(joint.model, {0});
    const test::Sensitivity& by = a.by.at(0);
    EXPECT_EQ(a.numbers.n_derivatives(), by.load_factor.cols() + by.clearance.cols() + by.law.cols() + by.mu.cols() +
                                             by.force.cols() + by.displacement.cols() + by.gap.cols());
  }
}

double largest(const VectorXd& v) { return v.cwiseAbs().maxCoeff(); }

/// Only load factor times load acts, of any law, with friction too.
TEST(Sensitivity, ByTheLoadFactorIsBecauseOfTheLoads) {
  std::mt19937 random(72);
  for (int i = 0; i < 100; ++i) {
    auto joint = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(joint.equations());
    const Solved a = solved(joint.model, {joint.load_factor});
    if (a.path.failure || a.path.steps[0].check.mechanism) continue;
    VectorXd sum = VectorXd::Zero(joint.model.n_planes());
    Index force = 0, displacement = 0;
    const Parameters numbers = joint.model.numbers();
    for (Index i_load = 0; i_load < numbers.load.size(); ++i_load)
      sum += numbers.load[i_load] *
             (numbers.held.displaced[i_load] ? a.by[0].displacement.col(displacement++) : a.by[0].force.col(force++));
    const VectorXd by = joint.load_factor * a.by[0].load_factor;
    EXPECT_LT(largest(sum - by), 1e-9 * largest(by)) << "joint " << i;
  }
}

/// Plates know no scale: forces and lengths times s, with all numbers of the laws in their units, give s times the
/// forces. Euler: sum of power * number * dF/dnumber = F.
TEST(Sensitivity, FollowsTheUnits) {
  std::mt19937 random(73);
  int joints = 0;
  for (int i = 0; i < 300; ++i) {
    auto joint = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(joint.equations());
    const auto is_cubic = [&](const ShearPlane& plane) { return joint.laws.at(plane.law_name).type == "cubic"; };
    // Their displacements are no parameters.
    if (std::any_of(joint.model.planes.begin(), joint.model.planes.end(), is_cubic)) continue;
    const Solved a = solved(joint.model, {joint.load_factor});
    if (a.path.failure || a.path.steps[0].check.mechanism) continue;
    ++joints;
    const test::Sensitivity& by = a.by[0];
    VectorXd sum = joint.load_factor * by.load_factor;
    for (Index j = 0; j < std::ssize(joint.model.planes); ++j) sum += joint.model.clearance[j] * by.clearance.col(j);
    for (Index l = 0; l < std::ssize(a.numbers.law); ++l) {
      const auto& [law, number] = a.numbers.law[l];
      sum += (number.length + number.force) * joint.laws.at(law).number(number.name) * by.law.col(l);
    }
    const VectorXd F = magnitudes(a.path.steps[0].F, joint.model.n_directions());
    EXPECT_LT(largest(sum - F), 1e-8 * largest(F)) << "joint " << i << " of " << F.size();
  }
  EXPECT_GT(joints, 60);
}

/// Linear laws without gaps: F is proportional to a load that keeps its sense, friction and all, also without load.
TEST(Sensitivity, OfLinearJointsIsTheirForces) {
  std::mt19937 random(74);
  for (int i = 0; i < 100; ++i) {
    auto joint = test::random_joint(random, {.least_n = 1, .clearances = false, .friction = true});
    const Solved a = solved(joint, {1, -0.7, 0});
    ASSERT_FALSE(a.path.failure);
    const double scale = largest(a.path.steps[0].F);
    EXPECT_LT(largest(a.by[0].load_factor - a.path.steps[0].F), 1e-9 * scale) << "joint " << i;
    EXPECT_LT(largest(-0.7 * a.by[1].load_factor - a.path.steps[1].F), 1e-9 * scale) << "joint " << i;
    EXPECT_LT(largest(a.by[2].load_factor - a.path.steps[0].F), 1e-9 * scale) << "joint " << i;
  }
}

TEST(Sensitivity, WithoutLoadAmountsGrowInAnyDirection) {
  std::mt19937 random(75);
  auto joint = test::named_joint(random, 6);
  for (auto& [name, law] : joint.laws) law = {"linear", {{"k", 1000}}};
  joint.model.clearance.assign(joint.model.n_planes(), 0);
  static_cast<void>(joint.equations());
  const Solved a = solved(joint.model, {0, 1});
  EXPECT_LT(largest(a.by[0].load_factor - magnitudes(a.path.steps[1].F, 2)), 1e-10 * largest(a.path.steps[1].F));
}

/// A doubler b that its gaps leave free, on a lap of a and c: load_path_test.cpp.
class FreeDoubler : public testing::Test {
 protected:
  static test::HandMade joint(bool doubler) {
    const test::Lap lap{test::chain(2, 1, 2000, {{1, 2, 1000}, {0, ground, 500}}),
                        test::chain(2, 0, 1000, {{0, ground, 1000}}), 100};
    auto model = test::joint_of(lap, test::power_law(300, 0.8));
    if (!doubler) return model;
    model.plates.push_back(make_plate("d", "d.h5", test::chain(2, 1, 1000, {{1, 2, 700}}), 8));
    for (Index j = 0; j < 2; ++j) {
      test::add_fastener(model, {{0, j}, {2, j}}, test::linear_law(500));
      model.clearance.back() = 10;
      model.planes.back().law_name = "loose";
    }
    return model;
  }
};

TEST_F(FreeDoubler, LeavesTheForcesOfTheOthers) {
  const Solved with = solved(joint(true), {1}), without = solved(joint(false), {1});
  ASSERT_TRUE(with.path.steps.at(0).check.mechanism);
  EXPECT_LT(largest(with.by[0].load_factor.head(2) - without.by[0].load_factor), 1e-8 * 100);
  EXPECT_LT((with.by[0].clearance.topLeftCorner(2, 2) - without.by[0].clearance).norm(),
            1e-8 * without.by[0].clearance.norm());
  EXPECT_LT((with.by[0].law.topLeftCorner(2, 3) - without.by[0].law).norm(), 1e-8 * without.by[0].law.norm());
  EXPECT_EQ(with.by[0].load_factor.tail(2).norm() + with.by[0].clearance.rightCols(2).norm(), 0);
}

TEST_F(FreeDoubler, WouldFlyUnderALoadOfItsOwn) {
  const Solved a = solved(joint(true), {1});
  ASSERT_THAT(a.numbers.force, ElementsAre("a:P", "d:P"));
  EXPECT_TRUE(a.by[0].force.col(0).allFinite());
  EXPECT_THAT(a.by[0].force.col(1), Each(infinity));
}

/// Force-controlled, the peak of a law is a limit point.
TEST(Sensitivity, AtALimitPointIsInfinite) {
  // One plate alone on the ground, whose stiffness takes back all that the law gains.
  const auto law = test::cubic_law({1.0, 2.0, 4.0}, {3.0, 4.0, 0.001});
  ASSERT_FALSE(law->rises());
  constexpr double delta = 3;
  const Branch on = law->at(delta, 1, 0);
  ASSERT_LT(on.dF, 0);
  const test::Lap lap{test::spring_plate(1, 1, {{0, ground, -2 * on.dF}, {0, 1, 1e3}}),
                      test::spring_plate(1, 0, {{0, ground, -2 * on.dF}}), 4};
  const test::HandMade joint = test::joint_of(lap, law);
  const JointEquations equations = make_equations(joint);
  ASSERT_NEAR(equations.system->S_ud(0, 0), -on.dF, 1e-12) << "two equal springs in series";
  const SolvedPoint point(equations, 1, VectorXd::Constant(1, equations.contacts[0].stiffness * delta));
  const test::Sensitivity by = test::sensitivity_at(joint_numbers(joint, joint.numbers()), point);
  EXPECT_THAT(by.load_factor, ElementsAre(infinity));
  EXPECT_EQ(by.law(0, 0), infinity);
}

}  // namespace
}  // namespace fastjoint::stage3::sensitivity_test
