// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/progress.hpp"

#include <gmock/gmock.h>

#include <cstddef>
#include <new>
#include <sstream>

namespace fastjoint::program {
namespace {

/// Runs by a clock that the test moves.
class Watched {
 public:
  explicit Watched(bool is_terminal) : progress_("stage1_plate", is_terminal, out_, [this] { return now_; }) {}
  void wait(int milliseconds) { now_ += std::chrono::milliseconds(milliseconds); }
  /// What has been said since the last call.
  std::string said() {
    std::string text = out_.str();
    out_.str("");
    return text;
  }

 private:
  std::ostringstream out_;
  Progress::Clock::time_point now_;
  Progress progress_;
};

TEST(Progress, IsSilentForASecond) {
  for (const bool is_terminal : {false, true}) {
    Watched run(is_terminal);
    report_share(0);
    report_phase("read");
    run.wait(999);
    report_phase("solve");
    report_share(0.5);
    EXPECT_EQ(run.said(), "");
  }
}

TEST(Progress, IsALineEveryThreeSeconds) {
  Watched run(false);
  run.wait(1000);
  Timings timings;
  timings.phase("solve");
  EXPECT_EQ(run.said(), "stage1_plate: solve\n");
  report_share(0);
  run.wait(2000);
  report_share(0.2);
  EXPECT_EQ(run.said(), "");
  run.wait(1000);
  report_phase("factorise");
  EXPECT_EQ(run.said(), "stage1_plate: factorise, 20 % done, about 7 s left\n");
  run.wait(30000);
  report_phase("solve");
  EXPECT_EQ(run.said(), "stage1_plate: solve, 20 % done, about 0 s left\n");
  run.wait(3000);
  report_share(1);
  EXPECT_EQ(run.said(), "");
  report_phase("write");
  EXPECT_EQ(run.said(), "stage1_plate: write\n");
}

TEST(Progress, IsABarOnATerminalWhileItsLengthIsKnown) {
  Watched run(true);
  run.wait(1000);
  report_phase("read");
  EXPECT_EQ(run.said(), "");
  report_share(0);
  report_phase("solve");
  EXPECT_EQ(run.said(), "[                    ] read\033[K\r");
  run.wait(1000);
  report_share(0.25);
  EXPECT_EQ(run.said(), "[#####               ] solve, 25 % done, about 3 s left\033[K\r");
  report_share(0.5);
  EXPECT_EQ(run.said(), "");
  run.wait(100);
  report_share(1);
  EXPECT_EQ(run.said(), "\033[K");
  report_phase("write");
  EXPECT_EQ(run.said(), "");
}

TEST(Progress, ReportsWithoutOneGoNowhere) {
  std::ostringstream out;
  Progress::Clock::time_point now;
  alignas(Progress) std::byte memory[sizeof(Progress)];  // which outlives it
  auto* const progress = new (memory) Progress("stage1_plate", false, out, [&] { return now; });
  progress->~Progress();
  now += std::chrono::seconds(10);
  report_phase("solve");
  report_share(0.5);
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace fastjoint::program
