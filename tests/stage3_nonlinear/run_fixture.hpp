// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <map>
#include <sstream>
#include <string>

#include "stage3_nonlinear/run.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"
#include "tests/support/result.hpp"

namespace fastjoint::stage3 {

using Members = std::map<std::string, std::string>;

/// A joint in a folder of its own, run in this process.
class Run : public testing::Test {
 protected:
  void write(const Members& members, const test::Lap& lap = test::two_fastener_lap()) {
    options_ = {test::write_joint(folder_, lap, members), folder_.path("result.h5"), "", false, {{"--csv", csv_}}};
  }
  void run() { stage3::run(options_, out_, log_, timings_); }
  [[nodiscard]] test::Result result() const { return test::Result(options_.output); }

  test::TemporaryFolder folder_;
  const std::string csv_ = folder_.path("result.csv");
  program::Arguments options_;
  std::ostringstream out_, log_;
  program::Timings timings_;
};

/// A law that carries 3.025 at most, in series: load factor 3.5 has no equilibrium (load_path_test.cpp).
inline const Members overloaded{{"laws", R"({"weak": {"type": "cubic", "delta": [1, 2, 3], "F": [1, 1.8, 2.4]}})"},
                                {"fasteners", R"([{"id": "left bolt", "between": ["a:1", "b:1"], "law": "weak"}])"},
                                {"loads", R"([{"external": "a:P", "force": 1}])"},
                                {"increments", "[1, 2, 3.5, 4]"}};

}  // namespace fastjoint::stage3
