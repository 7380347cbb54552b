// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/test_points.hpp"

#include <gmock/gmock.h>

#include "common/errors.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Point = std::array<double, 2>;

class TestPoints : public testing::Test {
 protected:
  [[nodiscard]] std::vector<Point> read(const std::string& text) const {
    return read_points(folder_.write("test.csv", text));
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    return test::message_of([&] { return read(text); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(TestPoints, OfAnySeparatorHeaderAndComment) {
  const auto points = ElementsAre(Point{0, 0}, Point{0.1, 200}, Point{0.25, 3.5e2});
  EXPECT_THAT(read("0,0\n0.1,200\n0.25,3.5e2\n"), points);
  EXPECT_THAT(read("0;0\n0.1;200\n0.25;350"), points);
  EXPECT_THAT(read("0\t0\n0.1\t200\n0.25\t350\n\n"), points);
  EXPECT_THAT(read("delta, F\n0, 0\n 0.1 , 200 \n0.25,350"), points);
  EXPECT_THAT(read("\xEF\xBB\xBF\"delta [mm]\";\"F [N]\"\r\n0;0\r\n0.1;200\r\n0.25;350\r\n"), points);
  EXPECT_THAT(read("+0,+0\n+0.1,+200\n+2.5E-01,+350\n"), points);
  EXPECT_THAT(read("# bolt 7\n\n0,0 # start\n0.1,200\n  # pause\n0.25,350\n"), points);
}

TEST_F(TestPoints, KeepsTheOrderOfTheFile) {
  EXPECT_THAT(read("2,1\n1,2\n2,1\n"), ElementsAre(Point{2, 1}, Point{1, 2}, Point{2, 1}));
}

TEST_F(TestPoints, RefusesWithFileAndLine) {
  const std::string number = "allowed: a number >= 0 with a decimal point";
  EXPECT_THAT(refusal("delta,F\n0,0\n0.1,-3\n"), EndsWith("test.csv:3: '-3' is not allowed; " + number));
  EXPECT_THAT(refusal("+-0.1,3\n"), EndsWith("test.csv:1: '+-0.1' is not allowed; " + number));
  EXPECT_THAT(refusal("-0.1,3\n"), EndsWith("test.csv:1: '-0.1' is not allowed; " + number));
  EXPECT_THAT(refusal("0,0\n0.1,nan\n"), EndsWith("test.csv:2: 'nan' is not allowed; " + number));
  EXPECT_THAT(refusal("nan,nan\n"), EndsWith("test.csv:1: 'nan' is not allowed; " + number));
  EXPECT_THAT(refusal("0,inf\n"), EndsWith("test.csv:1: 'inf' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1e999\n"), EndsWith("test.csv:1: '1e999' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1 N\n"), EndsWith("test.csv:1: '1 N' is not allowed; " + number));
  EXPECT_THAT(refusal("0,1;200\n"), EndsWith("test.csv:1: '0,1' is not allowed; " + number));
  EXPECT_THAT(refusal("0.0l,2oo\n1,2\n"), EndsWith("test.csv:1: '0.0l' is not allowed; " + number));
  EXPECT_THAT(refusal("# two headers\ndelta,F\nmm,N\n"), EndsWith("test.csv:3: 'mm' is not allowed; " + number));
  EXPECT_THAT(refusal("delta,\n"), EndsWith("test.csv:1: 'delta' is not allowed; " + number));
}

TEST_F(TestPoints, RefusesOtherThanTwoColumns) {
  const std::string columns = "allowed: two columns, delta and F, parted by a comma, semicolon or tab";
  EXPECT_THAT(refusal("0,0\n1,2,3\n"), EndsWith("test.csv:2: 3 columns in '1,2,3'; " + columns));
  EXPECT_THAT(refusal("the force was measured\n"),
              EndsWith("test.csv:1: 1 column in 'the force was measured'; " + columns));
  EXPECT_THAT(refusal(""), EndsWith("test.csv: no points; " + columns));
  EXPECT_THAT(refusal("# nothing\ndelta,F\n"), EndsWith("test.csv: no points; " + columns));
}

TEST_F(TestPoints, OfNoFile) {
  EXPECT_THAT([&] { (void)read_points(folder_.path("none.csv")); },
              ThrowsMessage<FileError>(HasSubstr("none.csv: cannot be opened: No such file or directory")));
}

}  // namespace
}  // namespace fastjoint::stage3
