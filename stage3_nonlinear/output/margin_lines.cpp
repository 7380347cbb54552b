// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/margin_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/csv.hpp"
#include "stage3_nonlinear/output/envelope.hpp"

namespace fastjoint::stage3 {

using formats::JointResult;
using formats::MarginTable;

std::string margin_lines(const JointScene& scene, const JointResult& result) {
  const bool checks_all_cases = std::ranges::all_of(scene.checks, &std::vector<std::string>::empty, &CheckScene::cases);
  constexpr std::size_t most = 12;
  const MarginTable& a = result.margins;
  const Index n = std::ssize(a.check);
  if (n == 0) return {};
  std::vector<Index> shown, others;
  std::set<std::string> checks;
  for (Index i = 0; i < n; ++i) (checks.insert(a.check[i]).second ? shown : others).push_back(i);
  for (const Index i : others)
    if (shown.size() < most) shown.push_back(i);
  std::string text = fmt::format(
      "margins = allowable / (FS FF applied) - 1{}: the smallest of each check, then the smallest of the others\n",
      !result.complete               ? ", of the increments that were solved, NOT of all cases"
      : result.case_name.size() == 1 ? ""
      : checks_all_cases             ? ", of all cases alike"
                                     : ", of all cases for checks without \"cases\"");
  text += fmt::format("  {:<20} {:<24} {:>9} {:>12} {:>12}  in\n", "check", "of", "margin", "allowable", "applied");
  for (const Index i : shown)
    text += fmt::format("  {:<20} {:<24} {:>9} {:>12.6g} {:>12.6g}  {}: {}; {}\n", program::one_line(a.check[i]),
                        program::one_line(a.of[i]),
                        std::isfinite(a.margin[i]) && a.margin[i] > 1000 ? "> 1000"
                        : std::isfinite(a.margin[i])                     ? fmt::format("{:+.3f}", a.margin[i])
                        : a.applied[i] > 0                               ? "no limit"
                                                                         : "no load",
                        a.allowable[i], a.applied[i], increment_of(result, a.at[i]), a.formula[i], a.inputs[i]);
  if (shown.size() < a.check.size())
    text += fmt::format("  ... of {}; RESULT.h5 and --margins have all\n", program::counted(n, "margin"));
  return text;
}

std::string margins_csv(const JointResult& result) {
  const MarginTable& a = result.margins;
  Csv csv("joint,check,of,margin,allowable,applied,unit,case,increment,formula,inputs,direction");
  for (Index i = 0; i < std::ssize(a.check); ++i)
    csv.line(result.header.name, a.check[i], a.of[i], fmt::to_string(a.margin[i]), fmt::to_string(a.allowable[i]),
             a.applied[i], a.unit[i], result.case_name[result.case_of[a.at[i]]], increment_number(result, a.at[i]),
             a.formula[i], a.inputs[i], a.direction[i]);
  return csv.text();
}

}  // namespace fastjoint::stage3
