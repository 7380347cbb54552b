// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

namespace fastjoint {
namespace {

std::string power(const std::string& label, double exponent) {
  return exponent == 1 ? label : fmt::format("{}^{:.6g}", label, exponent);
}

}  // namespace

std::string unit(const Units& units, double length_power, double force_power) {
  const std::string length = units.length.empty() ? "length" : units.length;
  const std::string force = units.force.empty() ? "force" : units.force;
  std::vector<std::string> above;
  std::string below;
  for (const auto& [label, exponent] : {std::pair{force, force_power}, std::pair{length, length_power}}) {
    if (exponent > 0) above.push_back(power(label, exponent));
    if (exponent < 0) below += fmt::format("/{}", power(label, std::abs(exponent)));
  }
  if (above.empty()) return "1" + below;
  return (above.size() == 2 ? above[0] + " " + above[1] : above[0]) + below;
}

}  // namespace fastjoint
