// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/input/value.hpp"
#include "stage3_nonlinear/study/distribution.hpp"

namespace fastjoint::stage3 {

/// Use of a drawn number at its places in JOINT.json.
enum class Use { value, factor, offset };

enum class Sampling { grid, random, latin_hypercube };
inline const std::vector<std::string> sampling_names{"grid", "random", "latin hypercube"};

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

/// The contents of STUDY.json (schemas/study.schema.json).
struct StudyScene {
  std::string file, name, text;
  std::vector<Variable> variables;
  Sampling sampling = Sampling::random;
  std::uint64_t n_samples = 0;
  std::optional<std::uint64_t> seed;  ///< none: a random one
  std::set<std::string> outputs{"forces"};
  std::vector<std::string> cases{};  ///< of the joint; empty: all
  // Limits whose exceedance is counted: of outputs by name, of loads by the ids of fasteners, and of margins by checks.
  std::map<std::string, double> limits{}, fastener_limits{}, least_margins{};
};

/// Parts of a JSON pointer without the escapes of "/" and "~".
[[nodiscard]] std::vector<std::string> parts_of_pointer(const std::string& pointer);

/// Reads a study of a joint; wildcards in its places are resolved in the joint. Throws InputError.
[[nodiscard]] StudyScene read_study_scene(const input::Document& study, const input::Document& joint);

/// Values of all variables in a sample. @param seed That of the random numbers.
[[nodiscard]] std::vector<double> sample_values(const StudyScene& study, std::uint64_t seed, std::uint64_t sample);

/// Median of a variable.
[[nodiscard]] double middle_of(const Variable& variable);
[[nodiscard]] std::vector<double> middle_values(const StudyScene& study);
/// Largest value of a variable, or one that is exceeded with negligible probability.
[[nodiscard]] double largest_of(const Variable& variable);
/// Half of the range of the middle two thirds of a distribution, or a third of the range of all levels or of a column.
[[nodiscard]] double spread_of(const Variable& variable);

}  // namespace fastjoint::stage3
