// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/processor.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fastjoint::linalg {
namespace {

class Threads : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_threads(GetParam()); }
  void TearDown() override { set_threads(1); }
};

TEST_P(Threads, TakeEveryIndexOnce) {
  for (const std::size_t n : {0U, 1U, 2U, 1000U}) {
    std::vector<int> calls(n, 0);
    for_each_index(n, [&](std::size_t i) { ++calls[i]; });
    EXPECT_EQ(calls, std::vector<int>(n, 1));
  }
}

TEST_P(Threads, ALoopInsideAnotherTakesEveryIndexOnce) {
  std::vector<std::vector<int>> calls(9, std::vector<int>(100, 0));
  for_each_index(calls.size(),
                 [&](std::size_t i) { for_each_index(calls[i].size(), [&](std::size_t j) { ++calls[i][j]; }); });
  EXPECT_EQ(calls, std::vector(9, std::vector<int>(100, 1)));
}

TEST_P(Threads, AnExceptionReachesTheCaller) {
  std::atomic<int> n_calls = 0;
  const auto loop = [&] {
    for_each_index(100000, [&](std::size_t i) {
      ++n_calls;
      if (i == 17) throw std::runtime_error("seventeen");
      // Calls that took no time could all be over before the system lets the throwing thread go on.
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    });
  };
  EXPECT_THROW(loop(), std::runtime_error);
  EXPECT_LT(n_calls, 100000);
  EXPECT_NO_THROW(for_each_index(3, [](std::size_t) {})) << "and the next loop runs";
}

INSTANTIATE_TEST_SUITE_P(Numbers, Threads, testing::Values(1, 2, 7));

}  // namespace
}  // namespace fastjoint::linalg
