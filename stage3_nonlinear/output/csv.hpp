// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <concepts>
#include <string>

namespace fastjoint::stage3 {

/// A table of RESULT.h5 as CSV (RFC 4180): all digits of numbers, none of a number that is not known.
class Csv {
 public:
  /// @param heads Line of the heads of its columns; none if they are added as cells.
  explicit Csv(const std::string& heads = "") : text_(heads.empty() ? "" : heads + "\n") {}

  /// Appends a line.
  template <class... Cells>
  void line(const Cells&... cells) {
    (add(cells), ...);
    end();
  }
  /// Appends a cell to the line, which `end` ends.
  void add(const std::string& text);
  void add(double number);
  void add(std::integral auto number) { put(std::to_string(number)); }
  void end() { text_.back() = '\n'; }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  void put(const std::string& cell) { text_ += cell, text_ += ','; }

  std::string text_;
};

/// A cell with its text, in quotes if it has a comma, a quote or a line break.
[[nodiscard]] std::string csv_field(const std::string& text);

}  // namespace fastjoint::stage3
