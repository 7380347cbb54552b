// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fastjoint::input {

/// A line of a table, and its number in the file, from 1, for messages.
struct CsvRow {
  int line;
  std::vector<std::string> cells;  ///< without the blanks around them and without their quotes; one or more
};

/// Reads a table whose cells are parted by semicolons, tabs or commas: the first of these that its first row has.
///
/// Separators and '#' within double quotes belong to the cell, and two quotes there are one (RFC 4180). Text after a
/// '#' is a comment; lines of comments alone and blank lines at the end are left out. A blank line elsewhere is a row
/// of one empty cell. Throws FileError if the file cannot be read, InputError for what is no text and for a quote that
/// is not closed on its line.
[[nodiscard]] std::vector<CsvRow> read_csv(const std::string& path);

/// Number that is the whole cell, written with a decimal point; none otherwise. It may be infinite or no number.
[[nodiscard]] std::optional<double> csv_number(std::string_view cell);

/// Number of a cell. Throws InputError for anything else than a number of an allowed size.
/// @param place Of the cell, FILE:LINE. @param column Its name.
[[nodiscard]] double csv_value(const std::string& cell, const std::string& place, const std::string& column);

}  // namespace fastjoint::input
