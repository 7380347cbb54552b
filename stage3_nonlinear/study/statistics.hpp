// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace fastjoint::stage3 {

/// Probabilities of the quantiles of a study, and the probability outside each confidence limit: a pair of limits
/// contains the true value with 95 %.
inline constexpr std::array quantile_levels{0.05, 0.5, 0.95, 0.99};
inline constexpr double beyond_limit = 0.025;

/// Ranks of the order statistics that are a quantile and its confidence limits for any distribution: 1-based numbers of
/// the samples in ascending order; 0 or one more than all if there are too few samples for a limit.
struct QuantileRanks {
  std::uint64_t at, low, high;
};
/// Ranks for a probability. @param failed Samples without a result: the limits allow for any of them below or above.
[[nodiscard]] QuantileRanks quantile_ranks(double fraction, std::uint64_t solved, std::uint64_t failed);

/// A fraction and its exact binomial limits (Clopper and Pearson 1934); failed samples count as either.
struct Proportion {
  double value, low, high;
};
[[nodiscard]] Proportion proportion(std::uint64_t count, std::uint64_t solved, std::uint64_t failed);

/// Mean and deviation of numbers, the deviation of a sample; infinite where they are beyond what a number holds.
struct Moments {
  double mean, deviation;
};
[[nodiscard]] Moments moments_of(const std::vector<double>& values);

/// Spearman's rank correlation of two lists of equal length; 0 if one of them is constant.
[[nodiscard]] double rank_correlation(const std::vector<double>& ranks_a, const std::vector<double>& ranks_b);
/// Ranks of numbers; equal ones have their mean rank.
[[nodiscard]] std::vector<double> ranks_of(const std::vector<double>& values);

}  // namespace fastjoint::stage3
