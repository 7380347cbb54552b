// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "tests/support/files.hpp"

namespace fastjoint::test {

/// The three programs as a user calls them: words after the name, files in the folder.
[[nodiscard]] Run stage1(const TemporaryFolder& folder, const std::string& words);
[[nodiscard]] Run stage2(const TemporaryFolder& folder, const std::string& words);
[[nodiscard]] Run stage3(const TemporaryFolder& folder, const std::string& words);

/// Contents of a file of examples/three_fasteners.
[[nodiscard]] std::string example(const std::string& name);

/// The same text with one piece replaced, which must be in it.
[[nodiscard]] std::string replaced(std::string text, const std::string& what, const std::string& by);

/// Makes center.m.h5 and doubler.m.h5 of the three-fastener joint in the folder.
void make_matrices(const TemporaryFolder& folder);

/// A joint of these plates: three linear fasteners of stiffness k and a load at the centre sheet's edge.
/// @param first     More members of fastener 1, each with a comma before it. @param all The same for every fastener.
[[nodiscard]] std::string three_fastener_joint(double k, double load, const std::string& first = "",
                                               const std::string& all = "");

}  // namespace fastjoint::test
