// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace fastjoint::h5 {

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// What a reader takes as the entries of a dataset, and what stands in for each entry of one that a file leaves out.
struct Allowed {
  std::string text = "finite numbers";  ///< what a message expects
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
  double step = -infinite;                          ///< each number is at least this above the one before
  std::optional<std::vector<std::string>> words{};  ///< what texts may be; any text without it
  std::optional<double> number{};                   ///< stands in for numbers
  std::optional<std::string> word{};                ///< stands in for texts

  [[nodiscard]] Allowed or_else(double stand_in) const {
    Allowed result = *this;
    result.number = stand_in;
    return result;
  }
};

inline const Allowed infinite_too{.text = "numbers", .low = -infinite, .high = infinite};
inline const Allowed not_negative{.text = "numbers >= 0", .low = 0, .high = infinite};
inline const Allowed positive{.text = "numbers > 0", .low = std::numeric_limits<double>::min()};

[[nodiscard]] inline Allowed or_else(double number) { return {.number = number}; }
[[nodiscard]] inline Allowed or_else(const std::string& word) { return {.word = word}; }
[[nodiscard]] inline Allowed one_of(const std::vector<std::string>& words) {
  return {.text = fmt::format("one of {}", fmt::join(words, ", ")), .words = words};
}
[[nodiscard]] inline Allowed integers(Eigen::Index low, Eigen::Index high) {
  return {.text = fmt::format("integers from {} to {}", low, high),
          .low = static_cast<double>(low),
          .high = static_cast<double>(high)};
}
/// Indices into a list of n items.
[[nodiscard]] inline Allowed index_into(Eigen::Index n) { return integers(0, n - 1); }

}  // namespace fastjoint::h5
