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
Progress* current = nullptr;

double seconds(Timings::Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

Progress::Progress(std::string program, bool is_terminal, std::ostream& out, std::function<Clock::time_point()> now)
    : program_(std::move(program)), is_terminal_(is_terminal), out_(out), now_(std::move(now)), next_(now_() + 1s) {
  current = this;
}

Progress::~Progress() {
  report_share(1);
  current = nullptr;
}

void Progress::say() {
  const auto now = now_();
  const bool working = fraction_ < 1;
  if (now < next_ || (is_terminal_ && !working)) return;
  next_ = now + (is_terminal_ ? 100ms : 3000ms);
  constexpr double min_fraction = 0.05;  // below it the remaining time is too uncertain
  std::string words = phase_;
  if (working && fraction_ > min_fraction)
    words += fmt::format(", {:.0f} % done, about {:.0f} s left", 100 * fraction_,
                         std::max(0.0, std::chrono::duration<double>(end_ - now).count()));
  constexpr int width = 20;
  if (is_terminal_)  // the cursor stays at the start, so that the next output overwrites the bar
    out_ << fmt::format("[{:<{}}] {}{}\r", std::string(int(width * fraction_), '#'), width, words, erase) << std::flush;
  else
    out_ << fmt::format("{}: {}\n", program_, words) << std::flush;
}

void report_phase(const std::string& name) {
  if (current == nullptr) return;
  current->phase_ = name;
  current->say();
}

void report_share(double done) {
  if (current == nullptr) return;
  const auto now = current->now_();
  if (done == 0) current->start_ = now;
  using Seconds = std::chrono::duration<double>;
  if (done > 0)
    current->end_ =
        current->start_ + std::chrono::duration_cast<Progress::Clock::duration>(Seconds(now - current->start_) / done);
  if (done == 1 && current->fraction_ < 1 && current->is_terminal_) current->out_ << erase << std::flush;
  current->fraction_ = done;
  if (done < 1) current->say();
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
