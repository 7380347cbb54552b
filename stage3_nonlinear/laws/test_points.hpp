// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

namespace fastjoint::stage3 {

/// Points (delta, F) of a fastener's test; length and force, neither negative.
using TestPoints = std::vector<std::array<double, 2>>;

/// Reads points in the order of the file.
///
/// A text file of two columns, parted by commas, semicolons or tabs, with decimal points; a first line of two names is
/// passed over, and so are empty lines and what follows a '#'. Throws InputError with file, line, what was found and
/// what is allowed; FileError if the file cannot be read.
[[nodiscard]] TestPoints read_points(const std::string& path);

}  // namespace fastjoint::stage3
