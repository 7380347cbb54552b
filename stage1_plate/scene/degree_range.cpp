// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/scene/scene.hpp"

#include <fmt/format.h>

#include <charconv>

#include "common/errors.hpp"

namespace fastjoint::stage1 {
namespace {

/// The whole text as a number, or 0.
int degree(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

}  // namespace

void set_degrees(PlateScene& scene, const std::string& option) {
  if (option.empty()) return;
  const auto dots = option.find("..");
  const int low = degree(std::string_view(option).substr(0, dots));
  const int high = dots == std::string::npos ? low : degree(std::string_view(option).substr(dots + 2));
  if (low < 1 || high < low || high > pfem::highest_p)
    throw InputError(fmt::format("--p: '{}' is not allowed; allowed: a degree from 1 to {}, or a range such as 1..{}",
                                 option, pfem::highest_p, pfem::highest_p));
  scene.p_low = low;
  scene.p_high = high;
}

Eigen::VectorXi degrees(const PlateScene& scene) {
  return Eigen::VectorXi::LinSpaced(scene.p_high - scene.p_low + 1, scene.p_low, scene.p_high);
}

}  // namespace fastjoint::stage1
