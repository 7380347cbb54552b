// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/units.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <utility>
#include <vector>

namespace fastjoint {

std::string unit(const Units& units, double length_power, double force_power) {
  const std::string length = units.length.empty() ? "length" : units.length;
  const std::string force = units.force.empty() ? "force" : units.force;
  std::vector<std::string> above;
  std::string below;
  for (const auto& [label, exponent] : {std::pair{force, force_power}, std::pair{length, length_power}}) {
    const double size = std::abs(exponent);
    const std::string power = size == 1 ? label : fmt::format("{}^{:.6g}", label, size);
    if (exponent > 0) above.push_back(power);
    if (exponent < 0) below += "/" + power;
  }
  return (above.empty() ? "1" : fmt::format("{}", fmt::join(above, " "))) + below;
}

}  // namespace fastjoint
