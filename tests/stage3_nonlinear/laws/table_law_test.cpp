// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "common/errors.hpp"
#include "stage3_nonlinear/laws/law.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::ThrowsMessage;

LawPointer table_law(const TestPoints& points) {
  std::vector<double> delta, F;
  for (const auto& point : points) {
    delta.push_back(point[0]);
    F.push_back(point[1]);
  }
  return test::law_of(fmt::format(R"({{"type": "table", "delta": {}, "F": {}}})", delta, F));
}

/// Points of sin: the error of a cubic with continuous slope falls as h^3 at least (as h^4 where it may).
TEST(TableLaw, ConvergesToTheCurveOfItsPoints) {
  const auto error = [](int n) {
    std::vector<std::array<double, 2>> points;
    for (int i = 1; i <= n; ++i) points.push_back({1.5 * i / n, std::sin(1.5 * i / n)});
    const auto law = table_law(points);
    double worst = 0;
    for (double c = 0.01; c < 2; c += 0.01) {
      const Branch on = law->at(c, 0.7, 0);
      EXPECT_NEAR(on.F + 0.7 * on.delta, c, 1e-14);
      if (on.delta < 1.2) worst = std::max(worst, std::abs(on.F - std::sin(on.delta)));
    }
    return worst;
  };
  for (const int n : {10, 20, 40}) EXPECT_LT(error(2 * n) / error(n), 0.14) << n;
  EXPECT_LT(error(80), 2e-6);
}

TEST(TableLaw, GoesThroughItsPointsAndNeverFalls) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> step(0, 1);
  for (int i = 0; i < 200; ++i) {
    std::vector<std::array<double, 2>> points{{0.1 + step(random), step(random)}};
    for (int j = 0; j < 6; ++j)  // level pieces too
      points.push_back({points.back()[0] + 0.01 + step(random),
                        points.back()[1] + (step(random) < 0.3 ? 0 : step(random) * step(random))});
    const auto law = table_law(points);
    const double k = std::pow(10, 6 * step(random) - 3), gap = step(random);
    for (const auto& [x, F] : points) EXPECT_NEAR(law->at(F + k * (gap + x), k, gap).F, F, 1e-13);
    double before = 0;
    for (double c = 0; c < 20 * (1 + k); c += 0.05 * (1 + k)) {
      const Branch on = law->at(c, k, gap);
      EXPECT_GE(on.F, before - 1e-14);
      EXPECT_NEAR(on.F + k * on.delta, c, 1e-12 * (c + k));
      EXPECT_GE(on.dF, 0);
      before = on.F;
    }
    EXPECT_DOUBLE_EQ(law->last_delta(gap), gap + points.back()[0]);
  }
}

TEST(TableLaw, ReadsTheSamePointsFromAFile) {
  const test::TemporaryFolder folder;
  folder.write("rivet.csv", "delta, F\n0, 0\n0.1, 300\n0.2, 500 # last\n");
  const auto document = input::parse(folder.path("joint.json"), R"({"type": "table", "file": "rivet.csv"})");
  const auto from_file = read_law(input::Value(document));
  const auto inside = test::law_of(R"({"type": "table", "delta": [0.1, 0.2], "F": [300, 500]})");
  for (const double c : {10.0, 400.0, 2000.0}) {
    EXPECT_EQ(from_file->at(c, 1e3, 0.01).F, inside->at(c, 1e3, 0.01).F);
    EXPECT_EQ(from_file->slopes(c, 1e3, 0.01)[0].F, inside->slopes(c, 1e3, 0.01)[0].F);
  }
}

TEST(TableLaw, IsExactlyAtRestWithoutForce) {
  const auto law = test::law_of(R"({"type": "table", "delta": [0.1, 0.2], "F": [300, 310]})");
  EXPECT_EQ(law->at(0, 1e5, 0).F, 0);
  EXPECT_EQ(law->at(0, 1e5, 0).delta, 0);
  EXPECT_EQ(law->at(1e5 * 0.03, 1e5, 0.03).delta, 0.03) << "at first contact";
}

TEST(TableLaw, NamesAFileThatIsMissing) {
  EXPECT_THAT([] { (void)test::law_of(R"({"type": "table", "file": "nope.csv"})"); },
              ThrowsMessage<FileError>(HasSubstr("nope.csv: cannot be opened: No such file")));
}

TEST(TableLaw, HasDerivatives) {
  const auto law = test::law_of(R"({"type": "table", "delta": [0.1, 0.2, 0.5], "F": [300, 500, 600]})");
  constexpr double h = 1e-4, k = 1000;
  for (double c = 20; c < 2000; c += 33) {
    const Branch on = law->at(c, k, 0.01), above = law->at(c + h, k, 0.01), below = law->at(c - h, k, 0.01);
    EXPECT_NEAR((above.F - below.F) / (2 * h), on.dF, 1e-6) << c;
    EXPECT_NEAR((above.delta - below.delta) / (2 * h) * k, on.ddelta * k, 1e-6) << c;
    const Branch wider = law->at(c, k, 0.01 + 1e-7), tighter = law->at(c, k, 0.01 - 1e-7);
    EXPECT_NEAR((wider.F - tighter.F) / 2e-7, law->slopes(c, k, 0.01)[0].F, 1e-2) << c;
  }
  const double contact = k * 0.01;  // at which the side counts that bears
  EXPECT_NEAR(law->slopes(contact, k, 0.01)[0].F, law->slopes(contact + h, k, 0.01)[0].F, 1e-2);
}

using Point = std::array<double, 2>;

class PointsOfATest : public testing::Test {
 protected:
  [[nodiscard]] std::vector<Point> read(const std::string& text) const {
    return read_points(folder_.write("test.csv", text));
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    return test::message_of([&] { return read(text); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(PointsOfATest, OfAnySeparatorHeaderAndComment) {
  const auto points = ElementsAre(Point{0, 0}, Point{0.1, 200}, Point{0.25, 3.5e2});
  EXPECT_THAT(read("0,0\n0.1,200\n0.25,3.5e2\n"), points);
  EXPECT_THAT(read("0;0\n0.1;200\n0.25;350"), points);
  EXPECT_THAT(read("0\t0\n0.1\t200\n0.25\t350\n\n"), points);
  EXPECT_THAT(read("delta, F\n0, 0\n 0.1 , 200 \n0.25,350"), points);
  EXPECT_THAT(read("\xEF\xBB\xBF\"delta [mm]\";\"F [N]\"\r\n0;0\r\n0.1;200\r\n0.25;350\r\n"), points);
  EXPECT_THAT(read("+0,+0\n+0.1,+200\n+2.5E-01,+350\n"), points);
  EXPECT_THAT(read("F [N], delta [mm]\n0,0\n200,0.1\n350,0.25"), points);
  EXPECT_THAT(read("# bolt 7\n\n0,0 # start\n0.1,200\n  # pause\n0.25,350\n"), points);
}

TEST_F(PointsOfATest, KeepsTheOrderOfTheFile) {
  EXPECT_THAT(read("2,1\n1,2\n2,1\n"), ElementsAre(Point{2, 1}, Point{1, 2}, Point{2, 1}));
}

TEST_F(PointsOfATest, RefusesWithFileAndLine) {
  const std::string number = "allowed: a number >= 0 with a decimal point";
  EXPECT_THAT(refusal("delta,F\n0,0\n0.1,-3\n"), EndsWith("test.csv:3: '-3' is not allowed; " + number));
  EXPECT_THAT(refusal("+-0.1,3\n"), EndsWith("test.csv:1: '+-0.1' is not allowed; " + number));
  EXPECT_THAT(refusal("-0.1,3\n"), EndsWith("test.csv:1: '-0.1' is not allowed; " + number));
  EXPECT_THAT(refusal("0,0\n0.1,nan\n"), EndsWith("test.csv:2: 'nan' is not allowed; " + number));
  EXPECT_THAT(refusal("nan,nan\n"), EndsWith("test.csv:1: 'nan' is not allowed; " + number));
  EXPECT_THAT(refusal("0,inf\n"), EndsWith("test.csv:1: 'inf' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1e999\n"), EndsWith("test.csv:1: '1e999' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1e-105\n"),
              EndsWith("test.csv:1: '1e-105' is not allowed; " + number + ", 0 or of a size from 1e-100 to 1e+100"));
  EXPECT_THAT(refusal("0,1 N\n"), EndsWith("test.csv:1: '1 N' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1;200\n"), EndsWith("test.csv:1: '0,1' is not allowed; " + number));
  EXPECT_THAT(refusal("0.0l,2oo\n1,2\n"), EndsWith("test.csv:1: '0.0l' is not allowed; " + number));
  EXPECT_THAT(refusal("# two headers\ndelta,F\nmm,N\n"), EndsWith("test.csv:3: 'mm' is not allowed; " + number));
  EXPECT_THAT(refusal(std::string("0.1,2\n0.2,3\0", 12)),
              EndsWith("test.csv: a byte of value 0 at line 2, column 6; allowed: text"));
  EXPECT_THAT(refusal("delta,\n"), EndsWith("test.csv:1: 'delta' is not allowed; " + number));
}

TEST_F(PointsOfATest, HaveTheUnitsOfTheirNames) {
  const auto units = [&](const std::string& header) {
    std::array<std::string, 2> found;
    (void)read_points(folder_.write("test.csv", header + "\n1,2\n"), &found);
    return found;
  };
  EXPECT_THAT(units("delta [mm], F [N]"), ElementsAre("mm", "N"));
  EXPECT_THAT(units("F / kN, delta (in)"), ElementsAre("in", "kN"));
  EXPECT_THAT(units("delta[1e-3 mm],F"), ElementsAre("1e-3 mm", ""));
  EXPECT_THAT(units("1,2"), ElementsAre("", ""));
}

TEST_F(PointsOfATest, RefusesNamesThatDoNotTellWhichIsWhich) {
  const std::string names = "allowed: \"delta\" and \"F\", with units or without, or no names";
  EXPECT_THAT(refusal("load,slip\n1,2\n"), EndsWith("test.csv:1: columns 'load' and 'slip'; " + names));
  EXPECT_THAT(refusal("delta,delta\n1,2\n"), EndsWith("test.csv:1: columns 'delta' and 'delta'; " + names));
}

TEST_F(PointsOfATest, RefusesOtherThanTwoColumns) {
  const std::string columns = "allowed: two columns, delta and F, parted by a comma, semicolon or tab";
  EXPECT_THAT(refusal("0,0\n1,2,3\n"), EndsWith("test.csv:2: 3 columns in '1,2,3'; " + columns));
  EXPECT_THAT(refusal("the force was measured\n"),
              EndsWith("test.csv:1: 1 column in 'the force was measured'; " + columns));
  EXPECT_THAT(refusal(""), EndsWith("test.csv: no points; " + columns));
  EXPECT_THAT(refusal("# nothing\ndelta,F\n"), EndsWith("test.csv: no points; " + columns));
}

TEST_F(PointsOfATest, OfNoFile) {
  EXPECT_THAT([&] { (void)read_points(folder_.path("none.csv")); },
              ThrowsMessage<FileError>(HasSubstr("none.csv: cannot be opened: No such file or directory")));
}

}  // namespace
}  // namespace fastjoint::stage3
