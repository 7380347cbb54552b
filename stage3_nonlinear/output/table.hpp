// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fastjoint::stage3 {

/// A table of the summary below lines of headings. Numbers that are not finite are "-".
class Table {
 public:
  using Cell = std::variant<double, std::string>;
  using Cells = std::vector<Cell>;

  /// @param format Of a row, "{:<24} {:>14.6g}"; texts among its numbers are aligned alike.
  Table(std::string format, const std::vector<Cells>& head) : format_(std::move(format)) {
    for (const auto& cells : head) head_ += line(cells);
  }
  /// Adds a row. @param cells One for each field of the format.
  void row(const Cells& cells) { rows_ += line(cells); }
  /// Empty without rows.
  [[nodiscard]] std::string text() const { return rows_.empty() ? rows_ : head_ + rows_; }

 private:
  [[nodiscard]] std::string line(const Cells& cells) const {
    std::string text = "  ";
    std::size_t from = 0;
    for (const auto& cell : cells) {
      const std::string field = format_.substr(from, format_.find('}', from) + 1 - from);
      from += field.size();
      if (const double* number = std::get_if<double>(&cell); number && std::isfinite(*number))
        text += fmt::format(fmt::runtime(field), *number);
      else
        text += fmt::format(fmt::runtime(field.substr(0, field.find_first_of(".}")) + "}"),
                            number ? "-" : std::get<std::string>(cell));
    }
    return text.substr(0, text.find_last_not_of(' ') + 1) + "\n";
  }

  std::string format_, head_, rows_;
};

}  // namespace fastjoint::stage3
