// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace fastjoint::stage3 {

/// Column of a table (csv.hpp) whose first line names the columns; every line below has as many cells. Throws FileError
/// if it cannot be read, InputError with file, line, what was found and what is allowed.
[[nodiscard]] std::vector<double> read_column(const std::string& path, const std::string& column);

}  // namespace fastjoint::stage3
