// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/case_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

using formats::EnvelopeTable;
using formats::JointResult;

constexpr Index max_case_rows = 16;

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

std::string case_lines(const JointModel& joint, const JointResult& a) {
  const std::string force = unit(joint.units, 0, 1), stress = unit(joint.units, -2, 1);
  std::string text = fmt::format("  {:<32} {:>10}   {:<32} {}\n", "case", "increments",
                                 fmt::format("largest load transferred [{}]", force),
                                 fmt::format("highest peak hoop stress [{}]", stress));
  for (Index at = 0; at < std::ssize(a.case_name); ++at) {
    Largest load, peak;
    Index n = 0;
    for (Index row = 0; row < a.case_of.size(); ++row) {
      if (a.case_of[row] != at) continue;
      ++n;
      for (Index j = 0; j < joint.n_planes(); ++j)
        load.take(std::abs(a.columns["transferred"](row, 2 * j)), joint.short_name(joint.planes[j]));
      for (const auto& plate : a.plates)
        for (Index rim = 0; rim < std::ssize(plate.holes.hole); ++rim)
          peak.take(plate.columns["rim/peak_hoop"](row, rim), plate.name + ":" + plate.holes.hole[rim]);
    }
    text +=
        fmt::format("  {:<32} {:>10}   {:<32} {}\n", program::one_line(a.case_name[at]), n, load.text(), peak.text());
  }
  return text;
}

/// Table of a quantity's envelope: all rows in their order, or those of the largest magnitude. Smallest values are
/// shown where some are negative.
std::string table(const JointResult& a, const EnvelopeTable& its, const char* meaning) {
  const Index n = std::ssize(its.of);
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  const auto size = [&](Index i) { return std::max(std::abs(its.largest[i]), std::abs(its.smallest[i])); };
  if (n > max_case_rows) std::ranges::stable_sort(order, std::greater(), size);
  const bool has_signs = its.smallest.minCoeff() < 0;
  std::string text = fmt::format("  {:<24} {:>20} in", meaning, fmt::format("largest [{}]", its.unit));
  text += has_signs ? fmt::format("{:<38} {:>14} in\n", "", "smallest") : "\n";
  for (Index i = 0; i < std::min(n, max_case_rows); ++i) {
    const Index at = order[i];
    const std::string where = increment_of(a, its.largest_at[at]);
    text += fmt::format("  {:<24} {:>20.6g} ", program::one_line(its.of[at]), its.largest[at]);
    text += has_signs
                ? fmt::format("{:<40} {:>14.6g} {}\n", where, its.smallest[at], increment_of(a, its.smallest_at[at]))
                : where + "\n";
  }
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
