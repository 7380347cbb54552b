// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/statistics.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace fastjoint::stage3 {
namespace {

constexpr std::uint64_t sign_bit = std::uint64_t{1} << 63U;

/// An integer key with the order of the numbers.
std::uint64_t ordered(double x) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return (bits & sign_bit) != 0 ? ~bits : bits | sign_bit;
}
double number_of(std::uint64_t key) { return std::bit_cast<double>((key & sign_bit) != 0 ? key & ~sign_bit : ~key); }

/// Number of bits that are not known before a pass.
int below(int pass) { return std::max(64 - Selection::bits_of_pass * pass, 0); }

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

Selection::Selection(const std::vector<std::uint64_t>& ranks) {
  for (const std::uint64_t rank : ranks) targets_.push_back({rank, 0, 0});
  group();
}

void Selection::group() {
  prefixes_.clear();
  for (const auto& target : targets_) prefixes_.push_back(target.prefix);
  std::ranges::sort(prefixes_);
  prefixes_.erase(std::ranges::unique(prefixes_).begin(), prefixes_.end());
  for (auto& target : targets_) target.counts = std::ranges::lower_bound(prefixes_, target.prefix) - prefixes_.begin();
  counts_.assign(prefixes_.size(), std::vector<std::uint64_t>(std::size_t{1} << bits_of_pass, 0));
}

void Selection::add(double x) {
  const std::uint64_t key = ordered(x);
  const int known = below(pass_), next = below(pass_ + 1);
  const std::uint64_t prefix = pass_ == 0 ? 0 : key >> known << known;
  const auto at = std::ranges::lower_bound(prefixes_, prefix);
  if (at == prefixes_.end() || *at != prefix) return;
  ++counts_[at - prefixes_.begin()][(key - prefix) >> next];
}

void Selection::next() {
  const int next = below(pass_ + 1);
  for (auto& target : targets_) {
    const auto& counts = counts_[target.counts];
    std::uint64_t bits = 0;
    while (bits + 1 < counts.size() && target.rank > counts[bits]) target.rank -= counts[bits++];
    target.prefix |= bits << next;
  }
  ++pass_;
  group();
}

std::vector<double> Selection::found() const {
  std::vector<double> result;
  for (const auto& target : targets_) result.push_back(number_of(target.prefix));
  return result;
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
