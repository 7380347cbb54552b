// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::stage3 {

/// A field of a CSV, in quotes if it has a comma, a quote or a line break (RFC 4180).
[[nodiscard]] inline std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace fastjoint::stage3
