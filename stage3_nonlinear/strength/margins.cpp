// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace fastjoint::stage3 {
namespace {

using formats::Margin;

/// The worst increment of an item; none if it is not known at any.
/// @param solved Set to true if there are increments of its check's cases.
std::optional<Margin> worst_of(const CheckedItem& item, const formats::JointResult& a, const JointColumns& columns,
                               bool& solved) {
  const CheckScene& check = *item.check;
  std::optional<Margin> worst;
  for (int step = 0; step < a.load_factor.size(); ++step) {
    if (!check.counts(a.case_name[a.case_of[step]])) continue;
    solved = true;
    const Applied now = item.at(columns, step);
    if (!std::isfinite(now.applied)) continue;
    const double margin = item.margin(now);
    if (worst && !(margin < worst->margin)) continue;
    const std::string inputs =
        fmt::format("{}, FS = {:g}, FF = {:g}", now.inputs, check.safety_factor, check.fitting_factor);
    worst = {check.name,    item.of,     item.formula,   inputs,        item.unit, margin,
             now.allowable, now.applied, now.edge_ratio, now.direction, step};
  }
  return worst;
}

}  // namespace

std::vector<Margin> margins(const JointScene& scene, const std::vector<CheckedItem>& items,
                            const formats::JointResult& result, std::vector<program::Warning>& left_out) {
  JointColumns columns{&result.columns, {}};
  for (const auto& plate : result.plates) columns.plates.push_back(&plate.columns);
  std::vector<Margin> all;
  std::map<std::pair<const CheckScene*, std::string>, std::vector<std::string>> missing;
  for (const auto& item : items) {
    bool solved = false;
    if (auto worst = worst_of(item, result, columns, solved))
      all.push_back(std::move(*worst));
    else if (result.load_factor.size() > 0)
      missing[{item.check, solved ? item.unknown : "none of its cases was solved"}].push_back(item.of);
  }
  for (const auto& [of, names] : missing) left_out.push_back(left_out_warning(scene, *of.first, of.second, names));
  // Equal ones, but for rounding, stay in the order of the joint.
  std::ranges::stable_sort(all, {}, [](const Margin& each) { return std::round(1e9 * each.margin); });
  return all;
}

std::vector<program::Warning> edge_warnings(const JointScene& scene, const std::vector<Margin>& margins) {
  constexpr double least = 1.5;
  const auto worst = std::ranges::min_element(margins, {}, &Margin::edge_ratio);
  if (worst == margins.end() || !(worst->edge_ratio < least)) return {};
  const auto n = std::ranges::count_if(margins, [](const Margin& each) { return each.edge_ratio < least; });
  return {{"edge-distance-small",
           fmt::format(
               "{}: {} is {:.3g} diameters from the edge along its load{}: below {:g} allowables of bearing are not "
               "published, and here those of the check fall linearly to 0 where the rim touches the edge",
               scene.file, worst->of, worst->edge_ratio,
               n > 1 ? fmt::format(" (the worst of {})", program::counted(n, "margin")) : "", least)}};
}

}  // namespace fastjoint::stage3
