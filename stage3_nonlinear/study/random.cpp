// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/random.hpp"

#include <Random123/philox.h>

namespace fastjoint::stage3 {
namespace {

std::uint64_t word(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return r123::Philox4x64()({{a, b, c, 0}}, {{seed, 0}})[0];
}

}  // namespace

double random_fraction(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable) {
  constexpr double unit = 1.0 / (std::uint64_t{1} << 52U);
  return (double(word(seed, sample, variable, 0) >> 12U) + 0.5) * unit;
}

std::uint64_t random_place(std::uint64_t seed, std::uint64_t sample, std::uint64_t variable, std::uint64_t n) {
  unsigned half = 1;  // bits of half an index
  while (half < 32 && (std::uint64_t{1} << (2 * half)) < n) ++half;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  std::uint64_t place = sample;
  do {
    std::uint64_t left = place >> half, right = place & mask;
    for (std::uint64_t round = 1; round <= 6; ++round) {
      const std::uint64_t next = left ^ (word(seed, right, variable, round) & mask);
      left = right;
      right = next;
    }
    place = left << half | right;
  } while (place >= n);
  return place;
}

}  // namespace fastjoint::stage3
