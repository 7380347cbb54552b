// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/stress_range_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/table.hpp"

namespace fastjoint::stage3 {

std::string stress_range_lines(const formats::JointResult& result) {
  const std::size_t max_rows = result.case_name.size() > 1 ? 16 : 1;
  const std::size_t n = result.stress_ranges.size();
  if (n == 0) return {};
  const std::string unit = fastjoint::unit(result.header.units, -2, 1);
  Table shown("{:<24} {:>20.6g} {:>9.1e} {:>9.1f} {:>14.6g} {:<40} {:>14.6g} {}",
              {{"hoop stress of one spot", fmt::format("range [{}]", unit), "+-", "at [deg]", "largest", "in",
                "smallest", "in"}});
  for (const auto& each : std::span(result.stress_ranges).first(std::min(n, max_rows)))
    shown.row({program::one_line(each.of), each.range, each.error, each.angle, each.largest,
               increment_of(result, each.largest_at), each.smallest, increment_of(result, each.smallest_at)});
  std::string text = shown.text();
  if (n > max_rows) text += fmt::format("  ... and {} more with smaller ones\n", n - max_rows);
  text += fmt::format("  ranges are those between the increments that were solved{}; no load counts if a case has it\n",
                      result.complete ? "" : ", NOT of all cases");
  return text;
}

}  // namespace fastjoint::stage3
