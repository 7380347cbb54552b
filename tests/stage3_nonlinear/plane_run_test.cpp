// SPDX-License-Identifier: GPL-3.0-or-later
// Joints in files whose discs move along x and y, or along y alone.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "common/errors.hpp"
#include "stage3_nonlinear/run.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/result.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

const std::vector<std::string> both{"x", "y"};

/// Two plates of two holes in files, their discs along these directions: a is pulled along the last of them.
class PlaneRun : public testing::Test {
 protected:
  [[nodiscard]] static formats::PlateMatrices plate(bool pulled, const std::vector<std::string>& directions) {
    const auto a = static_cast<int>(directions.size());
    std::vector<test::Spring> springs;
    for (int d = 0; d < a; ++d) {
      springs.push_back({d, a + d, 1000});
      if (pulled) springs.push_back({a + d, 2 * a, d + 1 == a ? 1000.0 : 1e-9});
      if (!pulled) springs.push_back({d, test::ground, 1000});
    }
    auto plate = test::spring_plate(2 * a, pulled ? 1 : 0, springs);
    for (Index i = 0; i < std::ssize(plate.disc_hole); ++i) {
      plate.disc_hole[i] = std::to_string(i / directions.size() + 1);
      plate.disc_direction[i] = directions[i % directions.size()];
    }
    if (pulled) plate.external_direction = {directions.back()};
    return plate;
  }
  void write(const std::vector<std::string>& a, const std::vector<std::string>& b,
             const std::map<std::string, std::string>& members = {}) {
    options_ = {test::write_joint(folder_, {plate(true, a), plate(false, b)}, members),
                folder_.path("result.h5"),
                "",
                false,
                {{"--csv", csv_}}};
  }
  test::Result run() {
    stage3::run(options_, out_, log_, timings_);
    return test::Result(options_.output);
  }
  void expect_refusal(const std::string& message) {
    EXPECT_THAT([&] { (void)run(); }, ThrowsMessage<InputError>(HasSubstr(message)));
  }

  test::TemporaryFolder folder_;
  const std::string csv_ = folder_.path("result.csv");
  program::Arguments options_;
  std::ostringstream out_, log_;
  program::Timings timings_;
};

TEST_F(PlaneRun, AlongYAloneIsAsAlongX) {
  write({"x"}, {"x"});
  const auto along_x = run();
  out_.str("");
  write({"y"}, {"y"});
  const auto along_y = run();
  EXPECT_EQ(along_y.F, along_x.F);
  EXPECT_THAT(along_y.direction, testing::ElementsAre("y"));
  EXPECT_THAT(along_y.plates[0].disc_direction, testing::Each("y"));
  EXPECT_THAT(out_.str(), HasSubstr("  a                         100             -100                    0\n"));
}

TEST_F(PlaneRun, ShowsTheDirectionOfForces) {
  write(both, both, {{"increments", "[0.5]"}});
  const auto a = run();
  EXPECT_THAT(a.direction, testing::ElementsAre("x", "y"));
  EXPECT_NEAR(a.F_vector(0, 1), 25, 1e-9) << "F_y of f1";
  EXPECT_NEAR(a.F(0, 1), 25, 1e-9);
  EXPECT_THAT(out_.str(), HasSubstr("  fastener           delta [in]          F [lbf]      F_x [lbf]      F_y [lbf]    "
                                    "transferred [lbf] share [%]\n"
                                    "  f1                      0.025               25              0             25"));
  EXPECT_THAT(out_.str(), HasSubstr("  a x                         0                0                    0\n"
                                    "  a y                        50              -50                    0\n"));
  std::istringstream csv(test::read_file(csv_));
  std::string header, line;
  std::getline(csv, header);
  std::getline(csv, line);
  EXPECT_THAT(header,
              HasSubstr(",first,second,delta_x [in],delta_y [in],F_x [lbf],F_y [lbf],bearing_load_first [lbf],"));
  std::vector<std::string> cells;
  std::istringstream row(line);
  for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
  EXPECT_EQ(std::stod(cells.at(13)), a.delta_vector(0, 1));
  EXPECT_EQ(std::stod(cells.at(14)), a.F_vector(0, 0));
  EXPECT_EQ(std::stod(cells.at(15)), a.F_vector(0, 1));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
}

TEST_F(PlaneRun, RefusesPlatesWhoseDiscsMoveOtherwise) {
  write({"x"}, both);
  expect_refusal(
      "joint.json: /fasteners/0/between: the disc of hole \"a:1\" moves along x, that of hole \"b:1\" along x and y");
  write(both, {"y", "x"});
  EXPECT_THAT([&] { (void)run(); }, ThrowsMessage<FileError>(HasSubstr(
                                        "b.h5:disc/direction: hole \"1\" has x after y, expected each direction "
                                        "once, all in one order")));
}

TEST_F(PlaneRun, RefusesHalfHoles) {
  auto half = plate(false, both);
  half.friction_hole = {"1", "1"};
  half.friction_bearing = {"+y", "-y"};
  half.friction_unit_force = half.friction_resultant = Eigen::Vector2d(0.01, 0);
  half.R_df = {Eigen::MatrixXd::Zero(4, 2)};
  half.R_ef = {Eigen::MatrixXd::Zero(0, 2)};
  write(both, both);
  formats::write(folder_.path("b.h5"), half);
  expect_refusal(
      "b.h5:friction/unit_force: hole \"1\" has no rim on its side -y, but its disc moves along x and y, off its line "
      "of "
      "symmetry too; allowed: whole holes, or \"disc_directions\" along that line alone");
}

TEST_F(PlaneRun, RefusesOneSidedLawsInThePlane) {
  const std::map<std::string, std::string> one_sided{
      {"laws", R"({"lin": {"type": "linear", "k": 1000, "one_sided": true}})"}};
  write(both, both, one_sided);
  expect_refusal(
      "joint.json: /fasteners/0/law: law \"lin\" is one_sided, but the discs move along x and y; allowed: laws that "
      "bear all around, or plates whose discs have one direction");
  write({"y"}, {"y"}, one_sided);
  EXPECT_NEAR(run().F(0, 0), 50, 1e-9);
}

/// A sheet that only its fasteners at (0, 0) and (1, 0) hold, under a couple of two forces along y, at x = 2 and at -1:
/// stiff in every motion but those of a rigid body. The fasteners bear with +-couple, and no further than they yield.
class Couple : public PlaneRun {
 protected:
  static constexpr double yield = 30;
  void write_couple(double couple, const std::string& method) {
    auto sheet = test::spring_plate(4, 2, {{0, 2, 1000}});
    const Eigen::VectorXd bends = Eigen::VectorXd{{0, 1, 0, -2, 1, 0}}, other = Eigen::VectorXd{{0, -2, 0, 1, 0, 1}};
    const Eigen::MatrixXd S = 1000 * (bends * bends.transpose() + other * other.transpose());
    sheet.S_dd[0] += S.topLeftCorner(4, 4);
    sheet.S_ed[0] += S.bottomLeftCorner(2, 4);
    sheet.S_ee[0] += S.bottomRightCorner(2, 2);
    auto base = test::spring_plate(
        4, 0, {{0, test::ground, 1000}, {1, test::ground, 1000}, {2, test::ground, 1000}, {3, test::ground, 1000}});
    for (auto* plate : {&sheet, &base}) {
      plate->disc_hole = {"1", "1", "2", "2"};
      plate->disc_direction = {"x", "y", "x", "y"};
    }
    sheet.external_id = {"P", "Q"};
    sheet.external_direction = {"y", "y"};
    options_ = {
        test::write_joint(
            folder_, {sheet, base},
            {{"laws",
              fmt::format(R"({{"lin": {{"type": "bilinear", "k": 1000, "F_yield": {}, "k_yield": 0}}}})", yield)},
             {"loads", fmt::format(R"([{{"external": "a:P", "force": {0}}},
                                               {{"external": "a:Q", "force": -{0}}}])",
                                   couple / 3)},
             {"solver", fmt::format(R"({{"method": "{}"}})", method)},
             {"increments", "[0.5, 1]"}}),
        folder_.path("result.h5"),
        "",
        false,
        {}};
  }
};

TEST_F(Couple, BeyondWhatTwoPlasticFastenersHoldTurnsTheSheet) {
  for (const char* method : {"hybridsj", "damped newton"}) {
    write_couple(0.99 * yield, method);
    const auto held = run();
    EXPECT_NEAR(held.F_vector(1, 1), -0.99 * yield, 1e-8) << method;
    EXPECT_NEAR(held.F_vector(1, 3), 0.99 * yield, 1e-8) << method;
    write_couple(yield / 0.75, method);
    const auto beyond =
        test::run(folder_, test::program("stage3_nonlinear") + " " + options_.input + " -o " + options_.output);
    EXPECT_EQ(beyond.status, 4) << method;
    EXPECT_THAT(beyond.err, HasSubstr("joint.json: limit load reached: beyond load factor 0.7")) << method;
    EXPECT_THAT(beyond.err, HasSubstr("the laws of fastener \"f1\", fastener \"f2\" are at their maximum force"))
        << method;
    const auto kept = test::Result(options_.output);
    EXPECT_FALSE(kept.complete);
    EXPECT_EQ(kept.load_factor, Eigen::VectorXd::Constant(1, 0.5)) << method;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
