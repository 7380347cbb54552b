// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/cubic_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

namespace fastjoint::stage3 {

CubicLaw::CubicLaw(const std::array<double, 3>& delta, const std::array<double, 3>& F)
    : last_(*std::max_element(delta.begin(), delta.end())) {
  // F / x is a parabola: Newton's divided differences give its coefficients.
  const double x0 = delta[0] / last_, x1 = delta[1] / last_, x2 = delta[2] / last_;
  assert(x0 > 0 && x1 > 0 && x2 > 0 && x0 != x1 && x1 != x2 && x0 != x2);
  const double g01 = (F[1] / x1 - F[0] / x0) / (x1 - x0);
  const double g12 = (F[2] / x2 - F[1] / x1) / (x2 - x1);
  const double g012 = (g12 - g01) / (x2 - x0);
  a_ = {F[0] / x0 - g01 * x0 + g012 * x0 * x1, g01 - g012 * (x0 + x1), g012};
}

double CubicLaw::force(double x) const { return x * (a_[0] + x * (a_[1] + x * a_[2])); }
double CubicLaw::slope(double x) const { return a_[0] + x * (2 * a_[1] + x * 3 * a_[2]); }

Branch CubicLaw::beyond(double s, double k) const {
  const double x = s / (k * last_);
  // Far beyond its points a cubic may turn round; on the other side it would then hold like a fastener.
  if (force(x) < 0) return {.F = 0, .stretch = s / k, .dF = 0, .dstretch = 1 / k, .spent = true};
  return {.F = force(x), .stretch = s / k, .dF = slope(x) / (k * last_), .dstretch = 1 / k};
}

double CubicLaw::coordinate(double F, double k) const { return k * last_ * F / force(1); }

std::vector<std::string> CubicLaw::doubts() const {
  // The slope is a parabola: its least value on [0, 1] is at an end or at the vertex.
  double worst = slope(1) < slope(0) ? 1 : 0;
  const double vertex = a_[2] != 0 ? -a_[1] / (3 * a_[2]) : 0;
  if (vertex > 0 && vertex < 1 && slope(vertex) < slope(worst)) worst = vertex;
  if (slope(worst) > 0) return {};
  return {
      fmt::format("the cubic does not rise everywhere up to its last delta {}: its slope at delta = {:.4g} is {:.4g}; "
                  "the joint may have more than one solution",
                  last_, worst * last_, slope(worst) / last_)};
}

std::shared_ptr<const Law> read_cubic_law(const input::Value& law) {
  law.only({"type", "delta", "F", "one_sided"});
  const auto deltas = law.at("delta");
  const auto delta = deltas.numbers(3, 3, input::positive);
  if (delta[0] == delta[1] || delta[1] == delta[2] || delta[0] == delta[2])
    deltas.not_allowed("three different displacements");
  const auto F = law.at("F").numbers(3, 3, input::positive);
  return std::make_shared<CubicLaw>(std::array{delta[0], delta[1], delta[2]}, std::array{F[0], F[1], F[2]});
}

}  // namespace fastjoint::stage3
