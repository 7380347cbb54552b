// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace fastjoint::stage3 {

/// Collects warnings of one kind about several fasteners or holes and gives the worst, with the number of the others.
class WorstOfKind {
 public:
  /// @param amount Size of the doubt, > 0. @param text The warning, without a full stop.
  void add(double amount, std::string text) {
    ++count_;
    if (!(amount > worst_)) return;
    worst_ = amount;
    text_ = std::move(text);
  }
  /// Appends the warning, if there is one.
  void say(std::vector<std::string>& warnings) const {
    if (count_ == 0) return;
    warnings.push_back(count_ == 1 ? text_
                                   : fmt::format("{} ({} more likewise, this is the worst)", text_, count_ - 1));
  }

 private:
  double worst_ = 0;
  std::size_t count_ = 0;
  std::string text_;
};

}  // namespace fastjoint::stage3
