// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "common/pfem/space.hpp"
#include "common/units.hpp"

namespace fastjoint::formats {

// Every format is one function template `datasets(file, a)`, which an h5::Writer and an h5::Reader go through line by
// line: each line has the name of a dataset, its place in memory, shape, unit and meaning, and what a reader allows.

/// What every file says of itself.
struct Header {
  std::string generator;  ///< program and version
  std::string name;       ///< of the plate or joint
  Units units;
  std::string input;     ///< JSON text that it came from
  std::string digest{};  ///< of the file that this was read from; empty if that carries none
};

/// @tparam File An h5::Writer and a const Header, or an h5::Reader and a Header. Units are then compared only if the
/// file labels its own.
template <class File, class AnyHeader>
void header(File& file, AnyHeader& a);

/// The root attribute `space`, without which a file stays as it is. Throws FileError for a word that names no space.
template <class File, class AnySpace>
void space(File& file, AnySpace& a);

/// Names of the sides of a hole.
inline const std::vector<std::string> side_names = {"+x", "-x", "+y", "-y"};

/// Degrees from 1 to `highest`, each above the one before.
[[nodiscard]] h5::Allowed degrees(int highest);

}  // namespace fastjoint::formats
