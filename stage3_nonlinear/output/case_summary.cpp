// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/case_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <vector>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/output/table.hpp"

namespace fastjoint::stage3 {
namespace {

using formats::EnvelopeTable;
using formats::Extremes;
using formats::JointResult;

constexpr std::size_t max_case_rows = 16, max_case_lines = 50;

/// The largest transferred load of a case, and the highest peak if there is one: "412.3 at 7", "98.1 at upper:3".
struct Largest {
  double value = 0;
  std::string at = "-";

  void take(double other, const std::string& place) {
    constexpr double nothing = 1e-100;  // what rounding leaves of a joint without load
    if (other > std::max(value, nothing)) value = other, at = place;
  }
  [[nodiscard]] std::string text() const { return at == "-" ? at : fmt::format("{:.6g} at {}", value, at); }
};

/// A line for each case; of many cases for those with the largest loads, or the highest peaks without fasteners.
std::string case_lines(const JointModel& joint, const JointResult& a) {
  struct Line {
    Index increments = 0;
    Largest load, peak;
  };
  std::vector<Line> lines(a.case_name.size());
  for (Index row = 0; row < a.case_of.size(); ++row) {
    auto& [n, load, peak] = lines[a.case_of[row]];
    ++n;
    for (Index j = 0; j < joint.n_planes(); ++j)
      load.take(std::abs(a.columns["transferred"](row, 2 * j)), joint.short_name(joint.planes[j]));
    for (const auto& plate : a.plates)
      for (Index rim = 0; rim < std::ssize(plate.holes.hole); ++rim)
        peak.take(plate.columns["rim/peak_hoop"](row, rim), plate.name + ":" + plate.holes.hole[rim]);
  }
  std::vector<std::size_t> shown(lines.size());
  std::iota(shown.begin(), shown.end(), 0);
  if (shown.size() > max_case_lines) {
    std::ranges::stable_sort(shown, std::greater(), [&](std::size_t at) {
      return joint.n_planes() > 0 ? lines[at].load.value : lines[at].peak.value;
    });
    shown.resize(max_case_lines);
  }
  Table cases("{:<32} {:>10}   {:<32} {}",
              {{"case", "increments", fmt::format("largest load transferred [{}]", unit(joint.units, 0, 1)),
                fmt::format("highest peak hoop stress [{}]", unit(joint.units, -2, 1))}});
  for (const std::size_t at : shown)
    cases.row({program::one_line(a.case_name[at]), fmt::to_string(lines[at].increments), lines[at].load.text(),
               lines[at].peak.text()});
  std::string text = cases.text();
  if (lines.size() > shown.size())
    text += fmt::format("  ... and {} more cases with smaller ones\n", lines.size() - shown.size());
  return text;
}

/// Table of a quantity's envelope: all rows in their order, or those of the largest magnitude. Smallest values are
/// shown where some are negative.
std::string table(const JointResult& a, const EnvelopeTable& its, const char* meaning) {
  std::vector<Extremes> rows = its.rows;
  const auto size = [](const Extremes& each) { return std::max(std::abs(each.largest), std::abs(each.smallest)); };
  const std::size_t n = rows.size();
  if (n > max_case_rows) {
    std::ranges::stable_sort(rows, std::greater(), size);
    rows.resize(max_case_rows);
  }
  const bool has_signs = std::ranges::any_of(its.rows, [](const Extremes& each) { return each.smallest < 0; });
  std::string format = "{:<24} {:>20.6g} {:<40}";
  Table::Cells headings{meaning, fmt::format("largest [{}]", its.unit), "in"};
  if (has_signs) format += " {:>14.6g} {}", headings.insert(headings.end(), {"smallest", "in"});
  Table shown(format, {headings});
  for (const Extremes& each : rows) {
    Table::Cells cells{program::one_line(each.of), each.largest, increment_of(a, each.largest_at)};
    if (has_signs) cells.insert(cells.end(), {each.smallest, increment_of(a, each.smallest_at)});
    shown.row(cells);
  }
  std::string text = shown.text();
  if (n > max_case_rows) text += fmt::format("  ... and {} more with smaller ones\n", n - max_case_rows);
  return text;
}

}  // namespace

std::string case_summary(const JointScene& scene, const JointModel& joint, const JointResult& result) {
  std::string text =
      summary_title(scene, joint) + case_lines(joint, result) +
      fmt::format("envelope of {} (RESULT.h5 and --envelope have every quantity; --case NAME tells of one):\n",
                  result.complete ? "all cases" : "the increments that were solved, NOT of all cases");
  constexpr std::array shown{std::pair("transferred_first", "load transferred"),
                             std::pair("bearing_stress", "bearing stress"), std::pair("peak_hoop", "peak hoop stress"),
                             std::pair("K_I", "K_I"), std::pair("displacement", "displacement")};
  for (const auto& [quantity, meaning] : shown) {
    const auto found = std::ranges::find(result.envelope, quantity, &EnvelopeTable::quantity);
    if (found != result.envelope.end()) text += table(result, *found, meaning);
  }
  return text;
}

}  // namespace fastjoint::stage3
