// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "stage3_nonlinear/study/statistics.hpp"
#include "stage3_nonlinear/study/variable.hpp"

namespace fastjoint::stage3::study_test {
namespace {

double log_choose(double n, double k) { return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1); }

/// Probability that a binomial number of n is in [from, to].
double binomial(int n, double fraction, int from, int to) {
  double sum = 0;
  for (int k = std::max(from, 0); k <= std::min(to, n); ++k)
    sum += std::exp(log_choose(n, k) + k * std::log(fraction) + (n - k) * std::log1p(-fraction));
  return sum;
}

TEST(QuantileRanks, HoldTheQuantileWithNinetyFivePercentAndHardlyMore) {
  for (const int n : {20, 100, 1000, 5000})
    for (const double fraction : quantile_levels) {
      const auto [at, low, high] = quantile_ranks(fraction, n, 0);
      EXPECT_EQ(at, std::max(1.0, std::ceil(fraction * n)));
      // The quantile lies above the low one if so many samples or more are below it, and below the high one if fewer.
      const double below = binomial(n, fraction, 0, int(low) - 1), above = binomial(n, fraction, int(high), n);
      EXPECT_LE(below, beyond_limit) << n;
      EXPECT_LE(above, beyond_limit) << n;
      EXPECT_GT(binomial(n, fraction, 0, int(low)), beyond_limit) << n;
      if (high <= unsigned(n)) {
        EXPECT_GT(binomial(n, fraction, int(high) - 1, n), beyond_limit) << n;
      }
    }
}

TEST(QuantileRanks, FailedSamplesWidenTheLimitsByTheirNumber) {
  const auto without = quantile_ranks(0.5, 1000, 0), with = quantile_ranks(0.5, 900, 100);
  EXPECT_EQ(with.low, without.low - 100);
  EXPECT_EQ(with.high, without.high);
}

TEST(Proportion, HasExactBinomialLimits) {
  for (const int n : {10, 200, 3000})
    for (const int k : {0, 1, n / 3, n - 1, n}) {
      const Proportion fraction = proportion(k, n, 0);
      EXPECT_EQ(fraction.value, double(k) / n);
      if (k > 0) {
        EXPECT_NEAR(binomial(n, fraction.low, k, n), beyond_limit, 1e-8) << n << " " << k;
      }
      if (k < n) {
        EXPECT_NEAR(binomial(n, fraction.high, 0, k), beyond_limit, 1e-8) << n << " " << k;
      }
    }
  EXPECT_EQ(proportion(0, 100, 0).low, 0);
  EXPECT_EQ(proportion(100, 100, 0).high, 1);
  EXPECT_EQ(proportion(5, 90, 10).low, proportion(5, 100, 0).low);
  EXPECT_EQ(proportion(5, 90, 10).high, proportion(15, 100, 0).high);
}

TEST(Proportion, HasLimitsOfAMillionSamples) {
  for (const std::uint64_t k :
       {std::uint64_t{1}, std::uint64_t{500000}, std::uint64_t{999999}, std::uint64_t{1000000}}) {
    const Proportion fraction = proportion(k, 1000000, 0);
    EXPECT_TRUE(fraction.low < fraction.value && fraction.value <= fraction.high &&
                fraction.high - fraction.low < 0.002)
        << k;
  }
}

TEST(RandomPlace, IsAPermutation) {
  for (const std::uint64_t n : {1, 2, 3, 16, 17, 1000})
    for (const std::uint64_t variable : {0, 5}) {
      std::set<std::uint64_t> places;
      for (std::uint64_t i = 0; i < n; ++i) places.insert(random_place(7, i, variable, n));
      EXPECT_EQ(places.size(), n);
      EXPECT_LT(*places.rbegin(), n);
    }
}

TEST(RandomShare, IsOfItsSampleAndVariableAlone) {
  std::set<double> shares;
  for (std::uint64_t sample = 0; sample < 100; ++sample)
    for (std::uint64_t variable = 0; variable < 20; ++variable) {
      const double fraction = random_fraction(1, sample, variable);
      EXPECT_TRUE(fraction > 0 && fraction < 1);
      shares.insert(fraction);
    }
  EXPECT_EQ(shares.size(), 2000);
}

TEST(RankCorrelation, IsOneOfAnyRisingFunctionAndCountsTiesByTheirMean) {
  const std::vector<double> x{3, 1, 4, 1.5, 9}, y{27, 1, 64, 3, 729};
  EXPECT_DOUBLE_EQ(rank_correlation(ranks_of(x), ranks_of(y)), 1);
  EXPECT_EQ(ranks_of({2, 1, 2, 0}), (std::vector<double>{2.5, 1, 2.5, 0}));
  EXPECT_EQ(rank_correlation(ranks_of({1, 1, 1}), ranks_of({1, 2, 3})), 0);
}

TEST(Moments, AreInfiniteBeyondWhatANumberHolds) {
  EXPECT_TRUE(std::isinf(moments_of({1e308, -1e308, 1e308}).deviation));
  EXPECT_TRUE(std::isinf(moments_of({1.7e308, -1.7e308, 1.7e308, -1.7e308}).deviation));
  const auto [mean, deviation] = moments_of({1, 2, 6});
  EXPECT_DOUBLE_EQ(mean, 3);
  EXPECT_DOUBLE_EQ(deviation, std::sqrt(7));
  EXPECT_EQ(moments_of({0.1, 0.1, 0.1}).deviation, 0);
  EXPECT_EQ(moments_of({4}).mean, 4);
  EXPECT_EQ(moments_of({}).deviation, 0);
}

}  // namespace
}  // namespace fastjoint::stage3::study_test
