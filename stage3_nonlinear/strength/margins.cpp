// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/count.hpp"

namespace fastjoint::stage3 {
namespace {

/// One margin: the worst increment of an item.
struct WorstMargin {
  const CheckedItem* item;
  double margin = infinite;
  Applied at_worst{};
  Index at = -1;  ///< increment; -1: not known
};

/// @param solved Set to true if there are increments of its check's cases.
WorstMargin worst_of(const CheckedItem& item, const formats::JointResult& a, const JointColumns& columns,
                     bool& solved) {
  WorstMargin worst{&item};
  for (Index step = 0; step < a.load_factor.size(); ++step) {
    if (!item.check->counts(a.case_name[a.case_of[step]])) continue;
    solved = true;
    const Applied now = item.at(columns, step);
    if (!std::isfinite(now.applied)) continue;
    if (const double margin = item.margin(now); worst.at < 0 || margin < worst.margin)
      worst = {&item, margin, now, step};
  }
  return worst;
}

}  // namespace

formats::MarginTable margins(const JointScene& scene, const std::vector<CheckedItem>& items,
                             const formats::JointResult& result, std::vector<program::Warning>& left_out) {
  JointColumns columns{&result.columns, {}};
  for (const auto& plate : result.plates) columns.plates.push_back(&plate.columns);
  std::vector<WorstMargin> rows;
  std::map<std::pair<const CheckScene*, std::string>, std::vector<std::string>> missing;
  for (const auto& item : items) {
    bool solved = false;
    auto worst = worst_of(item, result, columns, solved);
    if (worst.at >= 0)
      rows.push_back(std::move(worst));
    else if (result.load_factor.size() > 0)
      missing[{item.check, solved ? item.unknown : "none of its cases was solved"}].push_back(item.of);
  }
  for (const auto& [of, names] : missing) left_out.push_back(left_out_warning(scene, *of.first, of.second, names));
  // Equal ones, but for rounding, stay in the order of the joint.
  std::ranges::stable_sort(rows, {}, [](const WorstMargin& row) { return std::round(1e9 * row.margin); });
  const Index n = std::ssize(rows);
  formats::MarginTable table;
  for (VectorXd* each : {&table.margin, &table.allowable, &table.applied, &table.edge_ratio, &table.direction})
    each->resize(n);
  table.at.resize(n);
  for (Index i = 0; i < n; ++i) {
    const auto& [item, margin, worst, at] = rows[i];
    const CheckScene& check = *item->check;
    table.check.push_back(check.name), table.of.push_back(item->of);
    table.formula.push_back(item->formula), table.unit.push_back(item->unit);
    table.inputs.push_back(
        fmt::format("{}, FS = {:g}, FF = {:g}", worst.inputs, check.safety_factor, check.fitting_factor));
    table.margin[i] = margin, table.allowable[i] = worst.allowable, table.applied[i] = worst.applied;
    table.edge_ratio[i] = worst.edge_ratio, table.direction[i] = worst.direction;
    table.at[i] = int(at);
  }
  return table;
}

std::vector<program::Warning> edge_warnings(const JointScene& scene, const formats::MarginTable& table) {
  constexpr double least = 1.5;
  if (table.edge_ratio.size() == 0) return {};
  Index worst = 0;
  if (!(table.edge_ratio.minCoeff(&worst) < least)) return {};
  const auto n = (table.edge_ratio.array() < least).count();
  return {{"edge-distance-small",
           fmt::format(
               "{}: {} is {:.3g} diameters from the edge along its load{}: below {:g} allowables of bearing are not "
               "published, and here those of the check fall linearly to 0 where the rim touches the edge",
               scene.file, table.of[worst], table.edge_ratio[worst],
               n > 1 ? fmt::format(" (the worst of {})", program::counted(n, "margin")) : "", least)}};
}

}  // namespace fastjoint::stage3
