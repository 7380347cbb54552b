// SPDX-License-Identifier: GPL-3.0-or-later
// Joints that can carry no more: limit loads of level laws, instability of falling ones, and what is said of them.
#include <fmt/format.h>

#include "common/errors.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"
#include "tests/stage3_nonlinear/run_fixture.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::VectorXd;
using test::ground;
using testing::AllOf;
using testing::ElementsAre;
using testing::Eq;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

/// F = x (1.1 - 0.1 x): slope 1.1 - 0.2 x.
std::shared_ptr<const Law> falling() { return test::cubic_law({1.0, 2.0, 3.0}, {1.0, 1.8, 2.4}); }

/// n discs of both plates, each held by a spring of its own, nothing between them: n uncoupled planes with S_ud = k.
test::Lap uncoupled(int n, double k) {
  std::vector<test::Spring> soft{{0, n, 1000}}, stiff;
  for (int j = 0; j < n; ++j) {
    soft.push_back({j, ground, k});
    stiff.push_back({j, ground, 1e9});
  }
  return {test::spring_plate(n, 1, soft), test::spring_plate(n, 0, stiff)};
}

Eigen::Index unstable(const JointEquations& equations, double delta) {
  const VectorXd c = equations.contacts[0].stiffness * VectorXd::Constant(equations.n_unknowns(), delta);
  return SolvedPoint(equations, 1, c).check().unstable;
}

TEST(Instability, CountsEachOfTwoEqualUncoupledFasteners) {
  for (const int n : {1, 2, 3}) {
    const JointEquations equations = make_equations(test::joint_of(uncoupled(n, 0.5), falling()));
    EXPECT_EQ(unstable(equations, 7.9), 0) << n;  // 1.1 - 0.2 x > -0.5
    EXPECT_EQ(unstable(equations, 8.1), n) << n;
  }
}

TEST(Instability, CountsWithFrictionToo) {
  auto lap = uncoupled(2, 0.5);
  std::mt19937 random(3);
  for (auto* plate : {&lap.a, &lap.b}) test::add_friction(*plate, random);
  auto joint = test::joint_of(lap, falling());
  for (const Index fastener : {0, 1}) test::set_friction(joint, fastener, 1e-6);
  const JointEquations equations = make_equations(joint);
  ASSERT_TRUE(equations.has_friction);
  EXPECT_EQ(unstable(equations, 7.9), 0);
  EXPECT_EQ(unstable(equations, 8.1), 2);
}

/// Two fasteners of 30 hold a sheet that nothing else holds; without stiffness behind yield 60 is the limit.
const Members plastic_lap{{"laws", R"({"lin": {"type": "bilinear", "k": 1000, "F_yield": 30, "k_yield": 0}})"}};

class LimitLoad : public Run {
 protected:
  void load(double force, const std::string& increments, const std::string& method) {
    Members members = plastic_lap;
    members["loads"] = fmt::format(R"([{{"external": "a:P", "force": {}}}])", force);
    members["increments"] = increments;
    members["solver"] = fmt::format(R"({{"method": "{}"}})", method);
    test::Lap lap = test::two_fastener_lap();
    for (auto* plate : {&lap.a, &lap.b}) {
      plate->S_dd_error = 1e-3 * plate->S_dd[0].cwiseAbs();
      plate->S_ee_error = 1e-3 * plate->S_ee[0].cwiseAbs();
      plate->S_ed_error = 1e-3 * plate->S_ed[0].cwiseAbs();
    }
    write(members, lap);
  }
};

TEST_F(LimitLoad, IsNamedWithItsFastenersAndHasNoErrorBar) {
  for (const char* method : {"damped newton", "hybridsj"}) {
    load(60, "[0.5, 1]", method);
    log_.str("");
    run();
    EXPECT_THAT(
        log_.str(),
        AllOf(HasSubstr("[limit-load]: "), HasSubstr("joint.json: limit load reached at increment 2 (load factor 1): "),
              HasSubstr(" fastener \"f1\", fastener \"f2\" "), HasSubstr(" plate \"a\" by 1 along x\n")))
        << method;
    EXPECT_THAT(log_.str(), Not(HasSubstr("[free-within-gaps]"))) << method;
    const auto result = this->result();
    const Eigen::MatrixXd error = result["F_error"];
    EXPECT_TRUE(error.row(0).allFinite()) << method;
    EXPECT_TRUE((error.row(1).array() == std::numeric_limits<double>::infinity()).all()) << method;
  }
}

TEST_F(LimitLoad, EndsTheRunWithItsFastenersAndTheLoadThatWasReached) {
  for (const char* method : {"damped newton", "hybridsj"}) {
    load(100, "[0.5, 1]", method);
    EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(
                                    AllOf(HasSubstr("(load factor 1) did not converge"),
                                          HasSubstr("limit load reached: beyond load factor 0."),
                                          HasSubstr("fastener \"f1\", fastener \"f2\" are at their maximum force"))))
        << method;
    EXPECT_THAT(result().load_factor, ElementsAre(0.5));
  }
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(HasSubstr("and load factor 0.6 is an upper bound")));
}

TEST_F(LimitLoad, OfAPeakIsNamedToo) {
  write(overloaded, {test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, ground, 1000}})});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(HasSubstr("limit load reached: beyond load factor 3.0")));
}

/// A law that falls beyond its peak of 1820 rises again far beyond its last point: that carries no load either.
TEST_F(LimitLoad, OfAFallingLawIsNotPassedOnItsSecondRise) {
  for (const char* method : {"damped newton", "hybridsj"})
    for (const double force : {3500.0, 3650.0, 3800.0, 5000.0, 20000.0, 1e6}) {
      write({{"laws", R"({"lin": {"type": "cubic", "delta": [0.05, 0.1, 0.15], "F": [1500, 1800, 1200]}})"},
             {"loads", fmt::format(R"([{{"external": "a:P", "force": {}}}])", force)},
             {"increments", "4"},
             {"solver", fmt::format(R"({{"method": "{}"}})", method)}});
      if (force == 3500) {
        run();
        EXPECT_NEAR(result().F.row(3).sum(), force, 1e-6);
        continue;
      }
      EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(HasSubstr("limit load reached: beyond load factor")))
          << method << ", load " << force;
    }
}

/// Where hybridsj gives up says little of the joint; damped Newton behind it ends where the joint gives way.
TEST_F(LimitLoad, OfThreeFastenersIsNamedWhateverTheSolver) {
  for (const char* method : {"damped newton", "hybridsj"}) {
    write({{"laws", R"({"lin": {"type": "cubic", "delta": [0.03, 0.06, 0.09], "F": [1612, 2303, 1500]}})"},
           {"fasteners", R"([{"id": "1", "between": ["a:1", "b:1"], "law": "lin"},
                             {"id": "2", "between": ["a:2", "b:2"], "law": "lin"},
                             {"id": "3", "between": ["a:3", "b:3"], "law": "lin"}])"},
           {"loads", R"([{"external": "a:P", "force": 7276.5}])"},
           {"solver", fmt::format(R"({{"method": "{}"}})", method)}},
          {test::chain(3, 1, 1e5, {{2, 3, 1e5}}), test::chain(3, 0, 1e5, {{0, ground, 1e5}})});
    EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(HasSubstr("limit load reached: beyond load factor")))
        << method;
    EXPECT_THAT(log_.str(), Not(HasSubstr("[several-solutions]"))) << "nothing is given";
  }
}

/// A sheet that only its level fastener holds, but for rounding of 2e-11: no load goes there.
TEST_F(LimitLoad, RoundingCarriesNothing) {
  Members members = plastic_lap;
  members["fasteners"] = R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"}])";
  const auto b = test::spring_plate(1, 0, {{0, ground, 1000}});
  auto a = test::spring_plate(1, 1, {{0, 1, 1000}, {0, ground, 2e-8}});
  a.unsupported = {"x"};
  write(members, {a, b});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(
                                  AllOf(HasSubstr("increment 1 of 1 (load factor 1) converged, but a sheet is "
                                                  "out of balance by 7.0e-01 of the largest force, allowed "
                                                  "1.0e-08"),
                                        HasSubstr("holds the 0 increments before (complete = 0)"))));
  EXPECT_FALSE(result().complete);
  write(members, {test::spring_plate(1, 1, {{0, 1, 1000}, {0, ground, 1e-14}}), b});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(HasSubstr("limit load reached: beyond load factor 0.3, ")));
}

/// Slip is level too, but no end: the fastener bears behind it.
TEST_F(LimitLoad, IsNotWhereAFastenerSlips) {
  Members members = plastic_lap;
  members["laws"] = R"({"lin": {"type": "four stage", "k_stick": 1000, "F_slip": 10, "slip": 0.1, "k_bearing": 1000,
                                "F_yield": 40, "k_yield": 0}})";
  members["increments"] = R"("events")";
  members["loads"] = R"([{"external": "a:P", "force": 70}])";
  write(members);
  run();
  EXPECT_THAT(log_.str(), Not(HasSubstr("[limit-load]")));
}

TEST_F(LimitLoad, IsNotWhereThePlatesHoldOn) {
  // Plastic fasteners are not open ones: sheets that hold themselves go on beyond.
  Members members = plastic_lap;
  members["fasteners"] = R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"}])";
  write(members,
        {test::spring_plate(1, 1, {{0, 1, 1000}, {0, ground, 50}}), test::spring_plate(1, 0, {{0, ground, 1000}})});
  run();
  EXPECT_EQ(log_.str(), "");
  EXPECT_EQ(result().F(0, 0), 30);
}

/// One level fastener among 150 of many laws: nothing is wrong, and the sums balance.
TEST(LargeJoint, OfMoreThanAHundredNonlinearFastenersBalances) {
  constexpr int n = 150;
  const test::Lap lap{test::chain(n, 1, 1e4, {{n - 1, n, 1e4}}), test::chain(n, 0, 1e4, {{0, ground, 1e4}}), 3000};
  auto joint = test::joint_of(lap, test::power_law(900, 0.6));
  const auto plastic_law = test::bilinear_law(1000, 20, 0);
  const auto cubic = test::cubic_law({0.1, 0.2, 0.3}, {100.0, 180.0, 280.0});
  for (Index j = 0; j < std::ssize(joint.planes); ++j) {
    if (j % 3 == 1) joint.law[j] = plastic_law;
    if (j % 3 == 2) joint.law[j] = cubic;
    joint.clearance[j] = j % 5 == 0 ? 0.01 : 0;
  }
  const JointEquations equations = make_equations(joint);
  const LoadPath path = follow(equations, {0.25, 1, -1, 0.25}, {});
  ASSERT_FALSE(path.failure);
  for (const auto& step : path.steps) {
    EXPECT_LE(step.residual, 1e-10);
    EXPECT_NEAR(step.F.sum(), 3000 * step.load_factor, 1e-6);
    EXPECT_FALSE(step.check.mechanism);
    EXPECT_EQ(step.check.unstable, 0);
    EXPECT_LT(joint_state(joint, equations, step).out_of_balance, 1e-9);
  }
  EXPECT_LT((path.steps[3].F - path.steps[0].F).norm(), 1e-8 * 3000) << "laws without memory";
  EXPECT_EQ((path.steps[1].F.array() == 20).count() > 0, true) << "some yield";
}

/// A law that falls from 10 to 2 and rises again, in parallel with sheets of 1: at a load of 7 there are three
/// solutions.
class ThreeSolutions : public Run {
 protected:
  [[nodiscard]] double force_from(const std::string& initial, const std::string& increments = "[1]") {
    write({{"laws", R"({"lin": {"type": "cubic", "delta": [1, 2, 3], "F": [10, 2, 10]}})"},
           {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"}])"},
           {"loads", R"([{"external": "a:P", "force": 7}])"},
           {"increments", increments},
           {"initial", initial}},
          {test::spring_plate(1, 1, {{0, 1, 1000}, {0, ground, 1}}), test::spring_plate(1, 0, {{0, ground, 1e6}})});
    log_.str("");
    run();
    return result().F(result().F.rows() - 1, 0);
  }
};

TEST_F(ThreeSolutions, AreNotChosenByTheFirstGuess) {
  const double first = force_from(R"("rigid")", "50");
  for (const char* initial : {R"({"linear": 0.3})", R"({"linear": 1})", R"({"linear": 3})", R"("equal")"}) {
    EXPECT_NEAR(force_from(initial), first, 1e-8) << initial;
    EXPECT_THAT(log_.str(), AllOf(HasSubstr("[several-solutions]: "), HasSubstr(" followed from no load\n")))
        << initial;
  }
}

TEST_F(ThreeSolutions, AJumpToAnotherIsSaid) {
  // The law's peak and what the sheets take there end the first branch below a load of 14.
  EXPECT_GT(force_from(R"("rigid")", "[1, 2]"), 10);
  EXPECT_THAT(log_.str(),
              AllOf(HasSubstr("[several-solutions]: "), HasSubstr("; at load factor 2 it could not be followed "),
                    HasSubstr("(\"initial\")\n")));
}

/// Residuals are relative to the load of their own increment.
TEST(LoadPath, SmallIncrementsAreAsExactAsLargeOnes) {
  std::mt19937 random(36);
  const std::vector<double> factors{1e-8, 1e-5, 1e-2, 1, 1e-6};
  for (int i = 0; i < 30; ++i) {
    const JointEquations equations =
        make_equations(test::random_joint(random, {.cubics = true, .clearances = i % 3 == 0}));
    const LoadPath path = follow(equations, factors, {});
    ASSERT_FALSE(path.failure) << "joint " << i;
    for (const auto& step : path.steps) {
      const VectorXd r = equations.residual(contact_state(equations, step.c), step.load_factor);
      const double load = step.load_factor * equations.q.cwiseAbs().maxCoeff();
      if (i % 3 == 0) continue;
      EXPECT_LE(r.cwiseAbs().maxCoeff(), 1e-10 * load) << "joint " << i << " at " << step.load_factor;
      EXPECT_LE(step.residual, 1e-10);
    }
  }
}

}  // namespace
}  // namespace fastjoint::stage3
