// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/input/value.hpp"
#include "stage3_nonlinear/study/distribution.hpp"

namespace fastjoint::stage3 {

/// What a drawn number does at its places in JOINT.json.
enum class Use { value, factor, offset };

enum class Sampling { grid, random, latin_hypercube };

/// A number that a study varies, at one place of JOINT.json or at several together.
struct Variable {
  std::string name;
  std::vector<std::string> places;  ///< JSON pointers
  Use use = Use::value;
  std::string where;  ///< in STUDY.json, for messages
  // One of these:
  std::shared_ptr<const Distribution> distribution{};  ///< also of `levels`, each as often
  std::vector<double> levels{};                        ///< of "values" and "grid"
  std::vector<double> column{};                        ///< of a table: of each sample
  std::string table{};                                 ///< path of that table
};

/// STUDY.json as it stands (schemas/study.schema.json).
struct StudyScene {
  std::string file, name, text;
  std::vector<Variable> variables;
  Sampling sampling = Sampling::random;
  std::uint64_t n_samples = 0;
  std::optional<std::uint64_t> seed;  ///< none: to be drawn
  bool peaks = false, displacements = false;
  std::optional<double> most_force, most_peak;  ///< limits whose exceedance is counted
};

/// Reads a study of a joint; wildcards in its places are looked up in the joint. Throws InputError.
[[nodiscard]] StudyScene read_study_scene(const input::Document& study, const input::Document& joint);

/// Values of all variables in a sample. @param seed Of the numbers that are drawn.
[[nodiscard]] std::vector<double> sample_values(const StudyScene& study, std::uint64_t seed, std::uint64_t sample);

/// Middle of a variable: the value with as much below as above it.
[[nodiscard]] double middle_of(const Variable& variable);
/// Its largest value, or one that hardly any sample exceeds.
[[nodiscard]] double largest_of(const Variable& variable);
/// Half of the width within which two thirds of its values lie, or a third of that of all levels or of a column.
[[nodiscard]] double spread_of(const Variable& variable);

}  // namespace fastjoint::stage3
