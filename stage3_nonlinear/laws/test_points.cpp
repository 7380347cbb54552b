// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/test_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "common/errors.hpp"
#include "common/program/program.hpp"
#include "common/program/text_file.hpp"

namespace fastjoint::stage3 {
namespace {

using Fields = std::vector<std::string_view>;

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets write one
constexpr const char* columns = "two columns, delta and F, parted by a comma, semicolon or tab";

std::string_view trimmed(std::string_view text) {
  constexpr const char* blank = " \t\r";
  const auto first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

Fields split(std::string_view line) {
  const char separator = line.find(';') != line.npos ? ';' : line.find('\t') != line.npos ? '\t' : ',';
  Fields fields;
  while (true) {
    const auto end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == line.npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> number(std::string_view field) {
  double value = 0;
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);  // from_chars knows no plus
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

/// Two names; a slip of the pen in the first point is none: it begins as a number does.
bool is_header(const Fields& fields) {
  return std::all_of(fields.begin(), fields.end(), [](std::string_view field) {
    return !field.empty() && !number(field) && std::string_view("0123456789+-.").find(field.front()) == field.npos;
  });
}

double checked(std::string_view field, const std::string& place) {
  const auto value = number(field);
  if (!value || !std::isfinite(*value) || *value < 0)
    throw InputError(fmt::format("{}: '{}' is not allowed; allowed: a number >= 0 with a decimal point", place, field));
  return *value;
}

}  // namespace

TestPoints read_points(const std::string& path) {
  const std::string text = program::read_text_file(path);
  std::string_view rest = text;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  TestPoints points;
  bool first = true;
  for (int n_line = 1; !rest.empty(); ++n_line) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const auto line = trimmed(rest.substr(0, std::min(end, rest.find('#'))));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.empty()) continue;
    const std::string place = fmt::format("{}:{}", path, n_line);
    const Fields fields = split(line);
    if (fields.size() != 2)
      throw InputError(
          fmt::format("{}: {} in '{}'; allowed: {}", place, program::counted(fields.size(), "column"), line, columns));
    if (!std::exchange(first, false) || !is_header(fields))
      points.push_back({checked(fields[0], place), checked(fields[1], place)});
  }
  if (points.empty()) throw InputError(fmt::format("{}: no points; allowed: {}", path, columns));
  return points;
}

}  // namespace fastjoint::stage3
