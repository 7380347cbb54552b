// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "common/errors.hpp"
#include "common/input/value.hpp"

namespace fastjoint::input {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";  // spreadsheets write one
constexpr const char* blank = " \t\r";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(blank);
  return first == text.npos ? std::string_view() : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// The line without its comment, and its separators (of all kinds) outside quotes.
struct Scan {
  std::string_view content;
  std::vector<std::size_t> separators;
  bool closed = true;  ///< all quotes
};

Scan scan(std::string_view line) {
  Scan result;
  for (std::size_t at = 0; at < line.size(); ++at) {
    if (line[at] == '"') result.closed = !result.closed;
    if (!result.closed) continue;
    if (line[at] == '#') {
      line = line.substr(0, at);
      break;
    }
    if (std::string_view(";\t,").find(line[at]) != line.npos) result.separators.push_back(at);
  }
  result.content = line;
  return result;
}

std::string unquoted(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string text;
  cell = cell.substr(1, cell.size() - 2);
  for (std::size_t at = 0; at < cell.size(); ++at) {
    text += cell[at];
    if (cell[at] == '"') ++at;
  }
  return text;
}

std::vector<std::string> cells(const Scan& line, char separator) {
  std::vector<std::string> result;
  std::size_t from = 0;
  const auto add = [&](std::size_t to) {
    result.push_back(unquoted(trimmed(line.content.substr(from, to - from))));
    from = to + 1;
  };
  for (const auto at : line.separators)
    if (line.content[at] == separator) add(at);
  add(line.content.size());
  return result;
}

/// Separator of the rows: that which the first row has.
char separator_of(const Scan& first) {
  for (const char each : {';', '\t'})
    if (std::ranges::any_of(first.separators, [&](auto at) { return first.content[at] == each; })) return each;
  return ',';
}

}  // namespace

std::vector<CsvRow> read_csv(const std::string& path) {
  const std::string text = read_text_file(path);
  check_is_text(path, text);
  std::string_view rest = text;
  if (rest.starts_with(byte_order_mark)) rest.remove_prefix(byte_order_mark.size());
  std::vector<CsvRow> rows;
  std::optional<char> separator;
  std::size_t n_full = 0;  // rows up to the last that is not blank
  for (int number = 1; !rest.empty(); ++number) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const auto line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const Scan found = scan(line);
    if (!found.closed)
      throw InputError(fmt::format("{}:{}: a quote that is not closed; allowed: closed on its line", path, number));
    const bool is_blank = trimmed(found.content).empty();
    if (is_blank && !trimmed(line).empty()) continue;  // a comment alone
    if (!is_blank && !separator) separator = separator_of(found);
    rows.push_back({number, cells(found, is_blank ? ',' : *separator)});
    if (!is_blank) n_full = rows.size();
  }
  rows.resize(n_full);
  return rows;
}

std::optional<double> csv_number(std::string_view cell) {
  double value = 0;
  if (cell.size() > 1 && cell[0] == '+' && cell[1] != '-') cell.remove_prefix(1);  // from_chars knows no plus
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

double csv_value(const std::string& cell, const std::string& place, const std::string& column) {
  const auto value = csv_number(cell);
  if (!value || !has_allowed_size(*value))
    throw InputError(fmt::format(
        "{}: \"{}\" in column \"{}\"; allowed: a number with a decimal point, 0 or of a size from 1e-100 to "
        "1e+100",
        place, cell, column));
  return *value;
}

}  // namespace fastjoint::input
