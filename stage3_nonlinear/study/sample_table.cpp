// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/sample_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>

#include "common/errors.hpp"
#include "common/input/csv.hpp"
#include "common/input/value.hpp"
#include "common/program/program.hpp"

namespace fastjoint::stage3 {
namespace {

std::size_t find_column(const input::CsvRow& header, const std::string& path, const std::string& column) {
  const auto found = std::ranges::find(header.cells, column);
  if (found == header.cells.end())
    throw InputError(
        fmt::format("{}:{}: no column \"{}\"; allowed: {}", path, header.line, column, fmt::join(header.cells, ", ")));
  if (std::ranges::count(header.cells, column) > 1)
    throw InputError(
        fmt::format("{}:{}: column \"{}\" stands twice; allowed: each name once", path, header.line, column));
  return found - header.cells.begin();
}

}  // namespace

std::vector<double> read_column(const std::string& path, const std::string& column) {
  const auto rows = input::read_csv(path);
  if (rows.size() < 2)
    throw InputError(fmt::format("{}: no row; allowed: a line of names, then at least one of numbers", path));
  const auto at = find_column(rows.front(), path, column);
  const auto n_columns = rows.front().cells.size();
  std::vector<double> values;
  for (const auto& [line, cells] : std::span(rows).subspan(1)) {
    if (cells.size() != n_columns)
      throw InputError(
          fmt::format("{}:{}: {} below {} of names; allowed: as many, parted as the names are, numbers with a "
                      "decimal point",
                      path, line, program::counted(cells.size(), "column"), n_columns));
    const auto value = input::csv_number(cells[at]);
    if (!value || !input::has_allowed_size(*value))
      throw InputError(
          fmt::format("{}:{}: \"{}\" in column \"{}\"; allowed: a number with a decimal point, 0 or of a size "
                      "from 1e-100 to 1e+100",
                      path, line, cells[at], column));
    values.push_back(*value);
  }
  return values;
}

}  // namespace fastjoint::stage3
