// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fastjoint::program {

/// Progress display of a run of more than a second: on a terminal a bar while the completed fraction is known, else a
/// line every three seconds. At most one exists at a time and receives the reports; without one they are ignored.
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
  Clock::time_point next_;         ///< time of the next output
  Clock::time_point start_, end_;  ///< start of the work, and its end as estimated at the last report
  double fraction_ = 1;            ///< completed fraction of the work
};

/// Reports that a phase of the run begins.
void report_phase(const std::string& name);
/// Reports the completed fraction of the work: 0 at its start, 1 at its end.
void report_share(double done);

/// Cost of a run: wall time by phase and in total, counted from construction, and memory.
class Timings {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Timings(std::function<Clock::time_point()> now = Clock::now);

  /// Ends the current phase, if any, and starts `name`, which is reported as progress; time adds to an earlier phase of
  /// the same name.
  void phase(const std::string& name);
  /// Ends the last phase and the total.
  void stop();

  /// Number of threads that the run may use; 1 unless set.
  void set_threads(int n) { threads_ = n; }
  /// Records the size of the problem: n unknowns at degree p.
  void set_unknowns(int p, int n) { unknowns_[p] = n; }

  /// Last line of a summary, after stop(): "  time 0.213 s: read 0.001, solve 0.030; peak memory 143 MB" and a line
  /// break, phases in the order in which they first began.
  [[nodiscard]] std::string line() const;
  /// The full timings as a JSON object, after stop(): "program", "version", "threads", "blas_kernels", "seconds" by
  /// phase, "total" in seconds, "peak_memory_bytes" and, if any were set, "unknowns" by degree.
  [[nodiscard]] std::string json(const std::string& program, const std::string& version) const;

 private:
  /// Adds the time since `mark_` to the current phase.
  void credit(Clock::time_point now);

  std::function<Clock::time_point()> now_;
  Clock::time_point start_, mark_;
  Clock::duration total_{};
  std::vector<std::pair<std::string, Clock::duration>> phases_;
  std::size_t present_ = 0;  ///< index into phases_, if there are any
  int threads_ = 1;
  std::map<int, int> unknowns_;
};

}  // namespace fastjoint::program
