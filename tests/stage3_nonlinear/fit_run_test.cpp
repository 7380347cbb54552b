// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_run.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>

#include "stage3_nonlinear/law.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// F = 1000 delta^0.5 in four points.
constexpr const char* root = "delta,F\n0.01,100\n0.04,200\n0.09,300\n0.16,400\n";

/// The program as a user calls it, with test.csv in its folder.
class FitProgram : public testing::Test {
 protected:
  [[nodiscard]] test::Run call(const std::string& words) const {
    return test::run(folder_, fmt::format("cd '{}' && '{}' {}", folder_.path(""), STAGE3_PROGRAM, words));
  }
  [[nodiscard]] test::Run fit(const std::string& csv, const std::string& words) const {
    folder_.write("test.csv", csv);
    return call("--fit test.csv " + words);
  }
  test::TemporaryFolder folder_;
};

TEST_F(FitProgram, PrintsConstantsOfAPowerLaw) {
  const auto run = fit(root, "--law power");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out,
              StartsWith("power law fitted to 4 points of test.csv; uncertainties are standard ones (1 sigma)\n"
                         "  A = 1000 +- "));
  EXPECT_THAT(run.out, HasSubstr("\n  n = 0.5 +- "));
  EXPECT_THAT(run.out, HasSubstr("\n  delta0 = 0 (on its bound)\n  RMS residual of F: "));
  EXPECT_THAT(run.out,
              HasSubstr("\n  F measured between sheets has their friction in it: fasteners with \"friction\" then "
                        "take \"law_includes_friction\": true\n"));
  EXPECT_THAT(run.out,
              HasSubstr("for \"laws\" of a joint:\n"
                        "  \"fitted\": {\"type\": \"power\", \"A\": 1000, \"n\": 0.5, \"delta0\": 0}\n  time "));
}

TEST_F(FitProgram, PrintsPointsOfACubic) {
  const auto run = fit("1;1\n2;1.8\n3;2.4\n", "--law cubic");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(
      run.err,
      "stage3_nonlinear: warning: test.csv: 3 points past contact are too few for the uncertainty of 3 constants\n");
  EXPECT_THAT(run.out, HasSubstr("\n  delta = 1: F = 1\n  delta = 2: F = 1.8\n  delta = 3: F = 2.4\n"));
  EXPECT_THAT(run.out,
              HasSubstr("  \"fitted\": {\"type\": \"cubic\", \"delta\": [1, 2, 3], \"F\": [1, 1.8, 2.4]}\n  time "));
}

TEST_F(FitProgram, PrintsALawThatAJointReads) {
  for (const char* law : {"power", "cubic"}) {
    const std::string out = fit(root, fmt::format("--law {}", law)).out;
    const auto at = out.find("{\"type\"");
    ASSERT_NE(at, std::string::npos);
    const auto document = input::parse("joint.json", out.substr(at, out.find('\n', at) - at));
    const auto read = read_law(input::Value(document));
    const Branch branch = read->at(read->coordinate(400, 2500, 0), 2500, 0);
    EXPECT_NEAR(branch.F, 400, 1) << law;
    EXPECT_NEAR(branch.delta, 0.16, 1e-3) << law;
  }
}

TEST_F(FitProgram, DrawsWellFormedXml) {
  const auto run = fit(root, "--law power -o fit.svg --quiet");
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.out + run.err, "");
  const auto parsed = test::run(folder_, fmt::format("/usr/bin/python3 -c 'import sys, xml.etree.ElementTree as x; "
                                                     "print(x.parse(sys.argv[1]).getroot().tag)' '{}'",
                                                     folder_.path("fit.svg")));
  EXPECT_EQ(parsed.out, "{http://www.w3.org/2000/svg}svg\n") << parsed.err;
}

TEST_F(FitProgram, AFailedFitLeavesTheDrawingOfBefore) {
  folder_.write("fit.svg", "before");
  EXPECT_EQ(fit("1,1\n", "--law power -o fit.svg").status, 2);
  EXPECT_EQ(test::read_file(folder_.path("fit.svg")), "before");
  EXPECT_EQ(fit(root, "--law power -o test.csv").err,
            "stage3_nonlinear: error: -o test.csv: is the input file; choose another name\n");
  EXPECT_EQ(fit(root, "--law power -o no/fit.svg").status, 3);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("no")));
}

TEST_F(FitProgram, SaysWhatIsWrongWithTheData) {
  const auto refused = [&](const std::string& csv, int status, const std::string& message) {
    const auto run = fit(csv, "--law power");
    EXPECT_EQ(run.status, status) << message;
    EXPECT_EQ(run.out, "") << message;
    EXPECT_EQ(run.err, "stage3_nonlinear: error: test.csv" + message + "\n");
  };
  refused("0,0\n1,2\n2,3\n", 2, ": forces > 0 at 2 different delta > 0; allowed: at 3 or more of them");
  refused("0,0\n1,-2\n", 2, ":2: '-2' is not allowed; allowed: a number >= 0 with a decimal point");
  refused("0.25,0.0325\n0.5,0.4588\n0.75,0.6867\n1,0.2878\n", 4,
          ": the search for a power law did not end; leave out points before contact and after failure");
  const auto none = call("--fit none.csv --law power");
  EXPECT_EQ(none.status, 3);
  EXPECT_THAT(none.err, HasSubstr("none.csv: cannot be opened: No such file or directory"));
}

TEST_F(FitProgram, WantsItsOptionsTogether) {
  folder_.write("test.csv", root);
  const auto refused = [&](const std::string& words, const std::string& message) {
    const auto run = call(words);
    EXPECT_EQ(run.status, 2) << words;
    EXPECT_EQ(run.err, "stage3_nonlinear: error: " + message + "\n") << words;
  };
  refused("--fit test.csv", "--fit requires --law; see --help");
  refused("joint.json -o result.h5 --law power", "--law requires --fit; see --help");
  refused("joint.json --fit test.csv --law power", "JOINT.json excludes --fit; see --help");
  refused("--fit test.csv --law power --p 3", "--p excludes --fit; see --help");
  refused("--fit test.csv --law power --csv a.csv", "--csv excludes --fit; see --help");
  refused("--fit test.csv --law glue", "--law: 'glue' is not allowed; allowed: power, cubic");
  refused("joint.json", "--output is required; see --help");
  refused("-o result.h5", "JOINT.json is required; see --help");
}

}  // namespace
}  // namespace fastjoint::stage3
