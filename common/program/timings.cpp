// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/timings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/linalg/processor.hpp"
#include "common/program/memory.hpp"
#include "common/program/progress.hpp"

namespace fastjoint::program {
namespace {

double seconds(Timings::Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

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
