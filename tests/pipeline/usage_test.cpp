// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/pipeline/programs.hpp"

namespace fastjoint {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Program = test::Run (*)(const test::TemporaryFolder&, const std::string&);
const Program programs[] = {test::stage1, test::stage2, test::stage3};

class Usage : public testing::TestWithParam<int> {
 protected:
  test::TemporaryFolder folder_;
  test::Run call(const std::string& words) const { return programs[GetParam() - 1](folder_, words); }
};

TEST_P(Usage, HelpAndVersion) {
  const auto help = call("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.out,
              AllOf(HasSubstr("--output"), HasSubstr("--quiet"), HasSubstr("--version"), HasSubstr("Exit status")));
  const auto version = call("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("stage[123]_[a-z]+ [0-9.]+\n"));
}

TEST_P(Usage, WrongWords) {
  for (const char* words :
       {"", "in.json", "in.json -o", "-o out.h5", "in.json -o out.h5 --colour", "in.json extra -o out.h5"}) {
    const auto run = call(words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_THAT(run.err, HasSubstr("see --help")) << words;
  }
  for (const char* words : {"in.json", "in.json -o ''"})
    EXPECT_THAT(call(words).err, HasSubstr("error: --output is required; see --help")) << words;
  for (const char* words : {"-o out.h5", "'' -o out.h5"})
    EXPECT_THAT(call(words).err, HasSubstr("is required; see --help")) << words;
}

TEST_P(Usage, OutputsThatCannotBe) {
  folder_.write("in.json", "{}");
  EXPECT_THAT(call("in.json -o in.json").err, HasSubstr("-o in.json: is the input file"));
  EXPECT_EQ(call("in.json -o in.json").status, 2);
  EXPECT_THAT(call("in.json -o no/out.h5").err, HasSubstr("no/out.h5: cannot be written: No such file or directory"));
  EXPECT_EQ(call("in.json -o no/out.h5").status, 3);
  EXPECT_THAT(call("in.json -o .").err, HasSubstr("not a regular file"));
}

INSTANTIATE_TEST_SUITE_P(Stage, Usage, testing::Values(1, 2, 3));

/// Once for the scene, however many there are; results are written all the same.
TEST(UsageOfOptions, SpringsAtNodesAreWarnedOf) {
  const test::TemporaryFolder folder;
  const auto scene = [](const std::string& spring, const std::string& points) {
    return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
      "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}}, "geometry": {{"grid": {{"x": [0, 1], "y": [0, 1], "thickness": 1}}}},
      "holes": [{{"id": "h", "center": [0.5, 0.5], "radius": 0.2, "spring": {}}}], "points": [{}],
      "supports": [{{"on": "left", "fix": ["x", "y"]}}]}})",
                       spring, points);
  };
  const std::string point = R"({"id": "p", "at": [1, 1], "stiffness": 1})";
  for (const auto& json :
       {scene(R"({"links": 1})", point), scene(R"({"links": 1})", ""), scene(R"({"modulus": 1})", point)}) {
    folder.write("plate.json", json);
    const auto run = test::stage1(folder, "plate.json -o plate.h5 --p 2");
    EXPECT_EQ(run.status, 0);
    EXPECT_THAT(run.err, testing::StartsWith("stage1_plate: warning [springs-at-nodes]: plate.json: "));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  folder.write("plate.json", scene(R"({"modulus": 1})", ""));
  EXPECT_EQ(test::stage1(folder, "plate.json -o plate.h5 --p 2").err, "");
}

TEST(UsageOfOptions, WrongValues) {
  const test::TemporaryFolder folder;
  test::make_matrices(folder);
  EXPECT_THAT(test::stage1(folder, "center.json -o o.h5 --p 9").err,
              HasSubstr("--p: '9' is not allowed; allowed: a degree from 1 to 8"));
  EXPECT_THAT(test::stage1(folder, "center.json -o o.h5 --threads x").err, HasSubstr("--threads: 'x' is not allowed"));
  EXPECT_THAT(test::stage1(folder, "center.json -o o.h5 --accuracy 0").err,
              HasSubstr("--accuracy: '0' is not allowed; allowed: a number from 1e-10 to 1"));
  EXPECT_EQ(test::stage1(folder, "center.json -o o.h5 --accuracy=").status, 2);
  ASSERT_EQ(test::stage1(folder, "center.json -o low.h5 --p 2..3").status, 0);
  ASSERT_EQ(test::stage2(folder, "low.h5 -o center.m.h5").status, 0);
  folder.write("joint.json", test::three_fastener_joint(1000, 1000));
  const auto run = test::stage3(folder, "joint.json -o o.h5 --p 7");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("7"), HasSubstr("allowed"), HasSubstr("2, 3")));
}

/// Not reached, the result is kept, with a warning.
TEST(UsageOfOptions, Accuracy) {
  const test::TemporaryFolder folder;
  std::string center = test::example("center.json");
  const std::string space = R"("space": "trunk", )";
  ASSERT_NE(center.find(space), std::string::npos);
  folder.write("center.json", center.erase(center.find(space), space.size()));
  const auto reached = test::stage1(folder, "center.json -o a.h5 --accuracy 1e-4");
  EXPECT_EQ(reached.status, 0);
  EXPECT_EQ(reached.err, "");
  const std::string said = "accuracy 0.0001: product space, p = 6: error of S about 1.5";
  EXPECT_THAT(reached.out, AllOf(HasSubstr("p = 6: "), Not(HasSubstr("p = 7: ")), HasSubstr(said)));
  const auto matrices = test::stage2(folder, "a.h5 -o a.m.h5");
  EXPECT_THAT(matrices.out, AllOf(HasSubstr("p = 1..6"), HasSubstr("error of S about 1.5")));
  const auto missed = test::stage1(folder, "center.json -o b.h5 --accuracy 1e-9 --p 1..4 --quiet");
  EXPECT_EQ(missed.status, 0);
  EXPECT_THAT(missed.err,
              AllOf(HasSubstr("warning [accuracy-not-reached]: center.json: accuracy 1e-09: product space, p = 4"),
                    HasSubstr(", of R about "), HasSubstr(" --p 1..4 "), HasSubstr(" up to 8 ")));
  EXPECT_THAT(test::stage2(folder, "b.h5 -o b.m.h5").out, HasSubstr("p = 1..4"));
  folder.write("low.json", "{\"p\": [1, 3]," + center.substr(1));
  EXPECT_THAT(test::stage1(folder, "low.json -o l.h5 --accuracy 1e-9").err, HasSubstr("p = 3: error of S about "));
  EXPECT_THAT(test::stage1(folder, "low.json -o l.h5 --accuracy 1e-9").err,
              AllOf(HasSubstr(" \"p\" of the scene "), HasSubstr(" up to 8 ")));
  EXPECT_THAT(test::stage1(folder, "low.json -o l.h5 --accuracy 1e-10 --p 1..8").err,
              AllOf(HasSubstr("[accuracy-not-reached]: "), HasSubstr("p = 8: "), HasSubstr("these cells: finer ones")));
  const auto alone = test::stage1(folder, "center.json -o c.h5 --accuracy 1e-3 --p 8");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(alone.err, HasSubstr("degree 8 alone does not show its error"));
}

TEST(UsageOfOptions, QuietPrintsNothingAndEqualRunsGiveEqualBytes) {
  const test::TemporaryFolder folder;
  folder.write("center.json", test::example("center.json"));
  std::string solution, matrices;
  for (int i = 0; i < 2; ++i) {
    const auto one = test::stage1(folder, "center.json -o a.h5 --quiet");
    const auto two = test::stage2(folder, "a.h5 -o b.h5 --quiet");
    EXPECT_EQ(one.out + one.err + two.out + two.err, "");
    if (i == 1) {
      EXPECT_EQ(test::read_file(folder.path("a.h5")), solution);
      EXPECT_EQ(test::read_file(folder.path("b.h5")), matrices);
    }
    solution = test::read_file(folder.path("a.h5"));
    matrices = test::read_file(folder.path("b.h5"));
  }
}

}  // namespace
}  // namespace fastjoint
