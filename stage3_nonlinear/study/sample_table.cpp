// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/sample_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/errors.hpp"
#include "common/input/value.hpp"

namespace fastjoint::stage3 {
namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\""), last = text.find_last_not_of(" \t\r\"");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last - first + 1);
}

std::vector<std::string_view> cells(std::string_view line) {
  std::vector<std::string_view> result;
  for (std::size_t at = 0;;) {
    const auto end = std::min(line.find(',', at), line.size());
    result.push_back(trimmed(line.substr(at, end - at)));
    if (end == line.size()) return result;
    at = end + 1;
  }
}

}  // namespace

std::vector<double> read_column(const std::string& path, const std::string& column) {
  const std::string text = input::read_text_file(path);
  std::vector<double> values;
  std::size_t at_column = 0;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    ++number;
    if (trimmed(line).empty()) continue;
    const auto all = cells(line);
    if (number == 1) {
      at_column = std::ranges::find(all, std::string_view(column)) - all.begin();
      if (at_column == all.size())
        throw InputError(fmt::format("{}: line 1: no column \"{}\"; allowed: {}", path, column, fmt::join(all, ", ")));
      continue;
    }
    const std::string_view cell = at_column < all.size() ? all[at_column] : std::string_view();
    double value = 0;
    const auto [last, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (error != std::errc() || last != cell.data() + cell.size() || cell.empty() || !std::isfinite(value))
      throw InputError(
          fmt::format("{}: line {}: \"{}\" in column \"{}\"; allowed: a finite number", path, number, cell, column));
    values.push_back(value);
  }
  if (values.empty())
    throw InputError(fmt::format("{}: no row; allowed: a line of names, then at least one of numbers", path));
  return values;
}

}  // namespace fastjoint::stage3
