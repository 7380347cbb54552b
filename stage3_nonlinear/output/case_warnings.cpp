// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/case_warnings.hpp"

#include <fmt/format.h>

#include "common/program/program.hpp"

namespace fastjoint::stage3 {

void CaseWarnings::add(const std::string& case_name, const std::vector<program::Warning>& warnings) {
  std::map<std::string, int> counts;
  for (const auto& each : warnings) {
    const auto [place, is_new] = places_.try_emplace({each.code, counts[each.code]++}, found_.size());
    if (is_new) {
      found_.push_back({each, case_name});
      continue;
    }
    Found& known = found_[place->second];
    ++known.n_cases;
    known.is_same &= known.warning.text == each.text;
  }
}

std::vector<program::Warning> CaseWarnings::all(std::size_t n_cases) const {
  std::vector<program::Warning> warnings;
  for (const auto& [warning, name, n, is_same] : found_) {
    warnings.push_back(warning);
    if (n_cases == 1 || (n == n_cases && is_same)) continue;
    warnings.back().text += fmt::format(" (case \"{}\"{})", name,
                                        n == 1 ? "" : fmt::format(" and {} more", program::counted(n - 1, "case")));
  }
  return warnings;
}

}  // namespace fastjoint::stage3
