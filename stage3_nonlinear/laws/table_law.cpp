// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/laws/table_law.hpp"

#include <fmt/format.h>
#include <gsl/gsl_interp.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <new>
#include <utility>

#include "stage3_nonlinear/laws/rising_root.hpp"

namespace fastjoint::stage3 {
namespace {

TestPoints points_of(const input::Value& law) {
  const auto file = law.find("file");
  if (file) {
    law.only({"type", "file", "one_sided"});
    return read_points((std::filesystem::path(law.file()).parent_path() / file->text()).string());
  }
  law.only({"type", "delta", "F", "one_sided"});
  constexpr std::size_t most = 100000;
  const auto delta = law.at("delta").numbers(2, most, input::not_negative);
  const auto F = law.at("F").numbers(delta.size(), delta.size(), input::not_negative);
  TestPoints points;
  points.reserve(delta.size());
  for (std::size_t i = 0; i < delta.size(); ++i) points.push_back({delta[i], F[i]});
  return points;
}

}  // namespace

struct TableLaw::Spline {
  struct Free {
    void operator()(gsl_interp* interp) const noexcept { gsl_interp_free(interp); }
  };
  std::unique_ptr<gsl_interp, Free> interp;
};

TableLaw::TableLaw(const TestPoints& points) : x_{0}, F_{0} {
  assert(points.size() >= 2);
  for (const auto& [delta, F] : points) {
    assert(delta > x_.back() && F >= F_.back());
    x_.push_back(delta);
    F_.push_back(F);
  }
  spline_ = std::make_unique<Spline>();
  spline_->interp.reset(gsl_interp_alloc(gsl_interp_steffen, x_.size()));
  if (!spline_->interp) throw std::bad_alloc();
  gsl_interp_init(spline_->interp.get(), x_.data(), F_.data(), x_.size());
}

TableLaw::~TableLaw() = default;

std::array<double, 2> TableLaw::force_and_slope(double x) const {
  const double inside = std::min(x, x_.back());
  const double F = gsl_interp_eval(spline_->interp.get(), x_.data(), F_.data(), inside, nullptr);
  const double slope = gsl_interp_eval_deriv(spline_->interp.get(), x_.data(), F_.data(), inside, nullptr);
  return {F + slope * (x - inside), std::max(slope, 0.0)};  // rounding may make a level piece fall
}

Branch TableLaw::at(double c, double k, double clearance) const {
  const double s = c - k * clearance;
  if (s < 0) return Branch::open(c, k);
  // Between the two points around s = F + k x.
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

double TableLaw::coordinate(double F, double k, double clearance) const {
  // By chords: first guesses ask for no more.
  std::size_t i = 0;
  while (i + 2 < x_.size() && F_[i + 1] < F) ++i;
  const double rise = F_[i + 1] - F_[i];
  const double x = rise > 0 ? x_[i] + (F - F_[i]) / rise * (x_[i + 1] - x_[i]) : x_[i + 1];
  return F + k * (clearance + x);
}

double TableLaw::last_delta(double clearance) const { return clearance + x_.back(); }

std::vector<Slope> TableLaw::slopes(double c, double k, double clearance) const {
  const Branch on = at(c, k, clearance);
  if (on.delta <= clearance) return {{0, 0}};
  return {{-k * on.dF, on.dF}};  // of the curve moved along delta, at constant F + k delta
}

std::shared_ptr<const Law> read_table_law(const input::Value& law) {
  auto points = points_of(law);
  const auto place = law.find("file") ? law.at("file") : law;
  if (!points.empty() && points[0][0] == 0) {
    if (points[0][1] > 0)
      place.fail(fmt::format("F = {} at delta = 0", points[0][1]), "0 there: stiff contact is a power law");
    points.erase(points.begin());
  }
  if (points.size() < 2) place.fail(points.empty() ? "no point beyond (0, 0)" : "1 point beyond (0, 0)", "at least 2");
  for (std::size_t i = 1; i < points.size(); ++i) {
    const auto& [delta, F] = points[i];
    if (!(delta > points[i - 1][0]))
      place.fail(fmt::format("delta = {} after {}", delta, points[i - 1][0]), "displacements that rise");
    if (!(F >= points[i - 1][1]))
      place.fail(fmt::format("F = {} at delta = {} after {}", F, delta, points[i - 1][1]),
                 "forces that do not fall: smooth the data, or fit a law to it (scripts/fit_law)");
  }
  if (!(points.back()[1] > 0)) place.fail("no force at any point", "a force > 0");
  return std::make_shared<TableLaw>(points);
}

}  // namespace fastjoint::stage3
