// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/errors.hpp"

namespace fastjoint::stage2 {
namespace {

/// Index of the longest name that the text starts with and that ends there, at a comma or at "=", or -1.
std::ptrdiff_t first_case(const std::vector<std::string>& names, std::string_view text) {
  std::ptrdiff_t longest = -1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& name = names[i];
    if (!text.starts_with(name)) continue;
    if (text.size() > name.size() && text[name.size()] != ',' && text[name.size()] != '=') continue;
    if (longest < 0 || name.size() > names[longest].size()) longest = i;
  }
  return longest;
}

/// The amount at the start of the text, which then loses it.
double take_amount(std::string_view& text, const std::string& name) {
  if (text.empty() || text[0] != '=') return 1;
  const auto word = text.substr(1, text.find(',') - 1);
  double amount = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), amount);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(amount))
    throw InputError(
        fmt::format("--field: '{}' is not allowed as the amount of {}; allowed: a number such as 0.01", word, name));
  text.remove_prefix(1 + word.size());
  return amount;
}

}  // namespace

bool starts_as_case(const std::string& spec) {
  constexpr std::string_view kinds[] = {"external:", "disc:", "friction:", "traction:"};
  return std::any_of(std::begin(kinds), std::end(kinds), [&](auto kind) { return spec.starts_with(kind); });
}

std::string case_sum_allowed(const formats::PlateSolution& plate) {
  return fmt::format("a RESULT.h5, or a sum CASE=AMOUNT,... of the cases {}", listed(case_names(plate)));
}

FieldState case_sum(const formats::PlateSolution& plate, const std::string& spec) {
  const auto names = case_names(plate);
  FieldState state;
  state.words = spec;
  state.amounts = Eigen::VectorXd::Zero(names.size());
  std::vector<bool> given(names.size());
  for (std::string_view rest = spec;;) {
    const auto found = first_case(names, rest);
    if (found < 0)
      throw InputError(fmt::format("--field: '{}' is not a case of the plate{}; allowed: loads, {}", rest,
                                   starts_as_case(spec) ? "" : " nor a file", case_sum_allowed(plate)));
    if (given[found]) throw InputError(fmt::format("--field: {} stands twice; allowed: each case once", names[found]));
    given[found] = true;
    rest.remove_prefix(names[found].size());
    state.amounts[found] = take_amount(rest, names[found]);
    if (rest.empty()) return state;
    rest.remove_prefix(1);  // the comma
  }
}

}  // namespace fastjoint::stage2
