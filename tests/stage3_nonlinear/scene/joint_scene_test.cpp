// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/joint_scene.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"
#include "tests/support/warning.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

using Members = std::map<std::string, std::string>;

JointScene read(const Members& members) {
  return read_joint_scene(input::parse("folder/joint.json", test::joint_text(members)));
}

TEST(JointScene, ReadsTheContractsExample) {
  const JointScene scene =
      read({{"$schema", R"("../joint.schema.json")"},
            {"name", R"("three fasteners")"},
            {"units", R"({"length": "in", "force": "lbf"})"},
            {"laws", R"({"bolt": {"type": "power", "A": 1000, "n": 0.5, "delta0": 0.01},
                         "six": {"type": "cubic", "delta": [0.01, 0.02, 0.04], "F": [900, 1500, 2000],
                                 "one_sided": true}})"},
            {"fasteners",
             R"([{"id": "1", "between": ["a:1", "b:x:1"], "law": "bolt", "clearance": 0.06, "friction": 0.1},
                         {"id": "2", "between": ["b:2", "a:2"], "law": "six", "friction": {"a": 0.2}}])"},
            {"loads", R"([{"external": "a:P", "force": 3000}, {"external": "b:Q", "displacement": 0}])"},
            {"increments", "[0.1, 0.5, -1]"},
            {"initial", R"({"linear": 1000})"},
            {"solver", R"({"tolerance": 1e-8, "max_iterations": 50})"}});
  EXPECT_EQ(scene.name, "three fasteners");
  EXPECT_EQ(scene.units->length, "in");
  EXPECT_EQ(scene.plates[1].file, "folder/b.h5");
  EXPECT_EQ(scene.laws.at("bolt").law->gap(0), 0.01);
  EXPECT_TRUE(scene.laws.at("six").one_sided);
  EXPECT_EQ(scene.fasteners[0].between[1].name, "x:1") << "names of holes may hold colons";
  EXPECT_THAT(scene.fasteners[0].clearance, ElementsAre(0.06));
  EXPECT_THAT(scene.fasteners[0].friction, ElementsAre(0.1, 0.1));
  EXPECT_THAT(scene.fasteners[1].friction, ElementsAre(0, 0.2)) << "first plate is b";
  EXPECT_FALSE(scene.cases[0].loads[0].is_displacement);
  EXPECT_TRUE(scene.cases[0].loads[1].is_displacement);
  EXPECT_THAT(scene.cases[0].load_factors, ElementsAre(0.1, 0.5, -1));
  EXPECT_EQ(scene.initial.stiffness, 1000);
  EXPECT_EQ(scene.solver.tolerance, 1e-8);
  EXPECT_EQ(scene.solver.max_iterations, 50);
}

TEST(JointScene, APlateIsAPathOrAPathWithItsDigest) {
  const JointScene scene = read({{"plates", R"({"a": {"file": "a.h5", "digest": "0123456789abcdef"}, "b": "b.h5"})"}});
  EXPECT_EQ(scene.plates[0].file, "folder/a.h5");
  EXPECT_EQ(scene.plates[0].digest, "0123456789abcdef");
  EXPECT_EQ(scene.plates[1].digest, "");
}

TEST(JointScene, ReadsStacksWithOneValueOrOneForEachPlane) {
  const auto scene = read({{"plates", R"({"a": "a.h5", "b": "b.h5", "c": "c.h5"})"},
                           {"laws", R"({"p": {"type": "linear", "k": 1}, "q": {"type": "linear", "k": 2}})"},
                           {"fasteners", R"([{"id": "1", "between": ["a:1", "b:1", "c:1"], "law": ["p", "q"],
                                              "clearance": [0.1, 0.2], "friction": {"b": 0.3}},
                                             {"id": "2", "between": ["c:2", "b:2", "a:2"], "law": "q",
                                              "clearance": 0.4, "friction": 0.5}])"},
                           {"solver", R"({"method": "damped newton"})"}});
  EXPECT_THAT(scene.fasteners[0].law, ElementsAre("p", "q"));
  EXPECT_THAT(scene.fasteners[0].clearance, ElementsAre(0.1, 0.2));
  EXPECT_THAT(scene.fasteners[0].friction, ElementsAre(0, 0.3, 0));
  EXPECT_THAT(scene.fasteners[1].law, ElementsAre("q", "q"));
  EXPECT_THAT(scene.fasteners[1].clearance, ElementsAre(0.4, 0.4));
  EXPECT_THAT(scene.fasteners[1].friction, ElementsAre(0.5, 0.5, 0.5));
  EXPECT_EQ(scene.fasteners[0].between[2].plate, "c");
  EXPECT_EQ(scene.solver.method, Method::damped_newton);
}

TEST(JointScene, HasDefaults) {
  const JointScene scene = read({{"increments", "4"}});
  EXPECT_EQ(scene.name, "");
  EXPECT_FALSE(scene.units);
  EXPECT_THAT(scene.cases[0].load_factors, ElementsAre(0.25, 0.5, 0.75, 1));
  EXPECT_THAT(read({{"increments", ""}}).cases[0].load_factors, ElementsAre(1)) << "left out";
  EXPECT_THAT(read({{"increments", R"("events")"}}).cases[0].load_factors, IsEmpty());
  EXPECT_EQ(scene.solver.method, Method::fitting);
  EXPECT_EQ(scene.initial.guess, Guess::linear);
  EXPECT_FALSE(scene.initial.stiffness);
  EXPECT_EQ(scene.solver.tolerance, 1e-10);
  EXPECT_EQ(scene.solver.max_iterations, 200);
  EXPECT_THAT(scene.fasteners[0].clearance, ElementsAre(0));
  EXPECT_THAT(scene.fasteners[0].friction, ElementsAre(0, 0));
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(read({{"initial", R"("rigid")"}}).initial.guess, Guess::rigid);
  EXPECT_EQ(read({{"initial", R"("equal")"}}).initial.guess, Guess::equal);
}

TEST(JointScene, TakesDampedNewtonForManyUnknownsUnlessTheInputSaysOtherwise) {
  EXPECT_EQ(iterative_method(Method::fitting, 40), Method::hybridsj);
  EXPECT_EQ(iterative_method(Method::fitting, 41), Method::damped_newton);
  for (const int n_unknowns : {1, 1000})
    for (const Method chosen : {Method::hybridsj, Method::damped_newton})
      EXPECT_EQ(iterative_method(chosen, n_unknowns), chosen);
}

TEST(JointScene, WarnsOfDoubtfulLaws) {
  EXPECT_THAT(read({{"laws", R"({"lin": {"type": "power", "A": 1, "n": 0.2}})"}}).warnings,
              ElementsAre(test::is_warning("exponent-low", "folder/joint.json: /laws/lin: n = 0.2 ")));
}

TEST(JointScene, DoesNotWarnOfALawThatNoFastenerHas) {
  EXPECT_THAT(
      read({{"laws", R"({"lin": {"type": "linear", "k": 1}, "odd": {"type": "power", "A": 1, "n": 0.2}})"}}).warnings,
      IsEmpty());
}

TEST(JointScene, TheGroundMayHoldAFastener) {
  const auto scene =
      read({{"plates", R"({"a": "a.h5"})"},
            {"fasteners", R"([{"id": "1", "between": ["a:1", "ground"], "law": "lin", "friction": 0.1}])"}});
  EXPECT_TRUE(scene.fasteners[0].grounded);
  EXPECT_EQ(scene.fasteners[0].between.size(), 1U);
  EXPECT_THAT(scene.fasteners[0].law, ElementsAre("lin"));
  EXPECT_THAT(scene.fasteners[0].friction, ElementsAre(0.1));
  EXPECT_FALSE(read({}).fasteners[0].grounded);
}

struct Refusal {
  Members members;
  const char* message;
};

/// A fastener list with one fastener changed.
Members fasteners(const std::string& first,
                  const std::string& second = R"("id": "2", "between": ["a:2", "b:2"], "law": "lin")") {
  return {{"fasteners", "[{" + first + "}, {" + second + "}]"}};
}

Members loads(const std::string& list) { return {{"loads", list}}; }

class SceneRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(SceneRefuses, WithFilePointerFoundAndAllowed) {
  EXPECT_THAT([] { (void)read(GetParam().members); },
              ThrowsMessage<InputError>(AllOf(HasSubstr("folder/joint.json: "), HasSubstr(GetParam().message))));
}

INSTANTIATE_TEST_SUITE_P(
    Reading, SceneRefuses,
    testing::Values(
        Refusal{{{"format", R"("plate")"}}, R"(/format: "plate" is not allowed; allowed: "joint")"},
        Refusal{{{"version", "2"}}, "/version: 2 is not allowed"},
        Refusal{{{"weight", "2"}}, "/weight: unknown key; allowed: $schema, format"},
        Refusal{{{"plates", ""}}, R"(key "plates" is missing)"},
        Refusal{{{"plates", "{}"}}, "/plates: no plate; allowed: at least one"},
        Refusal{{{"plates", R"({"a": "a.h5"})"}}, R"(/fasteners/0/between/1: plate "b" does not exist; allowed: a)"},
        Refusal{{{"plates", R"({"a": "a.h5", "ground": "b.h5"})"}},
                R"(/plates/ground: name of a plate; allowed: names without ':' and '/', other than "." and "ground")"},
        Refusal{{{"plates", R"({"a:b": "a.h5", "b": "b.h5"})"}},
                R"(/plates/a:b: name of a plate; allowed: names without ':' and '/')"},
        Refusal{{{"plates", R"({"a/b": "a.h5", "b": "b.h5"})"}},
                "/plates/a~1b: name of a plate; allowed: names without"},
        Refusal{{{"plates", R"({".": "a.h5", "b": "b.h5"})"}}, "/plates/.: name of a plate; allowed: names without"},
        Refusal{{{"plates", R"({"a": 1, "b": "b.h5"})"}}, "/plates/a: 1 is not allowed; allowed: a string"},
        Refusal{{{"laws", "{}"}}, "/fasteners/0/law: \"lin\" is not allowed; allowed: nothing"},
        Refusal{{{"laws", R"({"lin": {"type": "linear", "k": 1, "one_sided": 1}})"}},
                "/laws/lin/one_sided: 1 is not allowed; allowed: true or false"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1"], "law": "lin")"),
                "/fasteners/0/between: array of 1; allowed: at least 2"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b"], "law": "lin")"),
                R"(/fasteners/0/between/1: "b" is not allowed; allowed: "plate:hole", or "ground" as the last)"},
        Refusal{fasteners(R"("id": "1", "between": ["ground", "a:1"], "law": "lin")"),
                R"(/fasteners/0/between/0: "ground" is not allowed; allowed: "plate:hole", or "ground" as the last)"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "ground", "ground"], "law": "lin")"),
                R"(/fasteners/0/between/1: "ground" is not allowed; allowed: "plate:hole", or "ground" as the last)"},
        Refusal{fasteners(R"("id": "1", "between": ["ground"], "law": "lin")"),
                "/fasteners/0/between: array of 1; allowed: at least 2"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1", "ground"], "law": ["lin"])"),
                "/fasteners/0/law: array of 1; allowed: exactly 2"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "ground"], "law": "lin", "friction": {"ground": 0.1})"),
                "/fasteners/0/friction/ground: not a plate of this fastener; allowed: a"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": "bolt")"),
                R"(/fasteners/0/law: "bolt" is not allowed; allowed: "lin")"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": "lin", "clearance": -1)"),
                "/fasteners/0/clearance: -1 is not allowed; allowed: a number >= 0"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": "lin", "friction": -0.1)"),
                "/fasteners/0/friction: -0.1 is not allowed; allowed: a number >= 0"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": "lin", "friction": {"c": 0.1})"),
                "/fasteners/0/friction/c: not a plate of this fastener; allowed: a, b"},
        Refusal{loads("[]"), "/loads: array of 0; allowed: at least 1"},
        Refusal{loads(R"([{"external": "P", "force": 1}])"),
                R"(/loads/0/external: "P" is not allowed; allowed: "plate:external")"},
        Refusal{loads(R"([{"external": "a:P"}])"),
                R"(/loads/0: none of "force", "displacement" and "moment"; allowed: exactly one of them)"},
        Refusal{loads(R"([{"external": "a:P", "force": 1, "displacement": 1}])"),
                R"(/loads/0: more than one of "force", "displacement" and "moment"; allowed: exactly one of them)"},
        Refusal{{{"increments", "0"}}, "/increments: 0 is not allowed; allowed: an integer from 1 to 100000"},
        Refusal{{{"increments", "2.5"}}, "/increments: 2.5 is not allowed; allowed: an integer from 1 to 100000"},
        Refusal{{{"increments", R"("six")"}},
                R"(/increments: "six" is not allowed; allowed: an integer from 1 to 100000, a list of load factors, )"
                R"(or "events")"},
        Refusal{{{"increments", "{}"}},
                "/increments: {} is not allowed; allowed: an integer from 1 to 100000, a list of load factors, "},
        Refusal{{{"increments", "[]"}}, "/increments: array of 0; allowed: 1 to 100000"},
        Refusal{{{"initial", R"("guess")"}}, R"(/initial: "guess" is not allowed; allowed: "rigid", "equal")"},
        Refusal{{{"initial", "3"}},
                R"(/initial: 3 is not allowed; allowed: "rigid", "equal" or {"linear": stiffness})"},
        Refusal{{{"initial", R"({"linear": 0})"}}, "/initial/linear: 0 is not allowed; allowed: a number > 0"},
        Refusal{{{"solver", R"({"tolerance": 1})"}},
                "/solver/tolerance: 1 is not allowed; allowed: a number >= 1e-14 and <= 0.01"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": ["lin", "lin"])"),
                "/fasteners/0/law: array of 2; allowed: exactly 1"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "b:1"], "law": "lin", "clearance": [0, 1])"),
                "/fasteners/0/clearance: array of 2; allowed: exactly 1"},
        Refusal{{{"solver", R"({"method": "guess"})"}},
                R"(/solver/method: "guess" is not allowed; allowed: "hybridsj", "damped newton")"},
        Refusal{{{"solver", R"({"max_iterations": 0})"}}, "/solver/max_iterations: 0 is not allowed"},
        Refusal{{{"units", R"({"length": "in"})"}}, R"(/units: key "force" is missing)"}));

INSTANTIATE_TEST_SUITE_P(
    Meaning, SceneRefuses,
    testing::Values(
        Refusal{fasteners(R"("id": "2", "between": ["a:1", "b:1"], "law": "lin")"),
                R"(/fasteners/1/id: "2" stands twice; allowed: each id once)"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "c:1"], "law": "lin")"),
                R"(/fasteners/0/between/1: plate "c" does not exist; allowed: a, b)"},
        Refusal{fasteners(R"("id": "1", "between": ["a:2", "b:1"], "law": "lin")"),
                R"(/fasteners/1/between/0: hole "a:2" has a fastener already; allowed: one fastener per hole)"},
        Refusal{fasteners(R"("id": "1", "between": ["a:1", "a:3"], "law": "lin")"),
                R"(/fasteners/0/between: goes through plate "a" twice; allowed: holes of different plates)"},
        Refusal{{{"plates", R"({"a": "a.h5", "b": "b.h5", "c": "c.h5"})"}},
                R"(/plates/c: this plate has no fastener; allowed: plates that a fastener names in "between")"},
        Refusal{loads(R"([{"external": "c:P", "force": 1}])"),
                R"(/loads/0/external: plate "c" does not exist; allowed: a, b)"},
        Refusal{loads(R"([{"external": "a:P", "force": 1}, {"external": "a:P", "displacement": 1}])"),
                R"(/loads/1/external: "a:P" is loaded already; allowed: one load per external boundary)"}));

}  // namespace
}  // namespace fastjoint::stage3
