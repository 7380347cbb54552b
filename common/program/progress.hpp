// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <string>

namespace fastjoint::program {

/// Display of how far a run of more than a second is: on a terminal a bar while the share done is known, else a line
/// every three seconds. At most one lives, which gets the reports; without one they go nowhere.
class Progress {
 public:
  using Clock = std::chrono::steady_clock;
  Progress(std::string program, bool is_terminal, std::ostream& out,
           std::function<Clock::time_point()> now = Clock::now);
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

 private:
  friend void report_phase(const std::string& name);
  friend void report_share(double done);
  void say();

  std::string program_, phase_;
  bool is_terminal_;
  std::ostream& out_;
  std::function<Clock::time_point()> now_;
  Clock::time_point next_;         ///< of what is said next
  Clock::time_point start_, end_;  ///< of the work, the second as it seemed at the last report
  double share_ = 1;               ///< done of it
};

/// Reports that a phase of the run begins.
void report_phase(const std::string& name);
/// Reports the share of the work that is done: 0 when it begins, 1 behind its end.
void report_share(double done);

}  // namespace fastjoint::program
