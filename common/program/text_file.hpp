// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::program {

/// Contents of a regular file. Throws FileError with the path and the reason.
[[nodiscard]] std::string read_text_file(const std::string& path);

}  // namespace fastjoint::program
