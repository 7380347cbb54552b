// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/progress.hpp"

#include <gmock/gmock.h>

#include <string>

namespace fastjoint::program {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

/// A clock that the test moves.
class ByHand : public testing::Test {
 protected:
  void wait(int milliseconds) { now_ += std::chrono::milliseconds(milliseconds); }
  /// Enters the phase and stays in it.
  void spend(const std::string& phase, int milliseconds) {
    timings_.phase(phase);
    wait(milliseconds);
  }
  Timings::Clock::time_point now_;
  Timings timings_{[this] { return now_; }};
};

TEST_F(ByHand, PhasesAddUpInTheOrderInWhichTheyBegan) {
  wait(1000);  // in no phase, in the total all the same
  spend("read", 1);
  for (int p = 1; p <= 3; ++p) {
    spend("solve", 250);
    spend("factorise", 20);
    spend("factorise", 10);
  }
  spend("read", 2);
  timings_.stop();
  EXPECT_THAT(timings_.line(), MatchesRegex("  time 1\\.843 s: read 0\\.003, solve 0\\.750, factorise 0\\.090; "
                                            "peak memory [1-9][0-9]* MB\n"));
}

TEST_F(ByHand, TimeAfterTheStopIsNoPartOfTheRun) {
  spend("write", 5);
  timings_.stop();
  const std::string line = timings_.line();
  wait(100);
  EXPECT_EQ(timings_.line().substr(0, 35), line.substr(0, 35));
  EXPECT_THAT(line, StartsWith("  time 0.005 s: write 0.005; "));
}

TEST_F(ByHand, JsonHasAllDigits) {
  spend("mesh", 125);
  now_ += std::chrono::nanoseconds(1);
  spend("write", 500);
  timings_.stop();
  EXPECT_THAT(timings_.json("stage1_plate", "1.0.0"),
              MatchesRegex("\\{\"program\":\"stage1_plate\",\"version\":\"1\\.0\\.0\",\"threads\":1,"
                           "\"blas_kernels\":\"[A-Za-z]*\","
                           "\"seconds\":\\{\"mesh\":0\\.125000001,\"write\":0\\.5\\},\"total\":0\\.625000001,"
                           "\"peak_memory_bytes\":[0-9]+\\}\n"));
  timings_.set_threads(2);
  timings_.set_unknowns(8, 51234);
  timings_.set_unknowns(7, 40000);
  timings_.set_unknowns(10, 90000);
  EXPECT_THAT(timings_.json("a", "b"), HasSubstr("\"threads\":2,"));
  EXPECT_THAT(timings_.json("a", "b"), testing::EndsWith(",\"unknowns\":{\"7\":40000,\"8\":51234,\"10\":90000}}\n"));
}

TEST(Timings, TheClockRuns) {
  Timings timings;
  timings.phase("read");
  const auto start = Timings::Clock::now();
  while (Timings::Clock::now() - start < std::chrono::milliseconds(2)) continue;
  timings.stop();
  EXPECT_THAT(timings.json("a", "b"), Not(HasSubstr("\"total\":0.0,")));
  EXPECT_THAT(timings.line(), Not(HasSubstr("read 0.000")));
}

}  // namespace
}  // namespace fastjoint::program
