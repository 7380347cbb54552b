// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/statistics.hpp"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <ranges>

#include "common/infinite.hpp"

namespace fastjoint::stage3 {
namespace {

/// Smallest k in [0, n] for which a binomial number of n trials is k or less with more than a probability.
std::uint64_t min_count_with(double probability, double fraction, std::uint64_t n) {
  const auto is_too_small = [&](std::uint64_t k) {  // P(X <= k) is 1 - I_p(k + 1, n - k)
    return gsl_cdf_beta_Q(fraction, double(k) + 1, double(n - k)) <= probability;
  };
  const auto below_n = std::views::iota(std::uint64_t{0}, n);
  return std::uint64_t(std::ranges::partition_point(below_n, is_too_small) - below_n.begin());
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

Moments moments_of(const std::vector<double>& values) {
  const auto or_infinite = [](double x) { return std::isnan(x) ? infinite : x; };  // NaN by differences that overflow
  const double mean = gsl_stats_mean(values.data(), 1, values.size());
  if (values.size() < 2) return {mean, 0};
  return {or_infinite(mean), or_infinite(gsl_stats_sd_m(values.data(), 1, values.size(), mean))};
}

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
  const auto from_mean = [](const std::vector<double>& ranks) {
    return Eigen::VectorXd(Eigen::ArrayXd::Map(ranks.data(), std::ssize(ranks)) - 0.5 * (double(ranks.size()) - 1));
  };
  const Eigen::VectorXd x = from_mean(a), y = from_mean(b);
  return x.isZero(0) || y.isZero(0) ? 0 : x.dot(y) / (x.norm() * y.norm());
}

}  // namespace fastjoint::stage3
