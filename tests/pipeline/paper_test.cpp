// SPDX-License-Identifier: GPL-3.0-or-later
// The three-fastener joint of Bortman & Szabo, section 6.2, through the three executables.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <memory>

#include "common/formats/joint_result.hpp"
#include "common/formats/plate_matrices.hpp"
#include "tests/pipeline/programs.hpp"

namespace fastjoint {
namespace {

class Paper : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<test::TemporaryFolder>();
    test::make_matrices(*folder_);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static formats::JointResult solve(const std::string& joint) {
    folder_->write("joint.json", joint);
    const auto run = test::stage3(*folder_, "joint.json -o result.h5");
    EXPECT_EQ(run.status, 0) << run.err;
    return formats::read_joint_result(folder_->path("result.h5"));
  }

  static std::unique_ptr<test::TemporaryFolder> folder_;
};
std::unique_ptr<test::TemporaryFolder> Paper::folder_;

double share_of_first(const formats::JointResult& result) {
  return 100 * result.transferred_second(0, 0) / result.transferred_second.row(0).sum();
}

TEST_F(Paper, ShareOfTheFirstFastener) {
  EXPECT_NEAR(share_of_first(solve(test::three_fastener_joint(1, 1000))), 58.88, 0.005);
  EXPECT_NEAR(share_of_first(solve(test::three_fastener_joint(1e7, 1000))), 63.36, 0.005);
}

/// The load at which fastener 1 meets its hole, from the slope of its gap; and that contact does begin there.
TEST_F(Paper, LoadAtContact) {
  for (const auto& [clearance, expected] : {std::pair{0.06, 653.9}, {0.12, 1307.8}, {0.18, 1961.7}}) {
    const std::string gap = fmt::format(R"(, "clearance": {})", clearance);
    const auto open = solve(test::three_fastener_joint(1000, 100, gap));
    EXPECT_EQ(open.F(0, 0), 0);
    EXPECT_NEAR(100 * clearance / open.delta(0, 0), expected, 0.05);  // 1961.749 with a ring, 1961.773 without
    EXPECT_EQ(solve(test::three_fastener_joint(1000, expected - 0.1, gap)).F(0, 0), 0);
    EXPECT_GT(solve(test::three_fastener_joint(1000, expected + 0.1, gap)).F(0, 0), 0);
  }
}

/// The same loads, found as events.
TEST_F(Paper, LoadAtContactIsAnIncrement) {
  for (const auto& [clearance, expected] : {std::pair{0.06, 653.9}, {0.12, 1307.8}, {0.18, 1961.7}}) {
    const auto result =
        solve(test::replaced(test::three_fastener_joint(1000, 3000, fmt::format(R"(, "clearance": {})", clearance)),
                             "\"increments\": 1", "\"increments\": \"events\""));
    ASSERT_EQ(result.load_factor.size(), 2);
    EXPECT_NEAR(3000 * result.load_factor[0], expected, 0.05);
    EXPECT_THAT(result.event, testing::ElementsAre("1 closes", ""));
    EXPECT_NEAR(result.delta(0, 0), clearance, 1e-12);
    EXPECT_NEAR(result.F(0, 0), 0, 1e-9);
  }
}

TEST_F(Paper, FrictionRaisesTheTransferredLoad) {
  const double without = solve(test::three_fastener_joint(1000, 1000)).transferred_second(0, 0);
  for (const auto& [mu, expected] : {std::pair{0.1, 5.33}, {0.2, 10.56}, {0.3, 15.69}}) {
    const auto result = solve(test::three_fastener_joint(1000, 1000, "", fmt::format(R"(, "friction": {})", mu)));
    EXPECT_NEAR(100 * (result.transferred_second(0, 0) / without - 1), expected, 0.005) << mu;
  }
}

/// To 1e-5 on the bare grid, to 2e-7 with one more ring (as the example has it); and it knows its error.
TEST_F(Paper, StiffnessOfTheCentreSheet) {
  constexpr double published = 18473.0316;
  const auto expect = [](const std::string& name, double tolerance) {
    const auto m = formats::read_plate_matrices(folder_->path(name));
    const double error = std::abs(m.S_ee.back()(0, 0) - published);
    EXPECT_LT(error, tolerance * published) << name;
    EXPECT_LT(error, 1.5 * m.S_ee_error(0, 0)) << name;
  };
  std::string bare = test::example("center.json");
  for (int hole = 0; hole < 3; ++hole) bare = test::replaced(bare, ", \"rings\": 1", "");
  folder_->write("bare.json", bare);
  ASSERT_EQ(test::stage1(*folder_, "bare.json -o bare.h5").status, 0);
  ASSERT_EQ(test::stage2(*folder_, "bare.h5 -o bare.m.h5").status, 0);
  expect("bare.m.h5", 1e-5);
  expect("center.m.h5", 2e-7);
}

/// Three equal increments with a clearance: a piecewise linear path between the two linear bounds (Figure 25).
TEST_F(Paper, ClearanceInThreeIncrements) {
  const std::string three = test::replaced(test::three_fastener_joint(1000, 3000, R"(, "clearance": 0.12)"),
                                           "\"increments\": 1", "\"increments\": 3");
  const auto result = solve(three);
  const double bound = solve(test::three_fastener_joint(1000, 3000)).F(0, 0);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.load_factor.size(), 3);
  EXPECT_EQ(result.F(0, 0), 0);
  const double slope = bound / 3000;
  EXPECT_NEAR(result.F(1, 0), slope * (2000 - 1307.8), 0.1);
  EXPECT_NEAR(result.F(2, 0), slope * (3000 - 1307.8), 0.1);
}

TEST_F(Paper, AllFirstGuessesAgree) {
  const std::string joint = test::three_fastener_joint(1000, 3000, R"(, "clearance": 0.06)", R"(, "friction": 0.2)");
  const auto reference = solve(joint);
  for (const char* guess : {"\"rigid\"", "\"equal\"", "{\"linear\": 1000}"}) {
    const auto other =
        solve(test::replaced(joint, "\"increments\": 1", fmt::format("\"increments\": 1, \"initial\": {}", guess)));
    EXPECT_LT((other.F - reference.F).norm(), 1e-8 * reference.F.norm()) << guess;
  }
}

TEST_F(Paper, SummaryNamesWhatAnEngineerReads) {
  folder_->write("joint.json", test::three_fastener_joint(1000, 1000, R"(, "clearance": 0.02)"));
  const auto run = test::stage3(*folder_, "joint.json -o result.h5 --csv loads.csv");
  for (const char* word : {"delta", "F", "transferred", "%", "iterations", "residual", "equilibrium"})
    EXPECT_THAT(run.out, testing::HasSubstr(word));
  const std::string csv = test::read_file(folder_->path("loads.csv"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4) << csv;
}

}  // namespace
}  // namespace fastjoint
