// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/secondary_bending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "stage3_nonlinear/model/disc_rows.hpp"
#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr double little = 1e-6;  ///< a smaller k_b is rounding

/// A number for free and one for clamped heads, or that of the heads that were computed.
std::string by_heads(const MatrixXd& all, Index row, const char* format) {
  std::vector<std::string> texts;
  for (Index head = 0; head < all.cols(); ++head)
    if (!std::isnan(all(row, head))) texts.push_back(fmt::format(fmt::runtime(format), all(row, head)));
  return fmt::format("{}", fmt::join(texts, " | "));
}

/// Row of the largest number that is known; -1 without one above 0.
Index largest_row(const MatrixXd& all) {
  Index at = -1;
  double largest = 0;
  for (Index i = 0; i < all.rows(); ++i)
    for (Index k = 0; k < all.cols(); ++k)
      if (all(i, k) > largest) largest = all(i, k), at = i;
  return at;
}

std::string sheet_line(const PlateModel& plate, const PlateBending& its, const Units& units) {
  const Index row = largest_row(its.moment.cwiseAbs());
  if (row < 0 || !(its.k_b.row(row).array() >= little).any()) return "";
  const DiscRow at = disc_rows(plate)[row];
  std::string text = fmt::format("  {:<24} k_b {} at the row {} = {:.6g}", plate.name, by_heads(its.k_b, row, "{:.4f}"),
                                 rim::axis_names[at.axis], at.at);
  const MatrixXd faces = its.lower.cwiseMax(its.upper);
  if (const Index hole = largest_row(faces); hole >= 0)
    text +=
        fmt::format(", largest hoop stress with bending {} {} (hole {}, bending {})", by_heads(faces, hole, "{:.6g}"),
                    unit(units, -2, 1), plate.stresses.rim_hole[hole], by_heads(its.stress, hole, "{:.6g}"));
  return text + "\n";
}

}  // namespace

std::string secondary_bending(const JointModel& joint, const JointState& state) {
  std::string lines;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    if (const PlateBending& its = state.plates[i].bending; its.k_b.size() > 0)
      lines += sheet_line(joint.plates[i], its, joint.units);
  if (lines.empty()) return "";
  const auto larger = [](double x, double y) { return std::fmax(x, y); };  // of those that are known
  const MatrixXd worst = 100 * state.bending_mismatch.row(0).binaryExpr(state.bending_mismatch.row(1), larger);
  std::string mismatch;
  if (worst.array().isFinite().any())
    mismatch = fmt::format("; its effect on the forces in the plane changed the moments last by {} %",
                           by_heads(worst, 0, "{:.2g}"));
  return fmt::format("secondary bending, by free | clamped heads{}:\n{}", mismatch, lines);
}

std::vector<program::Warning> bending_warnings(const JointModel& joint, const std::vector<JointState>& states) {
  const auto found = std::ranges::find_if(states, [](const JointState& state) { return state.no_bending != nullptr; });
  if (found == states.end()) return {};
  return {{"bending-unknown", fmt::format("{}: secondary bending at increment {}: {}", joint.file,
                                          found - states.begin() + 1, found->no_bending)}};
}

}  // namespace fastjoint::stage3
