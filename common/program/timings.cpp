// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/timings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace fastjoint::program {
namespace {

constexpr long bytes_in_kib = 1024;

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
                     static_cast<double>(peak_memory()) / bytes_in_mb);
}

std::string Timings::json(const std::string& program, const std::string& version) const {
  nlohmann::ordered_json text = {{"program", program}, {"version", version}, {"threads", threads_}};
  for (const auto& [name, time] : phases_) text["seconds"][name] = seconds(time);
  text["total"] = seconds(total_);
  text["peak_memory_bytes"] = peak_memory();
  for (const auto& [p, n] : unknowns_) text["unknowns"][std::to_string(p)] = n;
  return text.dump() + "\n";
}

long peak_memory() {
  // A child begins with its parent's ru_maxrss: what a large Python script starts would seem as large. VmHWM does not.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (long kib = 0; word == "VmHWM:" && status >> kib) return kib * bytes_in_kib;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss * bytes_in_kib;
}

}  // namespace fastjoint::program
