// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace fastjoint::stage3 {

/// Number in (0, 1) of a variable in a sample: (w >> 12) + 1/2 over 2^52, w the first word of Philox4x64-10 (Salmon et
/// al., SC 2011) with the key (seed, 0) and the counter (sample, variable, 0, 0). It depends on nothing else, so that
/// any sample can be made alone, in any order, and by other programs.
[[nodiscard]] double random_fraction(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable);

/// Index of a sample in a random permutation of 0..n-1 for a variable: a Feistel cipher of six rounds whose round
/// function is the first word with the counter (right half, variable, round + 1, 0), applied until the index is below
/// n. It needs no memory.
[[nodiscard]] std::uint64_t random_place(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable,
                                         std::uint64_t n);

}  // namespace fastjoint::stage3
