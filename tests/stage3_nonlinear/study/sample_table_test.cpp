// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/variable.hpp"

#include <gmock/gmock.h>

#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace fastjoint::stage3 {
namespace {

using testing::ElementsAre;
using testing::EndsWith;

class SampleTable : public testing::Test {
 protected:
  [[nodiscard]] std::vector<double> read(const std::string& text, const std::string& column = "F") const {
    return read_column(folder_.write("t.csv", text), column);
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    return test::message_of([&] { return read(text); });
  }
  test::TemporaryFolder folder_;
};

TEST_F(SampleTable, HasAColumnByItsName) {
  const auto F = ElementsAre(1000.5, 1e3);
  EXPECT_THAT(read("F\n1000.5\n1e3\n\n \n"), F);
  EXPECT_THAT(read("# by hand\nk, F # two\n 7, 1000.5\n8,+1e3\n"), F);
  EXPECT_THAT(read("\xEF\xBB\xBF"
                   "F;k\r\n1000.5;7\r\n# no\r\n1e3;8"),
              F);
  EXPECT_THAT(read("\"k, of the bolt\",F\n\"7,5\",1000.5\n\"8 # \"\"\",1e3\n"), F)
      << "only the column asked for is read";
  EXPECT_THAT(read("a\t\"the \"\"F\"\"\"\n1\t2\n", "the \"F\""), ElementsAre(2));
}

TEST_F(SampleTable, IsRefusedWhereARowCouldMeanAnotherNumber) {
  const std::string number =
      "in column \"F\"; allowed: a number with a decimal point, 0 or of a size from 1e-100 to 1e+100";
  EXPECT_THAT(refusal("F\n1000,5\n"),
              EndsWith("t.csv:2: 2 columns below 1 of names; allowed: as many, parted as the names "
                       "are, numbers with a decimal point"));
  EXPECT_THAT(refusal("F;k\n1000,5;3\n"), EndsWith("t.csv:2: \"1000,5\" " + number));
  EXPECT_THAT(refusal("F\n1\n\n2\n"), EndsWith("t.csv:3: \"\" " + number));
  EXPECT_THAT(refusal("F,k\n1,2\n\n2,3\n"), testing::HasSubstr("t.csv:3: 1 column below 2 of names"));
  EXPECT_THAT(refusal("\nF\n1\n"), EndsWith("t.csv:1: no column \"F\"; allowed: "));
  EXPECT_THAT(refusal("F,F\n1,2\n"), EndsWith("t.csv:1: column \"F\" stands twice; allowed: each name once"));
  EXPECT_THAT(refusal("F\n\"1\n"), EndsWith("t.csv:2: a quote that is not closed; allowed: closed on its line"));
  EXPECT_THAT(refusal("F\n1e200\n"), EndsWith("t.csv:2: \"1e200\" " + number));
  EXPECT_THAT(refusal("F\ninf\n"), EndsWith("t.csv:2: \"inf\" " + number));
  EXPECT_THAT(refusal("F\n"), EndsWith("t.csv: no row; allowed: a line of names, then at least one of numbers"));
}

}  // namespace
}  // namespace fastjoint::stage3
