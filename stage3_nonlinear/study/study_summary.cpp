// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/infinite.hpp"
#include "common/program/program.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.5g}", x) : "-"; }

/// What is counted against the limit of a group. A utilisation above 1 / (1 + m) is a margin below m.
std::string limit_text(const formats::StudyGroup& a) {
  const bool is_margin = a.name.ends_with("utilisation");
  if (!std::isfinite(a.limit)) return is_margin ? "P(margin < its limit)" : "P(> its limit)";
  constexpr double rounding = 1e-9;
  const double margin = 1 / a.limit - 1;
  return is_margin ? fmt::format("P(margin < {:g})", margin < rounding ? 0 : margin)
                   : fmt::format("P(> {:g})", a.limit);
}

std::string head(const formats::StudyGroup& a) {
  const bool governs = a.of.size() > 1, limited = (a.limits.array() < infinite).any();
  std::string line = fmt::format("  {:<16}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>11}{:>22}{:>11}", a.name, "middle",
                                 "mean", "deviation", "by slopes", "5 %", "50 %", "95 %", "95 % lies within", "99 %");
  if (governs) line += fmt::format("{:>9}", "governs");
  if (limited) line += fmt::format("{:>30}", limit_text(a));
  return line + fmt::format("   [{}]\n", a.unit);
}

std::string row(const formats::StudyGroup& a, Index i) {
  std::string line = fmt::format("  {:<16}", program::one_line(a.of[i]));
  for (const double x : {a.middle[i], a.mean[i], a.deviation[i], a.by_sensitivities[i], a.quantile(i, 0),
                         a.quantile(i, 1), a.quantile(i, 2)})
    line += fmt::format("{:>11}", number(x));
  line += fmt::format("{:>22}{:>11}", fmt::format("{}..{}", number(a.low(i, 2)), number(a.high(i, 2))),
                      number(a.quantile(i, 3)));
  if (a.of.size() > 1) line += fmt::format("{:>7.1f} %", 100 * a.governs[i]);
  if (std::isfinite(a.limits[i]))
    line += fmt::format("{:>30}",
                        fmt::format("{:.4g} ({:.3g}..{:.3g})", a.exceeds[i], a.exceeds_low[i], a.exceeds_high[i]));
  return line + "\n";
}

/// Table of a group: all rows in their order, or the largest ones if there are more than a page.
std::string table(const formats::StudyGroup& a) {
  constexpr Index max_rows = 40;
  const Index n = std::ssize(a.of);
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  if (n > max_rows) std::ranges::stable_sort(order, std::greater(), [&](Index i) { return a.quantile(i, 2); });
  std::string text = head(a);
  for (Index i = 0; i < std::min(n, max_rows); ++i) text += row(a, order[i]);
  if (n > max_rows) text += fmt::format("  ... and {} more with smaller 95 % quantiles\n", n - max_rows);
  return text;
}

/// The variables with the largest rank correlations with the largest number of a group.
std::string causes(const formats::StudyResult& result, const formats::StudyGroup& a) {
  const Index v = std::ssize(result.variable);
  std::vector<Index> order(v);
  std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(order, std::greater(), [&](Index k) { return std::abs(a.correlation(0, k)); });
  std::string text;
  constexpr Index max_variables = 5;
  for (Index k = 0; k < std::min(v, max_variables); ++k)
    text += fmt::format("{}{} {:+.2f}", k == 0 ? "" : ", ", program::one_line(result.variable[order[k]]),
                        a.correlation(0, order[k]));
  return fmt::format("  rank correlations of the {}: {}\n", a.of[0], text);
}

/// Sentence about deviations that differ from those by the sensitivities in the middle; empty if they agree.
std::string doubts_of(const formats::StudyGroup& a) {
  constexpr double max_difference = 0.2, min_deviation = 1e-6;
  Index worst = -1, n_off = 0;
  double worst_off = 0;
  for (Index i = 0; i < std::ssize(a.of); ++i) {
    if (!std::isfinite(a.by_sensitivities[i]) || a.deviation[i] <= min_deviation * std::abs(a.mean[i])) continue;
    const double off = std::abs(a.by_sensitivities[i] / a.deviation[i] - 1);
    if (off <= max_difference) continue;
    ++n_off;
    if (off > worst_off) worst_off = off, worst = i;
  }
  if (n_off == 0) return {};
  return fmt::format(
      "  sensitivities in the middle alone miss the deviation of {} of {} numbers of \"{}\" by more than 20 %, that of "
      "{} by {:+.0f} %: trust the samples\n",
      n_off, a.of.size(), a.name, program::one_line(a.of[worst]),
      100 * (a.by_sensitivities[worst] / a.deviation[worst] - 1));
}

/// Sentences about cracks whose faces overlap in some samples; empty if there are none.
std::string closing(const formats::StudyGroup& a) {
  std::string text;
  for (Index i = 0; i < a.closed.size(); ++i)
    if (a.closed[i] > 0)
      text += fmt::format(
          "  crack \"{}\" closes at its tip in {:.4g} % of the samples (K_I < 0), where its faces overlap in the "
          "model: "
          "take K_I as 0 there, and do not rely on K_II\n",
          program::one_line(a.of[i]), 100 * a.closed[i]);
  return text;
}

}  // namespace

std::string study_summary(const formats::StudyResult& result, const StudyScene& scene, const std::string& failures) {
  const std::string seed = result.sampling == "grid" ? "" : ", seed " + result.origin.seed;
  std::string text =
      fmt::format("{}: {} ({}{}) of {}\n", result.header.name.empty() ? "study" : program::one_line(result.header.name),
                  program::counted(result.n_samples, "sample"), result.sampling, seed,
                  program::counted(result.variable.size(), "variable"));
  for (const auto& variable : scene.variables)
    for (const auto& remark : variable.remarks)
      text += fmt::format("  {}: {}\n", program::one_line(variable.name), program::one_line(remark));
  if (result.n_status[0] < int(result.n_samples))
    text += fmt::format("  {} samples failed ({} refused, {} not solved, {} out of balance): {}\n",
                        result.n_samples - result.n_status[0], result.n_status[1], result.n_status[2],
                        result.n_status[3], failures);
  for (std::size_t g = 0; g < result.groups.size(); ++g) {
    const bool repeats = result.groups[g].name.starts_with("largest") && result.groups[g - 1].of.size() == 1;
    if (!repeats) text += table(result.groups[g]);
  }
  for (const auto& group : result.groups)
    if (group.name.starts_with("largest")) text += causes(result, group);
  for (const auto& group : result.groups) text += doubts_of(group) + closing(group);
  return text;
}

}  // namespace fastjoint::stage3
