// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/distribution.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace fastjoint::stage3 {
namespace {

using input::Value;

struct Uniform final : Distribution {
  double from, to;
  Uniform(double low, double high) : from(low), to(high) {}
  [[nodiscard]] double at(double probability) const override { return from + probability * (to - from); }
};

struct Triangular final : Distribution {
  double from, mode, to;
  Triangular(double low, double peak, double high) : from(low), mode(peak), to(high) {}
  [[nodiscard]] double at(double probability) const override {
    const double width = to - from;
    if (probability * width <= mode - from) return from + std::sqrt(probability * width * (mode - from));
    return to - std::sqrt((1 - probability) * width * (to - mode));
  }
};

/// Normal, or lognormal if `of_logarithm`, between two limits of the normal number.
struct Normal final : Distribution {
  double mean, deviation;
  bool of_logarithm;
  double below, within;  ///< probabilities below and between the limits
  Normal(double m, double s, bool logarithm, double low, double high)
      : mean(m),
        deviation(s),
        of_logarithm(logarithm),
        below(gsl_cdf_ugaussian_P((low - m) / s)),
        within(gsl_cdf_ugaussian_P((high - m) / s) - below) {}
  [[nodiscard]] double at(double probability) const override {
    const double x = mean + deviation * gsl_cdf_ugaussian_Pinv(below + probability * within);
    return of_logarithm ? std::exp(x) : x;
  }
};

struct Discrete final : Distribution {
  std::vector<double> values, sums;  ///< sums of the weights up to each, over that of all
  Discrete(std::vector<double> all, const std::vector<double>& weights) : values(std::move(all)), sums(weights) {
    std::partial_sum(sums.begin(), sums.end(), sums.begin());
    const double sum = sums.back();
    for (double& each : sums) each /= sum;
  }
  [[nodiscard]] double at(double probability) const override {
    const auto found = std::upper_bound(sums.begin(), sums.end(), probability) - sums.begin();
    return values[std::min<std::size_t>(found, values.size() - 1)];
  }
  [[nodiscard]] double largest() const override { return std::ranges::max(values); }
};

std::pair<double, double> limits(const Value& value, double lowest) {
  const auto from = value.find("from"), to = value.find("to");
  const double low = from ? from->number({.low = lowest}) : lowest;
  return {low, to ? to->number({.low = low, .low_allowed = false}) : infinite};
}

std::shared_ptr<const Distribution> read_normal(const Value& value, bool of_logarithm) {
  value.only({"type", "mean", "deviation", "from", "to"});
  double mean = value.at("mean").number(of_logarithm ? input::positive : input::any_number);
  double deviation = value.at("deviation").number(input::positive);
  auto [low, high] = limits(value, of_logarithm ? 0 : -infinite);
  if (of_logarithm) {
    const double variance = std::log1p(std::pow(deviation / mean, 2));
    mean = std::log(mean) - variance / 2;
    deviation = std::sqrt(variance);
    low = std::log(low), high = std::log(high);
  }
  auto result = std::make_shared<Normal>(mean, deviation, of_logarithm, low, high);
  if (!(result->within > 1e-6))
    value.fail("too small a probability between \"from\" and \"to\"", "limits with a probability above 1e-6");
  return result;
}

std::shared_ptr<const Distribution> read_discrete(const Value& value) {
  value.only({"type", "values", "weights"});
  constexpr std::size_t max_values = 1000000;
  auto values = value.at("values").numbers(1, max_values, input::any_number);
  if (const auto weights = value.find("weights"))
    return std::make_shared<Discrete>(values, weights->numbers(values.size(), values.size(), input::positive));
  return discrete(std::move(values));
}

}  // namespace

std::shared_ptr<const Distribution> discrete(std::vector<double> values) {
  const std::vector<double> weights(values.size(), 1.0);
  return std::make_shared<Discrete>(std::move(values), weights);
}

std::shared_ptr<const Distribution> read_distribution(const Value& value) {
  const std::string type = value.at("type").choice({"uniform", "normal", "lognormal", "triangular", "discrete"});
  if (type == "normal" || type == "lognormal") return read_normal(value, type == "lognormal");
  if (type == "discrete") return read_discrete(value);
  const bool is_uniform = type == "uniform";
  is_uniform ? value.only({"type", "from", "to"}) : value.only({"type", "from", "mode", "to"});
  const double from = value.at("from").number(), to = value.at("to").number({.low = from, .low_allowed = false});
  if (is_uniform) return std::make_shared<Uniform>(from, to);
  return std::make_shared<Triangular>(from, value.at("mode").number({.low = from, .high = to}), to);
}

}  // namespace fastjoint::stage3
