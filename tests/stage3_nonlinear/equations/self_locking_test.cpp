// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <sstream>

#include "common/errors.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/run.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/result.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// Two fasteners, each of whose friction is held at the other's disc: no sheet does that, a matrix may.
///
/// Sheet a is all but rigid, its friction too, and moved by 1, so that each disc of b, on a spring k to the ground, has
/// F = k D_b + 2 mu F_other and F = K (1 - F / rigid - D_b): F (1 + k/K + k/rigid - 2 mu) = k for both. I - R M is
/// singular at mu = 1/2, the joint's tangent with the fasteners' K = k at mu = 1. Bearing on the other side has no
/// friction.
class Locking : public testing::Test {
 protected:
  static constexpr double k = 1000;
  // The rows of sheet a balance to rounding of `rigid` times the 1 by which it moves. At 1e12 that is 2e-4, of forces
  // of 500 more than the 1e-8 beyond which a run ends; at 1e10 it is a hundredth of it.
  static constexpr double rigid = 1e10;
  static test::Lap lap() {
    test::Lap lap{test::spring_plate(2, 1, {{0, 2, rigid}, {1, 2, rigid}}),
                  test::spring_plate(2, 0, {{0, test::ground, k}, {1, test::ground, k}}), 0};
    for (auto* plate : {&lap.a, &lap.b}) {
      plate->friction_hole = {"1", "1", "2", "2"};
      plate->friction_bearing = {"+x", "-x", "+x", "-x"};
      plate->friction_unit_force = Eigen::Vector4d::Ones();
      plate->friction_resultant = Eigen::Vector4d(0.6, -0.6, 0.6, -0.6);
      plate->R_df = {Eigen::MatrixXd::Zero(2, 4)};
      plate->R_ef = {Eigen::MatrixXd::Zero(plate->n_externals(), 4)};
    }
    lap.a.R_ef = {Eigen::MatrixXd{{-0.6, 0.6, -0.6, 0.6}}};  // what moves it holds its friction
    lap.b.R_df = {Eigen::MatrixXd{{0, 0, 2, 0}, {2, 0, 0, 0}}};
    return lap;
  }

  /// @param law JSON of the fasteners' law.
  void run(double mu, const std::string& law) {
    std::ostringstream fasteners;
    fasteners << R"([{"id": "1", "between": ["a:1", "b:1"], "law": "f", "friction": )" << mu << R"(},
                     {"id": "2", "between": ["a:2", "b:2"], "law": "f", "friction": )"
              << mu << "}]";
    const program::Arguments options{test::write_joint(folder_, lap(),
                                                       {{"laws", "{\"f\": " + law + "}"},
                                                        {"fasteners", fasteners.str()},
                                                        {"loads", R"([{"external": "a:P", "displacement": 1}])"}}),
                                     folder_.path("r.h5"),
                                     "",
                                     false,
                                     {}};
    log_.str("");
    stage3::run(options, out_, log_, timings_);
  }
  [[nodiscard]] double force() const { return test::Result(folder_.path("r.h5")).F(0, 0); }

  test::TemporaryFolder folder_;
  std::ostringstream out_, log_;
  program::Timings timings_;
};

const std::string spring = R"({"type": "linear", "k": 1000})";
/// The same stiffness up to far beyond the forces here: no linear solve does it.
const std::string never_yields = R"({"type": "bilinear", "k": 1000, "F_yield": 1e9, "k_yield": 1000})";

TEST_F(Locking, IsSolvedOnBothSidesOfTheLevelAndSaidBeyondIt) {
  for (const auto& law : {spring, never_yields})
    for (const double mu : {0.1, 0.3, 0.49, 0.499, 0.501, 0.6, 0.9, 0.99}) {
      run(mu, law);
      EXPECT_NEAR(force() * (2 + k / rigid - 2 * mu) / k, 1, 1e-8) << mu;
      const auto said = HasSubstr("[self-locking]: ");
      if (mu < 0.5) {
        EXPECT_THAT(log_.str(), Not(said)) << mu;
      } else {
        EXPECT_THAT(log_.str(), said) << mu;
      }
    }
  run(0.625, spring);
  EXPECT_THAT(log_.str(), HasSubstr("joint.json: at increment 1 (load factor 1), with friction 0.8 times as large "));
}

TEST_F(Locking, BeyondTheTangentsLevelThereIsNoSolutionAndTheMessageNamesTheFriction) {
  // F (2 - 2 mu) = k has no F > 0 for mu > 1, and pulled without friction F (2) = k none below zero.
  for (const auto& law : {spring, never_yields})
    EXPECT_THAT([&] { run(1.25, law); },
                ThrowsMessage<NumericalError>(
                    AllOf(HasSubstr("did not converge from the last increment"), HasSubstr("; the last try ended: no "),
                          HasSubstr("On the sides that bear, with friction 0.4 times as large "
                                    "the joint is self-locking"))));
}

/// The level itself, from the factor on the friction at hand, whatever that is.
TEST_F(Locking, LevelIsTheSingularityOfTheMatrix) {
  for (const double mu : {0.49, 0.51, 0.7, 2.0, 30.0}) {
    auto joint = test::joint_of(lap(), test::linear_law(k));
    for (auto& fastener : joint.fasteners) {
      auto& hole = fastener.holes[1];
      hole.friction.resize(1);
      joint.set_mu(hole, mu);
      hole.friction[0][plus_side] = {2 * hole.disc, 1, 0};  // without a resultant, which would share out the bearing
      hole.friction[0][minus_side] = {2 * hole.disc + 1, 1, 0};
    }
    joint.displacement[{0, 0}] = 1;
    const JointEquations equations = make_equations(joint);
    const auto level = self_locking(equations, Eigen::Vector2d(1, 1));
    EXPECT_EQ(level.has_value(), mu > 0.5) << mu;
    EXPECT_NEAR(level.value_or(0.5 / mu) * mu, 0.5, 1e-6) << mu;
    EXPECT_FALSE(self_locking(equations, Eigen::Vector2d(-1, -1))) << "bearing there has no friction";
  }
}

/// Friction of the paper's distribution helps its own fastener most: I - R M only grows.
TEST(SelfLocking, IsNotMetByCosineFrictionOfAnySize) {
  std::mt19937 random(7);
  for (int i = 0; i < 100; ++i) {
    auto lap = test::two_fastener_lap();
    test::add_friction(lap.a, random);
    test::add_friction(lap.b, random);
    auto joint = test::joint_of(lap, test::power_law(500, 0.7));
    const double mu = std::pow(10, i % 4 - 1);  // 0.1 to 100
    for (const Index fastener : {0, 1}) test::set_friction(joint, fastener, mu);
    const LoadPath path = follow(make_equations(joint), {0.5, 1, -1}, {});
    ASSERT_FALSE(path.failure) << i;
    for (const auto& step : path.steps) EXPECT_FALSE(step.check.locking) << i;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
