// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/statistics.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fastjoint::stage3 {
namespace {

/// Smallest k in [0, n] for which a binomial number of n trials is k or less with more than a probability.
std::uint64_t min_count_with(double probability, double fraction, std::uint64_t n) {
  std::uint64_t low = 0, high = n;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    // P(X <= k) is 1 - I_p(k + 1, n - k).
    const double up_to = middle == n ? 1 : gsl_cdf_beta_Q(fraction, double(middle) + 1, double(n - middle));
    up_to > probability ? high = middle : low = middle + 1;
  }
  return low;
}

/// Quantile of a beta distribution by bisection: gsl_cdf_beta_Pinv does not converge for all large a and b.
double beta_quantile(double probability, double a, double b) {
  double low = 0, high = 1;
  for (double middle = 0.5; middle > low && middle < high; middle = low + (high - low) / 2)
    (gsl_cdf_beta_P(middle, a, b) < probability ? low : high) = middle;
  return high;
}

}  // namespace

QuantileRanks quantile_ranks(double fraction, std::uint64_t solved, std::uint64_t failed) {
  const std::uint64_t n = solved + failed;
  const auto at = std::clamp<std::uint64_t>(std::uint64_t(std::ceil(fraction * double(solved))), 1, solved);
  // With X samples below the quantile it is above the low limit if low <= X, and below the high limit if X < high.
  const std::uint64_t low = min_count_with(beyond_limit, fraction, n),
                      high = min_count_with(1 - beyond_limit, fraction, n) + 1;
  return {at, low > failed ? low - failed : 0, std::min(high, solved + 1)};
}

Proportion proportion(std::uint64_t count, std::uint64_t solved, std::uint64_t failed) {
  const double k = double(count), n = double(solved + failed), max_k = k + double(failed);
  return {solved == 0 ? 0 : k / double(solved), count == 0 ? 0 : beta_quantile(beyond_limit, k, n - k + 1),
          max_k >= n ? 1 : beta_quantile(1 - beyond_limit, max_k + 1, n - max_k)};
}

double Moments::deviation() const { return n_ < 2 ? 0 : or_infinite(std::sqrt(squares_ / double(n_ - 1))); }

std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t end = i;
    while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
    for (std::size_t j = i; j < end; ++j) ranks[order[j]] = 0.5 * double(i + end - 1);
    i = end;
  }
  return ranks;
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean = 0.5 * (double(a.size()) - 1);
  double aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
    ab += (a[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

}  // namespace fastjoint::stage3
