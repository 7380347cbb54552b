// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/stress_range_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/table.hpp"

namespace fastjoint::stage3 {

std::string stress_range_lines(const formats::JointResult& result) {
  constexpr std::size_t most_of_one_case = 1, most_of_cases = 16;
  const std::size_t most = result.case_name.size() > 1 ? most_of_cases : most_of_one_case;
  const std::size_t n = result.stress_ranges.size();
  const std::string unit = fastjoint::unit(result.header.units, -2, 1);
  Table shown("{:<24} {:>20.6g} {:>9.1e} {:>9.1f} {:>14.6g} {:<40} {:>14.6g} {}",
              {{"hoop stress of one spot", fmt::format("range [{}]", unit), "+-", "at [deg]", "largest", "in",
                "smallest", "in"}});
  constexpr double rounding = 1e-9;
  for (const auto& each : std::span(result.stress_ranges).first(std::min(n, most))) {
    const auto stress = [&](double value) { return std::abs(value) > rounding * each.range ? value : 0; };
    shown.row({program::one_line(each.of), each.range, each.error, each.angle, stress(each.largest),
               increment_of(result, each.largest_at), stress(each.smallest), increment_of(result, each.smallest_at)});
  }
  std::string text = shown.text();
  if (n > most && most > 1) text += fmt::format("  ... and {} more with smaller ones\n", n - most);
  return text;
}

}  // namespace fastjoint::stage3
