// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// Distribution of a number, by its quantiles.
struct Distribution {
  std::function<double(double)> at{};  ///< quantile of a probability in (0, 1)
  double largest = 0;                  ///< the largest number, or one that is exceeded with negligible probability
};

/// Use of a drawn number at its places in JOINT.json.
enum class Use { value, factor, offset };

/// A number that a study varies, at one place of JOINT.json or at several places together.
struct Variable {
  std::string name;
  std::vector<std::string> places;  ///< JSON pointers
  Use use = Use::value;
  std::string where;  ///< in STUDY.json, for messages
  /// For the summary: which fastener or load each place that is given by an index belongs to.
  std::vector<std::string> remarks{};
  std::vector<double> listed{};  ///< levels of "values" and "grid", or the value of each sample from a table
  std::string table{};           ///< path of that table
  std::shared_ptr<const Distribution> distribution{};  ///< given, or that of levels with equal probabilities
};

/// Reads the source of a variable's numbers: "values", "grid", "table" or "distribution". Throws InputError.
void read_numbers(const input::Value& value, Variable& variable);

/// Column of a table (csv.hpp) whose first line names the columns; every line below has as many cells. Throws FileError
/// if it cannot be read, InputError with file, line, what was found and what is allowed.
[[nodiscard]] std::vector<double> read_column(const std::string& path, const std::string& column);

/// Median of a variable.
[[nodiscard]] double middle_of(const Variable& variable);
/// Largest value of a variable, or one that is exceeded with negligible probability.
[[nodiscard]] double largest_of(const Variable& variable);
/// Half of the range of the middle two thirds of a distribution, or a third of the range of all levels or of a column.
[[nodiscard]] double spread_of(const Variable& variable);

/// Number in (0, 1) of a variable in a sample: (w >> 12) + 1/2 over 2^52, w the first word of Philox4x64-10 (Salmon et
/// al., SC 2011) with the key (seed, 0) and the counter (sample, variable, 0, 0). It depends on nothing else, so that
/// any sample can be made alone, in any order, and by other programs.
[[nodiscard]] double random_fraction(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable);

/// Index of a sample in a random permutation of 0..n-1 for a variable: a Feistel cipher of six rounds whose round
/// function is the first word with the counter (right half, variable, round + 1, 0), applied until the index is below
/// n. It needs no memory.
[[nodiscard]] std::uint64_t random_place(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable,
                                         std::uint64_t n);

}  // namespace fastjoint::stage3
