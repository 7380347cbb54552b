// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gsl/gsl_interp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <new>
#include <string_view>
#include <utility>

#include "common/errors.hpp"
#include "common/input/csv.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {
namespace {

/// Measured curve that never falls: a piecewise cubic through its points with continuous slope that preserves their
/// monotonicity (Steffen, Astronomy & Astrophysics 239, 1990); linear beyond the last point.
class TableLaw final : public Law {
 public:
  /// @param points (0, 0) and at least two more: delta rises, F does not fall.
  /// @param F_yield Force from which it keeps a set; infinite: none.
  TableLaw(const TestPoints& points, std::string file, std::array<std::string, 2> units, double F_yield)
      : spline_(gsl_interp_alloc(gsl_interp_steffen, points.size()), &gsl_interp_free),
        file_(std::move(file)),
        units_(std::move(units)),
        F_yield_(F_yield) {
    if (!spline_) throw std::bad_alloc();
    for (const auto& [delta, F] : points) {
      x_.push_back(delta);
      F_.push_back(F);
    }
    gsl_interp_init(spline_.get(), x_.data(), F_.data(), x_.size());
    if (!keeps_a_set()) return;
    yields_at_ = stretch(F_yield_);
    unloads_ = F_yield_ / yields_at_;
    constexpr int parts = 16;
    constexpr double steeper = 1.01;  // than the curve, so that the set rises with the force
    for (std::size_t i = 0; i + 1 < x_.size(); ++i)
      for (int part = 0; part <= parts; ++part)
        if (const double x = x_[i] + (x_[i + 1] - x_[i]) * part / parts; x > yields_at_)
          unloads_ = std::max(unloads_, steeper * force_and_slope(x).slope);
  }

  [[nodiscard]] Branch at(double c, double k, double clearance) const override {
    const double s = c - k * clearance;
    if (s < 0) return Branch::open(c, k);
    // The root lies between the two points around s = F + k x.
    std::size_t i = 0;
    while (i + 1 < x_.size() && F_[i + 1] + k * x_[i + 1] < s) ++i;
    const double low = x_[i], high = i + 1 < x_.size() ? x_[i + 1] : s / k;
    const auto excess = [&](double x) {
      const auto [F, slope] = force_and_slope(x);
      return std::pair(F + k * x - s, slope + k);
    };
    const double x = s > 0 ? rising_root(excess, low, high) : 0;
    const auto [F, slope] = force_and_slope(x);
    return {.F = F, .delta = clearance + x, .dF = slope / (slope + k), .ddelta = 1 / (slope + k)};
  }

  /// Uses the chords, which are accurate enough for first guesses.
  [[nodiscard]] double coordinate(double F, double k, double clearance) const override {
    std::size_t i = 0;
    while (i + 2 < x_.size() && F_[i + 1] < F) ++i;
    const double rise = F_[i + 1] - F_[i];
    const double x = rise > 0 ? x_[i] + (F - F_[i]) / rise * (x_[i + 1] - x_[i]) : x_[i + 1];
    return F + k * (clearance + x);
  }

  [[nodiscard]] double max_force() const override {
    return force_and_slope(x_.back()).slope > 0 ? std::numeric_limits<double>::infinity() : F_.back();
  }

  [[nodiscard]] double last_delta(double clearance) const override { return clearance + x_.back(); }

  [[nodiscard]] std::vector<Slope> slopes(double c, double k, double clearance) const override {
    if (c < k * clearance) return {{0, 0}};
    const Branch on = at(c, k, clearance);
    return {{-k * on.dF, on.dF}};  // of the curve moved along delta, at constant F + k delta
  }

  [[nodiscard]] std::string file() const override { return file_; }
  [[nodiscard]] std::array<std::string, 2> units() const override { return units_; }

  /// Elastic along the curve up to yield, then with the slope of the line from no load to there, or the steepest slope
  /// beyond; the rest is set.
  [[nodiscard]] std::vector<MemoryBranch> branches(double clearance) const override {
    if (!keeps_a_set()) return {};
    const double k = unloads_;
    return {{.elastic =
                 [=, this](double x) {
                   const double stretch = x - clearance;
                   if (stretch < 0) return Rise{0, 0};
                   if (stretch > yields_at_) return Rise{F_yield_ + k * (stretch - yields_at_), k};
                   return force_and_slope(stretch);
                 },
             .backstress =
                 [=, this](double set) {
                   const auto excess = [&](double x) {  // set of the curve's point x less this one
                     const auto [F, slope] = force_and_slope(x);
                     return std::pair(x - yields_at_ - (F - F_yield_) / k - set, std::max(1 - slope / k, 1e-9));
                   };
                   double high = std::max(x_.back(), yields_at_);
                   while (excess(high).first < 0) high *= 2;
                   const double x = set > 0 ? rising_root(excess, yields_at_, high) : yields_at_;
                   const auto [F, slope] = force_and_slope(x);
                   return Rise{F - F_yield_, slope / (1 - slope / k)};
                 },
             .limit = F_yield_}};
  }

 private:
  [[nodiscard]] bool keeps_a_set() const { return std::isfinite(F_yield_); }
  /// Stretch at a force that the points reach.
  [[nodiscard]] double stretch(double F) const {
    const auto excess = [&](double x) {
      const auto [force, slope] = force_and_slope(x);
      return std::pair(force - F, slope);
    };
    return rising_root(excess, 0, x_.back());
  }

  [[nodiscard]] Rise force_and_slope(double x) const {
    const double in_range = std::min(x, x_.back());
    const double F = gsl_interp_eval(spline_.get(), x_.data(), F_.data(), in_range, nullptr);
    const double slope = gsl_interp_eval_deriv(spline_.get(), x_.data(), F_.data(), in_range, nullptr);
    return {F + slope * (x - in_range), std::max(slope, 0.0)};  // rounding may make a horizontal piece fall
  }

  std::vector<double> x_, F_;  ///< points with (0, 0): stretch, length; force
  std::unique_ptr<gsl_interp, decltype(&gsl_interp_free)> spline_;
  std::string file_;
  std::array<std::string, 2> units_;
  double F_yield_, yields_at_ = 0, unloads_ = 0;  ///< force, length, force / length
};

constexpr const char* columns = "two columns, delta and F, parted by a comma, semicolon or tab";

double checked(std::string_view cell, const std::string& place) {
  const auto value = input::csv_number(cell);
  if (!value || !input::has_allowed_size(*value) || *value < 0)
    throw InputError(
        fmt::format("{}: '{}' is not allowed; allowed: a number >= 0 with a decimal point{}", place, cell,
                    value && std::isfinite(*value) && *value > 0 ? ", 0 or of a size from 1e-100 to 1e+100" : ""));
  return *value;
}

/// Tells whether a row holds two names; a cell that begins like a number is a mistyped number, not a name.
bool is_header(const std::vector<std::string>& cells) {
  return std::ranges::all_of(cells, [](std::string_view cell) {
    return !cell.empty() && !input::csv_number(cell) &&
           std::string_view("0123456789+-.").find(cell.front()) == cell.npos;
  });
}

/// Places of the columns of delta and F, and their units.
struct Columns {
  std::array<std::size_t, 2> at{0, 1};
  std::array<std::string, 2> units{};
};

/// Columns by a header whose cells may name units too: "delta [mm]". Columns of unknown names could be in either order,
/// and F over delta rises as delta over F does.
Columns columns_of(const std::vector<std::string>& header, const std::string& place) {
  constexpr const char* ends = " ([/";
  Columns found;
  for (const bool swapped : {false, true}) {
    found.at = {swapped ? 1U : 0U, swapped ? 0U : 1U};
    bool fits = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const std::string_view cell = header[found.at[i]];
      const auto end = std::min(cell.find_first_of(ends), cell.size());
      fits = fits && cell.substr(0, end) == std::array{"delta", "F"}[i];
      const auto first = cell.find_first_not_of(ends, end), last = cell.find_last_not_of(" )]");
      found.units[i] = first == cell.npos ? "" : std::string(cell.substr(first, last + 1 - first));
    }
    if (fits) return found;
  }
  throw InputError(
      fmt::format("{}: columns '{}' and '{}'; allowed: \"delta\" and \"F\", with units or without, or no names", place,
                  header[0], header[1]));
}

/// Points given in the law itself, not in a file.
TestPoints points_of(const input::Value& law) {
  law.only({"type", "delta", "F", "F_yield", "one_sided"});
  constexpr std::size_t max_points = 100000;
  const auto delta = law.at("delta").numbers(2, max_points, input::not_negative);
  const auto F = law.at("F").numbers(delta.size(), delta.size(), input::not_negative);
  TestPoints points;
  for (std::size_t i = 0; i < delta.size(); ++i) points.push_back({delta[i], F[i]});
  return points;
}

}  // namespace

TestPoints read_points(const std::string& path, std::array<std::string, 2>* units) {
  TestPoints points;
  bool first = true;
  Columns found;
  for (const auto& [line, cells] : input::read_csv(path)) {
    if (cells.size() == 1 && cells[0].empty()) continue;
    const std::string place = fmt::format("{}:{}", path, line);
    if (cells.size() != 2)
      throw InputError(fmt::format("{}: {} in '{}'; allowed: {}", place, program::counted(cells.size(), "column"),
                                   fmt::join(cells, ","), columns));
    if (std::exchange(first, false) && is_header(cells))
      found = columns_of(cells, place);
    else
      points.push_back({checked(cells[found.at[0]], place), checked(cells[found.at[1]], place)});
  }
  if (points.empty()) throw InputError(fmt::format("{}: no points; allowed: {}", path, columns));
  if (units) *units = found.units;
  return points;
}

/// Reads {"type": "table", "file": CSV} or {"type": "table", "delta": [...], "F": [...]}: points of a test, with or
/// without (0, 0).
LawPointer read_table_law(const input::Value& law) {
  const auto file = law.find("file");
  const auto path = file ? (std::filesystem::path(law.file()).parent_path() / file->text()).string() : std::string();
  if (file) law.only({"type", "file", "F_yield", "one_sided"});
  std::array<std::string, 2> units;
  auto points = file ? read_points(path, &units) : points_of(law);
  const auto& place = file ? *file : law;
  if (points[0][0] != 0) points.insert(points.begin(), {0, 0});
  if (points[0][1] > 0)
    place.fail(fmt::format("F = {} at delta = 0", points[0][1]), "0 there: stiff contact is a power law");
  if (points.size() < 3)
    place.fail(points.size() < 2 ? "no point beyond (0, 0)" : "1 point beyond (0, 0)", "at least 2");
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [delta, F] = points[i];
    if (!(delta > points[i - 1][0]))
      place.fail(fmt::format("delta = {} after {}", delta, points[i - 1][0]), "displacements that rise");
    if (!(F >= points[i - 1][1]))
      place.fail(fmt::format("F = {} at delta = {} after {}", F, delta, points[i - 1][1]),
                 "forces that do not fall: smooth the data, or fit a law to it (scripts/fit_law)");
  }
  if (!(points.back()[1] > 0)) place.fail("no force at any point", "a force > 0");
  const auto yield = law.find("F_yield");
  const double F_yield = yield ? yield->number(input::positive) : std::numeric_limits<double>::infinity();
  if (yield && F_yield > points.back()[1])
    yield->fail(fmt::format("{}", F_yield),
                fmt::format("at most the largest force of the points, {}", points.back()[1]));
  return std::make_shared<TableLaw>(points, path, units, F_yield);
}

}  // namespace fastjoint::stage3
