// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/variable.hpp"

#include <Random123/philox.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <span>
#include <utility>

#include "common/errors.hpp"
#include "common/infinite.hpp"
#include "common/input/csv.hpp"
#include "common/program/program.hpp"

namespace fastjoint::stage3 {
namespace {

using input::Value;

constexpr std::size_t max_levels = 1000000;

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

/// Values in their order. @param weights Proportional to their probabilities; empty: equal ones.
Distribution discrete(std::vector<double> values, std::vector<double> weights = {}) {
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

Distribution read_discrete(const Value& value) {
  value.only({"type", "values", "weights"});
  auto values = value.at("values").numbers(1, max_levels, input::any_number);
  const auto weights = value.find("weights");
  const auto n = values.size();
  return discrete(std::move(values), weights ? weights->numbers(n, n, input::positive) : std::vector<double>());
}

/// Reads {"type": "uniform" | "normal" | "lognormal" | "triangular" | "discrete", ...}; normal and lognormal ones may
/// be truncated by "from" and "to".
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

std::vector<double> read_grid(const Value& grid) {
  grid.only({"from", "to", "n", "spacing"});
  const int n = grid.at("n").integer(1, max_levels);
  const auto spacing = grid.find("spacing");
  const bool by_logarithm = spacing && spacing->choice({"linear", "logarithmic"}) == "logarithmic";
  const auto range = by_logarithm ? input::positive : input::any_number;
  const double from = grid.at("from").number(range), to = grid.at("to").number(range);
  std::vector<double> levels;
  for (int i = 0; i < n; ++i) {
    const double fraction = n == 1 ? 0 : double(i) / (n - 1);
    levels.push_back(i + 1 == n && n > 1 ? to
                     : by_logarithm      ? std::pow(from, 1 - fraction) * std::pow(to, fraction)
                                         : std::lerp(from, to, fraction));
  }
  return levels;
}

std::size_t find_column(const input::CsvRow& header, const std::string& path, const std::string& column) {
  const auto found = std::ranges::find(header.cells, column);
  if (found == header.cells.end())
    throw InputError(
        fmt::format("{}:{}: no column \"{}\"; allowed: {}", path, header.line, column, fmt::join(header.cells, ", ")));
  if (std::ranges::count(header.cells, column) > 1)
    throw InputError(
        fmt::format("{}:{}: column \"{}\" stands twice; allowed: each name once", path, header.line, column));
  return found - header.cells.begin();
}

/// The first word of Philox4x64-10.
std::uint64_t word(std::uint64_t seed, std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  return r123::Philox4x64()({{a, b, c, 0}}, {{seed, 0}})[0];
}

}  // namespace

void read_numbers(const Value& value, Variable& variable) {
  const auto values = value.find("values"), grid = value.find("grid"), table = value.find("table"),
             distribution = value.find("distribution");
  if (!!values + !!grid + !!table + !!distribution != 1)
    value.fail("not one source of its numbers", "one of \"values\", \"grid\", \"table\" and \"distribution\"");
  if (values) variable.listed = values->numbers(1, max_levels, input::any_number);
  if (grid) variable.listed = read_grid(*grid);
  if (values || grid) variable.distribution = std::make_shared<Distribution>(discrete(variable.listed));
  if (distribution) variable.distribution = std::make_shared<Distribution>(read_distribution(*distribution));
  if (table) {
    table->only({"file", "column"});
    const auto path = std::filesystem::path(value.file()).parent_path() / table->at("file").text();
    variable.table = path.string();
    variable.listed = read_column(variable.table, table->at("column").text());
  }
}

std::vector<double> read_column(const std::string& path, const std::string& column) {
  const auto rows = input::read_csv(path);
  if (rows.size() < 2)
    throw InputError(fmt::format("{}: no row; allowed: a line of names, then at least one of numbers", path));
  const auto at = find_column(rows.front(), path, column);
  const auto n_columns = rows.front().cells.size();
  std::vector<double> values;
  for (const auto& [line, cells] : std::span(rows).subspan(1)) {
    if (cells.size() != n_columns)
      throw InputError(
          fmt::format("{}:{}: {} below {} of names; allowed: as many, parted as the names are, numbers with a "
                      "decimal point",
                      path, line, program::counted(cells.size(), "column"), n_columns));
    values.push_back(input::csv_value(cells[at], fmt::format("{}:{}", path, line), column));
  }
  return values;
}

double middle_of(const Variable& variable) {
  if (variable.listed.empty()) return variable.distribution->at(0.5);
  std::vector<double> all = variable.listed;
  std::ranges::nth_element(all, all.begin() + std::ssize(all) / 2);
  return all[all.size() / 2];
}

double largest_of(const Variable& variable) {
  return variable.listed.empty() ? variable.distribution->largest : std::ranges::max(variable.listed);
}

double spread_of(const Variable& variable) {
  if (variable.listed.empty()) return (variable.distribution->at(5.0 / 6) - variable.distribution->at(1.0 / 6)) / 2;
  const auto [low, high] = std::ranges::minmax(variable.listed);
  return (high - low) / 3;
}

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
