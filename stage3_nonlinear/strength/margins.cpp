// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/margins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace fastjoint::stage3 {
namespace {

using formats::Margin;

/// The worst increment of an item.
struct WorstIncrement {
  std::optional<Margin> margin{};  ///< none if it is not known at any
  bool solved = false;             ///< there are increments of its check's cases
  bool known = true;               ///< at all of these
};

WorstIncrement worst_of(const CheckedItem& item, const formats::JointResult& a, const JointColumns& columns) {
  const CheckScene& check = *item.check;
  WorstIncrement found;
  std::optional<Margin>& worst = found.margin;
  for (int step = 0; step < a.load_factor.size(); ++step) {
    if (!check.counts(a.case_name[a.case_of[step]])) continue;
    found.solved = true;
    const Applied now = item.at(columns, step);
    found.known &= std::isfinite(now.applied);
    if (!std::isfinite(now.applied)) continue;
    const double margin = item.margin(now);
    if (worst && !(margin < worst->margin)) continue;
    const std::string inputs =
        fmt::format("{}, FS = {:g}, FF = {:g}", now.inputs, check.safety_factor, check.fitting_factor);
    worst = {check.name,    item.of,     item.formula,   inputs,        item.unit, margin,
             now.allowable, now.applied, now.edge_ratio, now.direction, step};
  }
  return found;
}

}  // namespace

std::vector<Margin> margins(const std::vector<CheckedItem>& items, const formats::JointResult& result,
                            LeftOut& left_out) {
  JointColumns columns{&result.columns, {}};
  for (const auto& plate : result.plates) columns.plates.push_back(&plate.columns);
  std::vector<Margin> all;
  for (const auto& item : items) {
    const auto [worst, solved, known] = worst_of(item, result, columns);
    if (worst) all.push_back(*worst);
    const char* reason = solved ? item.unknown : "none of its cases was solved";
    if ((!worst || !known) && result.load_factor.size() > 0)
      left_out.add(*item.check, reason, item.of, worst.has_value());
  }
  // Equal ones, but for rounding, stay in the order of the joint.
  std::ranges::stable_sort(all, {}, [](const Margin& each) { return std::round(1e9 * each.margin); });
  return all;
}

std::vector<program::Warning> edge_warnings(const JointScene& scene, const std::vector<Margin>& margins) {
  constexpr double min_edge_ratio = 1.5;
  const auto worst = std::ranges::min_element(margins, {}, &Margin::edge_ratio);
  if (worst == margins.end() || !(worst->edge_ratio < min_edge_ratio)) return {};
  const auto n = std::ranges::count_if(margins, [](const Margin& each) { return each.edge_ratio < min_edge_ratio; });
  return {{"edge-distance-small",
           fmt::format(
               "{}: {} is {:.3g} diameters from the edge along its load{}: below {:g} allowables of bearing are not "
               "published, and here those of the check fall linearly to 0 where the rim touches the edge",
               scene.file, worst->of, worst->edge_ratio,
               n > 1 ? fmt::format(" (the worst of {})", program::counted(n, "margin")) : "", min_edge_ratio)}};
}

}  // namespace fastjoint::stage3
