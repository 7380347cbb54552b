// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/model/parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "tests/stage3_nonlinear/contact_joints.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/stage3_nonlinear/named_laws.hpp"

namespace fastjoint::stage3 {
namespace {

const PathOptions tight{{}, {.tolerance = 1e-13}};

/// Gives every number of a joint another value, of its size.
void change(test::HandMade& joint, std::mt19937& random) {
  const auto changed = [&](double& number) { number *= uniform(random, 0.7, 1.2); };
  for (auto* numbers : {&joint.force, &joint.traction, &joint.displacement, &joint.gap, &joint.mu})
    for (auto& [at, number] : *numbers) changed(number);
  for (double& clearance : joint.clearance) changed(clearance);
  for (auto& law : joint.law) law = test::power_law(uniform(random, 100, 10000), uniform(random, 0.6, 1));
}

/// A joint that is condensed once takes other numbers, in memory, as if it had been made with them.
void expect_same_with_other_numbers(const test::HandMade& joint, std::mt19937& random, const std::string& where) {
  const auto system = std::make_shared<const CondensedSystem>(condense(joint, joint.numbers().held));
  for (int run = 0; run < 3; ++run) {
    test::HandMade other = joint;
    change(other, random);
    const LoadPath anew = follow(make_equations(other), {0.4, 1}, tight);
    const LoadPath path = follow(make_equations(joint, system, other.numbers()), {0.4, 1}, tight);
    ASSERT_EQ(path.failure.has_value(), anew.failure.has_value()) << where;
    ASSERT_EQ(path.steps.size(), anew.steps.size()) << where;
    for (std::size_t i = 0; i < path.steps.size(); ++i)
      EXPECT_EQ(path.steps[i].F, anew.steps[i].F) << where << " at " << path.steps[i].load_factor;
  }
}

TEST(Parameters, ChangeWhileTheCondensedJointStays) {
  std::mt19937 random(41);
  for (int i = 0; i < 3 * test::n_kinds; ++i) {
    auto joint = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(joint.equations());  // puts the laws in
    expect_same_with_other_numbers(joint.model, random, "joint " + std::to_string(i));
  }
}

TEST_F(ContactJoint, TakeOtherGapsAndFrictionWhileTheCondensedJointStays) {
  for (int i = 0; i < 24; ++i) {
    ContactKind its = kind(i);
    its.mu = i % 2 == 0 ? 0.2 : 0;
    expect_same_with_other_numbers(random_contact_joint(random_, its), random_, "joint " + std::to_string(i));
  }
}

TEST(LoadColumns, OfAHoleActOnTheSideThatTheForcePointsTo) {
  for (const int sense : {1, -1}) {
    EXPECT_EQ(is_active(sense, 5), sense == 1);
    EXPECT_EQ(is_active(sense, -5), sense == -1);
    EXPECT_EQ(is_active(sense, 0, 3), sense == 1) << "what comes";
    EXPECT_EQ(is_active(sense, 0, -3), sense == -1);
  }
  for (const double amount : {5.0, -5.0, 0.0}) EXPECT_TRUE(is_active(0, amount)) << "an edge";
}

/// A spring that yields and keeps what it has yielded: F = k (delta - set), and no more than `most`.
class YieldingSpring : public Interface {
 public:
  YieldingSpring(double k, double most, double reference) : k_(k), most_(most), reference_(reference) {}

  [[nodiscard]] Index size() const override { return 1; }
  [[nodiscard]] Response respond(const VectorXd& c, const History& history) const override {
    const double set = history.empty() ? 0 : history[0].set[0];
    const double elastic = k_ * (c[0] - reference_ * set) / (k_ + reference_);  // of c = F + reference delta
    const bool yields = std::abs(elastic) > most_;
    const double F = std::clamp(elastic, -most_, most_);
    const auto number = [](double value) { return VectorXd::Constant(1, value); };
    const double dF = yields ? 0 : k_ / (k_ + reference_);
    return {number(F), number((c[0] - F) / reference_), {}, number(dF), number((1 - dF) / reference_), MatrixXd(0, 1)};
  }
  [[nodiscard]] History commit(const VectorXd& c, const History& history) const override {
    const Response at = respond(c, history);
    return {Slider{PlaneVector::Constant(1, at.delta[0] - at.F[0] / k_), PlaneVector::Zero(1)}};
  }
  void add_small_stiffness(double small, Response& response) const override {
    response.dF.array() = response.dF.array().max(small);
    response.ddelta = (1 - response.dF.array()) / reference_;
  }
  [[nodiscard]] std::vector<std::vector<Corner>> corners() const override { return {{}}; }
  [[nodiscard]] double position(const VectorXd& c, Index /*entry*/) const override { return c[0]; }
  [[nodiscard]] VectorXd slope(const VectorXd& /*c*/, Index /*entry*/) const override { return VectorXd::Ones(1); }
  [[nodiscard]] VectorXd coordinates(const VectorXd& F) const override { return F; }
  [[nodiscard]] std::vector<Change> changes(const VectorXd& /*c*/, const Response& /*at*/) const override { return {}; }

 private:
  double k_, most_, reference_;
};

/// What an increment leaves behind is there in the next: F + s delta = lambda q beside a spring s of the plates.
TEST(History, GoesFromIncrementToIncrement) {
  constexpr double s = 100, k = 400, most = 30, q = 60;
  JointEquations equations =
      test::equations_of(Eigen::MatrixXd::Constant(1, 1, s), VectorXd::Constant(1, q), {{test::linear_law(k)}});
  equations.interfaces[0].interface = std::make_shared<YieldingSpring>(k, most, equations.contacts[0].stiffness);
  const LoadPath path = follow(equations, {0.5, 1, 0, 1, -1}, tight);
  ASSERT_FALSE(path.failure);
  EXPECT_NEAR(path.steps[0].F[0], 0.5 * q * k / (k + s), 1e-10) << "elastic";
  EXPECT_NEAR(path.steps[1].F[0], most, 1e-10);
  EXPECT_NEAR(path.steps[1].delta[0], (q - most) / s, 1e-12);
  const double set = (q - most) / s - most / k;
  EXPECT_NEAR(path.steps[2].delta[0], set * k / (k + s), 1e-12) << "no load: the spring pushes its set against s";
  EXPECT_NEAR(path.steps[3].F[0], most, 1e-10) << "elastic again, up to where it was";
  EXPECT_NEAR(path.steps[3].delta[0], (q - most) / s, 1e-12);
  EXPECT_NEAR(path.steps[4].F[0], -most, 1e-10);
  ASSERT_EQ(path.history.size(), 1U);
  EXPECT_NEAR(path.history[0][0].set[0], -set, 1e-12) << "as far to the other side";
}

/// Without memory the forces do not know by which loads a joint has come to them.
TEST(LoadsBefore, DoNotChangeTheForcesOfAllLoads) {
  std::mt19937 random(42);
  for (int i = 0; i < 2 * test::n_kinds; ++i) {
    auto named = test::named_joint(random, i % test::n_kinds);
    static_cast<void>(named.equations());
    const test::HandMade& joint = named.model;
    const auto system = std::make_shared<const CondensedSystem>(condense(joint, joint.numbers().held));
    Parameters parameters = joint.numbers();
    const VectorXd end = parameters.load;
    const LoadPath direct = follow(make_equations(joint, system, parameters), {1}, tight);
    parameters.load = VectorXd::NullaryExpr(end.size(), [&](Index at) { return uniform(random, 0.2, 1) * end[at]; });
    const LoadPath first = follow(make_equations(joint, system, parameters), {0.5, 1}, tight);
    if (direct.failure || first.failure) continue;
    parameters.load_before = parameters.load;
    parameters.load = end - parameters.load_before;
    JointEquations equations = make_equations(joint, system, parameters);
    equations.history = first.history;
    PathOptions from_there = tight;
    from_there.start = first.steps.back().c;
    const LoadPath last = follow(equations, {0.3, 1}, from_there);
    if (last.failure) continue;
    const VectorXd &F = last.steps.back().F, &expected = direct.steps[0].F;
    EXPECT_LT((F - expected).norm(), 1e-9 * expected.norm() + 1e-12) << "joint " << i;
    EXPECT_LT(joint_state(joint, equations, last.steps[0]).out_of_balance, 1e-9) << "joint " << i;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
