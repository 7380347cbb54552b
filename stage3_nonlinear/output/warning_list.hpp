// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/program/warning.hpp"

namespace fastjoint::stage3 {

/// Warnings in the order in which their kinds were found. Of doubts of one kind, about several fasteners or holes, the
/// worst stands for all, with the number of the others.
class WarningList {
 public:
  template <class... Values>
  void add(const char* code, fmt::format_string<const Values&...> text, const Values&... values) {
    found_.push_back({{code, fmt::format(text, values...)}});
  }
  /// @param measure How bad it is, > 0.
  template <class... Values>
  void doubt(const char* code, double measure, fmt::format_string<const Values&...> text, const Values&... values) {
    const auto is_alike = [&](const Found& each) { return each.measure > 0 && each.warning.code == std::string(code); };
    auto worst = std::ranges::find_if(found_, is_alike);
    if (worst == found_.end()) worst = found_.insert(worst, Found{{code, ""}});
    ++worst->n;
    if (measure > worst->measure) worst->measure = measure, worst->warning.text = fmt::format(text, values...);
  }
  [[nodiscard]] std::vector<program::Warning> all() const {
    std::vector<program::Warning> warnings;
    for (auto [warning, measure, n] : found_) {
      if (n > 1) warning.text += fmt::format(" ({} more of this kind, this is the worst)", n - 1);
      warnings.push_back(std::move(warning));
    }
    return warnings;
  }

 private:
  struct Found {
    program::Warning warning;
    double measure = 0;  ///< of the worst doubt; 0 of others
    int n = 0;           ///< number of doubts
  };
  std::vector<Found> found_;
};

}  // namespace fastjoint::stage3
