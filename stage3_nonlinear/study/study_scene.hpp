// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/input/value.hpp"
#include "stage3_nonlinear/study/variable.hpp"

namespace fastjoint::stage3 {

enum class Sampling { grid, random, latin_hypercube };
inline const std::vector<std::string> sampling_names{"grid", "random", "latin hypercube"};

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

/// Parts of a JSON pointer without the escapes of "/" and "~". Throws nlohmann::json::parse_error.
[[nodiscard]] std::vector<std::string> parts_of_pointer(const std::string& pointer);

/// Reads a study of a joint; wildcards in its places are resolved in the joint. Throws InputError.
[[nodiscard]] StudyScene read_study_scene(const input::Document& study, const input::Document& joint);

/// Values of all variables in a sample. @param seed That of the random numbers.
[[nodiscard]] std::vector<double> sample_values(const StudyScene& study, std::uint64_t seed, std::uint64_t sample);

/// Medians of all variables.
[[nodiscard]] std::vector<double> middle_values(const StudyScene& study);

}  // namespace fastjoint::stage3
