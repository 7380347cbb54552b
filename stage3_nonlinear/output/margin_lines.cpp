// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/margin_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/program/program.hpp"
#include "stage3_nonlinear/output/csv.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/table.hpp"

namespace fastjoint::stage3 {

using formats::JointResult;
using formats::Margin;

std::string margin_lines(const JointScene& scene, const JointResult& result) {
  const bool checks_all_cases = std::ranges::all_of(scene.checks, &std::vector<std::string>::empty, &CheckScene::cases);
  constexpr std::size_t most = 12;
  if (result.margins.empty()) return {};
  std::vector<const Margin*> shown, others;
  std::set<std::string> checks;
  for (const Margin& each : result.margins) (checks.insert(each.check).second ? shown : others).push_back(&each);
  for (const Margin* each : others)
    if (shown.size() < most) shown.push_back(each);
  std::string text = fmt::format(
      "margins = allowable / (FS FF applied) - 1{}: the smallest of each check, then the smallest of the others\n",
      !result.complete               ? ", of the increments that were solved, NOT of all cases"
      : result.case_name.size() == 1 ? ""
      : checks_all_cases             ? ", of all cases alike"
                                     : ", of all cases for checks without \"cases\"");
  Table table("{:<20} {:<24} {:>9} {:>12.6g} {:>12.6g}  {}", {{"check", "of", "margin", "allowable", "applied", "in"}});
  for (const Margin* each : shown)
    table.row({program::one_line(each->check), program::one_line(each->of),
               std::isfinite(each->margin) && each->margin > 1000 ? "> 1000"
               : std::isfinite(each->margin)                      ? fmt::format("{:+.3f}", each->margin)
               : each->applied > 0                                ? "no limit"
                                                                  : "no load",
               each->allowable, each->applied,
               fmt::format("{}: {}; {}", increment_of(result, each->at), each->formula, each->inputs)});
  text += table.text();
  if (shown.size() < result.margins.size())
    text += fmt::format("  ... of {}; RESULT.h5 and --margins have all\n",
                        program::counted(result.margins.size(), "margin"));
  return text;
}

std::string margins_csv(const JointResult& result) {
  Csv csv("joint,check,of,margin,allowable,applied,unit,case,increment,formula,inputs,direction");
  for (const Margin& each : result.margins)
    csv.line(result.header.name, each.check, each.of, fmt::to_string(each.margin), fmt::to_string(each.allowable),
             each.applied, each.unit, result.case_name[result.case_of[each.at]], increment_number(result, each.at),
             each.formula, each.inputs, each.direction);
  return csv.text();
}

}  // namespace fastjoint::stage3
