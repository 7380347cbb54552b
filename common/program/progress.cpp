// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/progress.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "common/linalg/processor.hpp"
#include "common/program/memory.hpp"

namespace fastjoint::program {
namespace {

using namespace std::chrono_literals;
constexpr const char* erase = "\033[K";
Progress* present = nullptr;

double seconds(Timings::Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

Progress::Progress(std::string program, bool is_terminal, std::ostream& out, std::function<Clock::time_point()> now)
    : program_(std::move(program)), is_terminal_(is_terminal), out_(out), now_(std::move(now)), next_(now_() + 1s) {
  present = this;
}

Progress::~Progress() {
  report_share(1);
  present = nullptr;
}

void Progress::say() {
  const auto now = now_();
  const bool working = share_ < 1;
  if (now < next_ || (is_terminal_ && !working)) return;
  next_ = now + (is_terminal_ ? 100ms : 3000ms);
  constexpr double too_early = 0.05;  // to tell the rest by it
  std::string words = phase_;
  if (working && share_ > too_early)
    words += fmt::format(", {:.0f} % done, about {:.0f} s left", 100 * share_,
                         std::max(0.0, std::chrono::duration<double>(end_ - now).count()));
  constexpr int width = 20;
  if (is_terminal_)  // the cursor stays at the start, for whatever is said next
    out_ << fmt::format("[{:<{}}] {}{}\r", std::string(int(width * share_), '#'), width, words, erase) << std::flush;
  else
    out_ << fmt::format("{}: {}\n", program_, words) << std::flush;
}

void report_phase(const std::string& name) {
  if (present == nullptr) return;
  present->phase_ = name;
  present->say();
}

void report_share(double done) {
  if (present == nullptr) return;
  const auto now = present->now_();
  if (done == 0) present->start_ = now;
  using Seconds = std::chrono::duration<double>;
  if (done > 0)
    present->end_ =
        present->start_ + std::chrono::duration_cast<Progress::Clock::duration>(Seconds(now - present->start_) / done);
  if (done == 1 && present->share_ < 1 && present->is_terminal_) present->out_ << erase << std::flush;
  present->share_ = done;
  if (done < 1) present->say();
}

Timings::Timings(std::function<Clock::time_point()> now) : now_(std::move(now)), start_(now_()), mark_(start_) {}

void Timings::credit(Clock::time_point now) {
  if (!phases_.empty()) phases_[present_].second += now - mark_;
  mark_ = now;
}

void Timings::phase(const std::string& name) {
  credit(now_());
  const auto found = std::find_if(phases_.begin(), phases_.end(), [&](const auto& each) { return each.first == name; });
  present_ = found - phases_.begin();
  if (found == phases_.end()) phases_.emplace_back(name, Clock::duration::zero());
  report_phase(name);
}

void Timings::stop() {
  credit(now_());
  total_ = mark_ - start_;
}

std::string Timings::line() const {
  std::vector<std::string> phases;
  phases.reserve(phases_.size());
  for (const auto& [name, time] : phases_) phases.push_back(fmt::format("{} {:.3f}", name, seconds(time)));
  constexpr double bytes_in_mb = 1e6;
  return fmt::format("  time {:.3f} s: {}; peak memory {:.0f} MB\n", seconds(total_), fmt::join(phases, ", "),
                     peak_memory() / bytes_in_mb);
}

std::string Timings::json(const std::string& program, const std::string& version) const {
  nlohmann::ordered_json text = {
      {"program", program}, {"version", version}, {"threads", threads_}, {"blas_kernels", linalg::blas_kernels()}};
  for (const auto& [name, time] : phases_) text["seconds"][name] = seconds(time);
  text["total"] = seconds(total_);
  text["peak_memory_bytes"] = static_cast<long>(peak_memory());
  for (const auto& [p, n] : unknowns_) text["unknowns"][std::to_string(p)] = n;
  return text.dump() + "\n";
}

}  // namespace fastjoint::program
