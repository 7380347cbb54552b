// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/power_law.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cmath>

namespace fastjoint::stage3 {

PowerLaw::PowerLaw(double A, double n, double delta0) : A_(A), n_(n), delta0_(delta0) {
  assert(A > 0 && n > 0 && n <= 1 && delta0 >= 0);
}

Branch PowerLaw::beyond(double s, double /*k*/) const {
  if (n_ == 1) return {.F = s, .stretch = s / A_, .dF = 1, .dstretch = 1 / A_};
  const double stretch = std::pow(s / A_, 1 / n_);
  return {.F = s, .stretch = stretch, .dF = 1, .dstretch = s > 0 ? stretch / (n_ * s) : 0};
}

double PowerLaw::coordinate(double F, double /*k*/) const { return F; }

std::optional<double> PowerLaw::stiffness() const {
  if (n_ == 1) return A_;
  return std::nullopt;
}

std::vector<std::string> PowerLaw::doubts() const {
  constexpr double practical = 0.4;  // below (7) in the paper
  if (n_ >= practical) return {};
  return {fmt::format("n = {} is below the practical range {} to 1", n_, practical)};
}

std::shared_ptr<const Law> read_linear_law(const input::Value& law) {
  law.only({"type", "k", "one_sided"});
  return std::make_shared<PowerLaw>(law.at("k").number(input::positive), 1.0, 0.0);
}

std::shared_ptr<const Law> read_power_law(const input::Value& law) {
  law.only({"type", "A", "n", "delta0", "one_sided"});
  const double A = law.at("A").number(input::positive);
  const double n = law.at("n").number({.low = 0, .high = 1, .low_allowed = false});
  const auto delta0 = law.find("delta0");
  return std::make_shared<PowerLaw>(A, n, delta0 ? delta0->number(input::not_negative) : 0.0);
}

}  // namespace fastjoint::stage3
