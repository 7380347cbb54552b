// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "common/pfem/space.hpp"
#include "common/units.hpp"

namespace fastjoint::formats {

/// The unit that a dataset must have in a file with these labels; "", any unit, in a file without labels.
[[nodiscard]] std::string expected_unit(const Units& units, int length_power, int force_power);

/// What every file says of itself.
struct Header {
  std::string generator;  ///< program and version
  std::string name;       ///< of the plate or joint
  Units units;
  std::string input;     ///< JSON text that it came from
  std::string digest{};  ///< of the file that this was read from; empty if that carries none
};

void write_header(h5::Writer& file, const Header& header);
[[nodiscard]] Header read_header(const h5::Reader& file);

/// Throws FileError if one of the words of a dataset is none of those allowed.
void check_words(const h5::Reader& file, const char* dataset, const std::vector<std::string>& words,
                 const std::vector<std::string>& allowed);
/// Names of the sides of a hole.
inline const std::vector<std::string> side_names = {"+x", "-x", "+y", "-y"};

/// Whether each number is above the one before.
[[nodiscard]] bool ascends(const Eigen::VectorXi& list);
/// Throws FileError unless a dataset holds at least one degree, each above the one before, from 1 to `highest`.
void check_degrees(const h5::Reader& file, const char* dataset, const Eigen::VectorXi& p, int highest);

/// The root attribute `space`: the trunk space in a file without it. Throws FileError for a word that names no space.
void write_space(h5::Writer& file, pfem::Space space);
[[nodiscard]] pfem::Space read_space(const h5::Reader& file);

}  // namespace fastjoint::formats
