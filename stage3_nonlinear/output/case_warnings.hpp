// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/program/warning.hpp"

namespace fastjoint::stage3 {

/// Warnings of all load cases: each kind once, with the first case in which it was found.
class CaseWarnings {
 public:
  void add(const std::string& case_name, const std::vector<program::Warning>& warnings);
  /// In the order in which they were added. @param n_cases Number of cases that were followed.
  [[nodiscard]] std::vector<program::Warning> all(std::size_t n_cases) const;

 private:
  struct Found {
    program::Warning warning;
    std::string case_name;
    std::size_t n_cases = 1;
    bool is_same = true;  ///< in all of these cases
  };
  std::vector<Found> found_;
  std::map<std::pair<std::string, int>, std::size_t> places_;  ///< by code and its number among those of a case
};

}  // namespace fastjoint::stage3
