// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/distribution.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/infinite.hpp"

namespace fastjoint::stage3 {
namespace {

using input::Value;

/// Distribution without a largest number that is reached with any probability.
Distribution continuous(std::function<double(double)> at) {
  const double largest = at(1 - 1e-15);
  return {std::move(at), largest};
}

/// Normal distribution, or lognormal one of a normal number, between two limits.
Distribution read_normal(const Value& value, bool of_logarithm) {
  value.only({"type", "mean", "deviation", "from", "to"});
  double mean = value.at("mean").number(of_logarithm ? input::positive : input::any_number);
  double deviation = value.at("deviation").number(input::positive);
  const auto from = value.find("from"), to = value.find("to");
  const double lowest = of_logarithm ? 0 : -infinite, low = from ? from->number({.low = lowest}) : lowest,
               high = to ? to->number({.low = low, .low_allowed = false}) : infinite;
  if (of_logarithm) {
    const double variance = std::log1p(std::pow(deviation / mean, 2));
    mean = std::log(mean) - variance / 2;
    deviation = std::sqrt(variance);
  }
  const auto up_to = [&](double x) {
    return of_logarithm ? gsl_cdf_lognormal_P(x, mean, deviation) : gsl_cdf_gaussian_P(x - mean, deviation);
  };
  const double below = up_to(low), within = up_to(high) - below;
  if (!(within > 1e-6))
    value.fail("too small a probability between \"from\" and \"to\"", "limits with a probability above 1e-6");
  return continuous([=](double probability) {
    const double whole = below + probability * within;
    return of_logarithm ? gsl_cdf_lognormal_Pinv(whole, mean, deviation)
                        : mean + gsl_cdf_gaussian_Pinv(whole, deviation);
  });
}

Distribution read_discrete(const Value& value) {
  value.only({"type", "values", "weights"});
  constexpr std::size_t max_values = 1000000;
  auto values = value.at("values").numbers(1, max_values, input::any_number);
  const auto weights = value.find("weights");
  const auto n = values.size();
  return discrete(std::move(values), weights ? weights->numbers(n, n, input::positive) : std::vector<double>());
}

}  // namespace

Distribution discrete(std::vector<double> values, std::vector<double> weights) {
  if (weights.empty()) weights.assign(values.size(), 1);
  std::partial_sum(weights.begin(), weights.end(), weights.begin());
  const double largest = std::ranges::max(values), sum = weights.back();
  for (double& up_to : weights) up_to /= sum;
  return {[values = std::move(values), sums = std::move(weights)](double probability) {
            const auto found = std::ranges::upper_bound(sums, probability) - sums.begin();
            return values[std::min<std::size_t>(found, values.size() - 1)];
          },
          largest};
}

Distribution read_distribution(const Value& value) {
  const std::string type = value.at("type").choice({"uniform", "normal", "lognormal", "triangular", "discrete"});
  if (type == "normal" || type == "lognormal") return read_normal(value, type == "lognormal");
  if (type == "discrete") return read_discrete(value);
  const bool is_uniform = type == "uniform";
  is_uniform ? value.only({"type", "from", "to"}) : value.only({"type", "from", "mode", "to"});
  const double from = value.at("from").number(), to = value.at("to").number({.low = from, .low_allowed = false});
  if (is_uniform) return continuous([=](double probability) { return from + probability * (to - from); });
  const double mode = value.at("mode").number({.low = from, .high = to}), width = to - from;
  return continuous([=](double probability) {
    return probability * width <= mode - from ? from + std::sqrt(probability * width * (mode - from))
                                              : to - std::sqrt((1 - probability) * width * (to - mode));
  });
}

}  // namespace fastjoint::stage3
