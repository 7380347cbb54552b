// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says if it does not converge, or if its results are to be doubted.
#include <fmt/format.h>

#include <array>

#include "common/errors.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "tests/stage3_nonlinear/run_fixture.hpp"
#include "tests/support/warning.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::ThrowsMessage;

TEST_F(Run, KeepsWhatConvergedAndSaysWhatToCheck) {
  write(overloaded, {test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}})});
  EXPECT_THAT(
      [&] { run(); },
      ThrowsMessage<NumericalError>(AllOf(
          HasSubstr("joint.json: limit load reached: beyond load factor 3.0"),
          HasSubstr(", the last that converged, the laws of fastener \"left bolt\" are at their maximum force; "
                    "increment 3 of 4 (load factor "
                    "3.5) did not converge. "),
          HasSubstr(
              "result.h5 holds the 2 increments before (complete = 0). Take smaller loads or displacements, or more "
              "or stronger fasteners; a joint without these shows the load of the others after their failure"))));
  EXPECT_FALSE(result().complete);
  EXPECT_THAT(result().load_factor, ElementsAre(1, 2));
  EXPECT_THAT(out_.str(), HasSubstr("increment 2 of 4"));
  EXPECT_THAT(test::read_file(csv_), HasSubstr("\n2,2,left bolt,"));
}

TEST_F(Run, SaysThatAFastenerHasFailed) {
  // Sheets that hold themselves balance without their fastener: each try finds it far out, where its cubic is negative.
  Members members = overloaded;
  members["increments"] = "[1, 40]";
  write(members, {test::spring_plate(1, 1, {{0, 1, 1000}, {0, test::ground, 1}}),
                  test::spring_plate(1, 0, {{0, test::ground, 1000}})});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(
                                  HasSubstr("limit load reached: beyond load factor 10.75, the last that converged, "
                                            "the laws of fastener \"left bolt\" are at their maximum force")));
  EXPECT_THAT(result().load_factor, ElementsAre(1));
}

TEST_F(Run, WritesAnEmptyHistoryIfNothingConverged) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.4, "delta0": 0.01}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 0.02}])"},
         {"solver", R"({"max_iterations": 1, "tolerance": 1e-14})"}});
  EXPECT_THAT([&] { run(); }, ThrowsMessage<NumericalError>(AllOf(
                                  HasSubstr("increment 1 of 1"),
                                  HasSubstr("Check the law, the gap and the clearance of the fastener there, take "
                                            "smaller increments, allow more than 1 "
                                            "iteration or, if the residual is close to "
                                            "it, a larger tolerance than 1e-14; and see "
                                            "that each plate is fixed in the direction of "
                                            "its load: one without supports has no "
                                            "stiffness while all its fasteners are open, "
                                            "and one-sided fasteners cannot pull it"),
                                  HasSubstr("holds the 0 increments before"))));
  EXPECT_FALSE(result().complete);
  EXPECT_EQ(result().load_factor.size(), 0);
  EXPECT_EQ(result().F.cols(), 2);
}

TEST_F(Run, WarnsBeyondTheLastPointOfACubic) {
  // Two carry 1 each at delta = 1; then 2.6 each, which the last point 2.4 does not cover: x (1.4 - 0.5 x +
  // 0.1 x^2).
  write({{"laws", R"({"six": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.6, 2.4]}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "six"},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "six", "clearance": 0.001}])"},
         {"loads", R"([{"external": "a:P", "force": 2}])"},
         {"increments", "[1, 2.6, 3]"}});
  run();
  EXPECT_THAT(log_.str(),
              AllOf(StartsWith("stage3_nonlinear: warning [beyond-last-point]: "),
                    HasSubstr("joint.json: fastener \"f1\": delta = 3.171"), HasSubstr("increment 2 (load factor 2.6)"),
                    HasSubstr("last point 3 of its law"), EndsWith(" (1 more of this kind, this is the worst)\n")));
  EXPECT_THAT(log_.str(), Not(HasSubstr("fastener \"f2\""))) << "of a kind only the worst is named";
  EXPECT_THAT(log_.str(), Not(HasSubstr("(load factor 3)"))) << "once is enough";
}

TEST_F(Run, WarnsOfDoubtfulLawsAndOpenPlaces) {
  write({{"laws", R"({"lin": {"type": "power", "A": 300, "n": 0.3}})"},
         {"fasteners", R"([{"id": "f1", "between": ["a:1", "b:1"], "law": "lin", "clearance": 1},
                           {"id": "f2", "between": ["a:2", "b:2"], "law": "lin", "clearance": 1}])"}},
        {test::chain(2, 1, 2000, {{1, 2, 1000}, {0, test::ground, 1000}}), test::chain(2, 0, 1000, {})});
  run();
  EXPECT_THAT(log_.str(), AllOf(HasSubstr("[exponent-low]: "), HasSubstr("joint.json: /laws/lin: n = 0.3 ")));
  EXPECT_THAT(log_.str(),
              AllOf(HasSubstr("[free-within-gaps]: "), HasSubstr("joint.json: at increment 1 (load factor 1)"),
                    HasSubstr(" fastener \"f1\", fastener \"f2\": "), HasSubstr("plate \"b\" by 1 along x\n")));
  EXPECT_THAT(out_.str(), HasSubstr("         -\n")) << "no sum, no shares";
}

const Members by_formula{{"laws", R"({"lin": {"type": "formula", "formula": "swift", "mode": "total", "shear": "single",
                                               "t": [2, 3], "E": [72000, 72000], "d": 5, "E_f": 110000}})"}};

TEST_F(Run, PrintsWhereAStiffnessComesFrom) {
  write(by_formula);
  run();
  EXPECT_THAT(out_.str(), HasSubstr("law lin: swift in single shear, total: "));
  EXPECT_THAT(out_.str(), HasSubstr("flexibility 1.83502e-05, of which "));
  EXPECT_EQ(log_.str(), "") << "matrices made by hand say nothing of springs";
}

TEST_F(Run, WarnsOfBearingThatCountsTwice) {
  auto lap = test::two_fastener_lap();
  lap.b.disc_modulus = Eigen::Vector2d(0, 3e7);
  write(by_formula, lap);
  run();
  EXPECT_THAT(log_.str(), AllOf(HasSubstr("[bearing-twice]: "), HasSubstr("joint.json: /laws/lin: mode \"total\""),
                                HasSubstr("hole \"b:2\""), HasSubstr("take \"fastener only\"\n")));
  Members members = by_formula;
  members["laws"].replace(members["laws"].find("total"), 5, "fastener only");
  write(members, lap);
  log_.str("");
  run();
  EXPECT_EQ(log_.str(), "");
}

TEST_F(Run, WarnsWhereTheSolutionMayBeOneOfSeveral) {
  Members members = overloaded;
  members["increments"] = "[1, 2]";
  const test::Lap soft{test::spring_plate(1, 1, {{0, 1, 1000}}), test::spring_plate(1, 0, {{0, test::ground, 1000}})};
  write(members, soft);
  run();
  EXPECT_THAT(log_.str(), AllOf(HasSubstr("[several-solutions]: "),
                                HasSubstr("joint.json: the law of fastener \"left bolt\" falls"),
                                HasSubstr("; the one given is followed from no load\n")));
  // Plates that hold themselves with more than the law's steepest fall, 1.21 per length, leave one solution.
  members["laws"] = R"({"weak": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.8, 2.4]}})";
  write(members, {test::spring_plate(1, 1, {{0, 1, 1000}, {0, test::ground, 100}}), soft.b});
  log_.str("");
  run();
  EXPECT_EQ(log_.str(), "");
}

/// Two bolts that share 100: F = 50 each.
struct Unloading {
  const char* name;
  const char* law;
  const char* increments;
  const char* warned;  ///< of its warning, empty if there is none
};
class UnloadingOf : public Run, public testing::WithParamInterface<Unloading> {};

TEST_P(UnloadingOf, IsSaidWhereTheLawHasNoMemoryOfWhatHappened) {
  write({{"laws", fmt::format(R"({{"lin": {}}})", GetParam().law)}, {"increments", GetParam().increments}});
  run();
  const std::string warned = GetParam().warned;
  const std::string code = "[permanent-set]: ";
  if (warned.empty()) {
    EXPECT_THAT(log_.str(), Not(HasSubstr(code)));
  } else {
    EXPECT_THAT(log_.str(), AllOf(HasSubstr(code), HasSubstr("joint.json: increment " + warned +
                                                             " unloads fastener \"f1\", fastener \"f2\" ")));
    EXPECT_EQ(log_.str().find(code), log_.str().rfind(code)) << "once";
  }
}

constexpr const char* yields = R"({"type": "bilinear", "k": 1000, "F_yield": 40, "k_yield": 100, "reversible": true})";
constexpr const char* slips =
    R"({"type": "four stage", "k_stick": 9000, "F_slip": 20, "slip": 0.1, "k_bearing": 1000, "F_yield": 90, "k_yield": 9,
        "reversible": true})";
constexpr const char* points = R"({"type": "table", "delta": [0, 0.1, 0.2, 0.4], "F": [0, 30, 50, 70]})";
INSTANTIATE_TEST_SUITE_P(Each, UnloadingOf,
                         testing::Values(Unloading{"yielded", yields, "[1, 0.9, 0.5]", "2 (load factor 0.9)"},
                                         Unloading{"reversed", yields, "[0.5, 1, 1.1, -1]", "4 (load factor -1)"},
                                         Unloading{"elastic", yields, "[0.7, 0.1, -0.7]", ""},
                                         Unloading{"rising", yields, "[0.5, 1, 1.1]", ""},
                                         Unloading{"slipped", slips, "[0.3, 0.6, 0.3]", "3 (load factor 0.3)"},
                                         Unloading{"stuck", slips, "[0.3, 0.1, -0.3]", ""},
                                         Unloading{"table", points, "[1, 0]", "2 (load factor 0)"},
                                         Unloading{"table_rising", points, "4", ""},
                                         Unloading{"elastic_with_a_gap",
                                                   R"({"type": "power", "A": 900, "n": 1, "delta0": 0.1})",
                                                   "[1, 0, -1]", ""}),
                         [](const auto& test) { return test.param.name; });

/// A path of two increments with the forces and displacements of two fasteners, each the same.
LoadPath path_of(const JointEquations& equations, std::array<double, 2> F, std::array<double, 2> delta) {
  LoadPath path;
  for (const int i : {0, 1})
    path.steps.push_back({.load_factor = 1 - 0.5 * i,
                          .F = Eigen::Vector2d::Constant(F[i]),
                          .delta = Eigen::Vector2d::Constant(delta[i]),
                          .iterations = 1,
                          .residual = 0,
                          .check = {},
                          .c = Eigen::Vector2d::Constant(F[i] + equations.contacts[0].stiffness * delta[i])});
  return path;
}

TEST(Warnings, SayNothingOfUnloadingWithinAGap) {
  const test::HandMade joint = test::joint_of(test::two_fastener_lap(), test::power_law(900, 0.7, 0.1));
  const JointEquations equations = make_equations(joint);
  EXPECT_THAT(warnings(joint, equations, path_of(equations, {0, 0}, {0.05, 0.02})), IsEmpty());
  EXPECT_THAT(warnings(joint, equations, path_of(equations, {90, 0}, {0.14, 0.02})),
              ElementsAre(test::is_warning("permanent-set", "increment 2 (load factor 0.5) unloads ")));
}

TEST(Warnings, TellThatFrictionDoesNotTurn) {
  const test::HandMade joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1000));
  JointEquations equations = make_equations(joint);
  EXPECT_THAT(warnings(joint, equations, path_of(equations, {50, 40}, {0.05, 0.04})), IsEmpty());
  equations.parameters.mu[2] = 0.2;  // of the second fastener in its first hole
  EXPECT_THAT(warnings(joint, equations, path_of(equations, {40, 50}, {0.04, 0.05})), IsEmpty());
  EXPECT_THAT(
      warnings(joint, equations, path_of(equations, {50, 40}, {0.05, 0.04})),
      ElementsAre(test::is_warning("friction-turns", "increment 2 (load factor 0.5) unloads fastener \"2\", ")));
}

TEST(Warnings, TellOfASolutionPastTheLargestLoad) {
  const test::HandMade joint = test::joint_of(test::two_fastener_lap(), test::linear_law(1));
  PathStep step{.load_factor = 0.5,
                .F = Eigen::Vector2d::Zero(),
                .delta = Eigen::Vector2d::Zero(),
                .iterations = 1,
                .residual = 0,
                .check = {},
                .c = Eigen::Vector2d::Zero()};
  step.check.unstable = 2;
  LoadPath path;
  path.steps = {step, step};
  EXPECT_THAT(warnings(joint, make_equations(joint), path),
              ElementsAre(AllOf(test::is_warning("unstable-balance", "joint.json: at increment 1 (load factor 0.5) "),
                                test::is_warning("unstable-balance", " in 2 ways "))));
}

}  // namespace
}  // namespace fastjoint::stage3
