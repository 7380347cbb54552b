// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace fastjoint::h5 {

/// Puts `bytes` at `path` whole or not at all: a temporary file beside it, fsync, rename. Removes those that killed
/// programs have left beside it.
/// What was at `path` before survives every failure. Throws FileError with the path and the reason.
void write_whole_file(const std::string& path, std::string_view bytes);

/// Removes the temporary file that is being written, if there is one; a handler of signals may call this.
void remove_unfinished() noexcept;

/// Throws FileError unless a file could be put at `path`: asked before the work, not after it.
void check_can_write(const std::string& path);

/// Whether both paths lead to one file, which need not exist yet; an empty path leads to none.
[[nodiscard]] bool same_file(const std::string& a, const std::string& b);

}  // namespace fastjoint::h5
