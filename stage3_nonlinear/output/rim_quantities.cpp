// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "common/count.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::Dimension;
using formats::RimHistory;
using stresses::RimState;

/// Column of the summary's table; its unit, if it has one, stands below the heading.
struct Column {
  double RimState::*value;
  const char* heading;
  int width;
  const char* format;
  bool has_unit = false;
  const char* unknown = "-";
};

using S = RimState;
constexpr auto columns = std::to_array<Column>({
    {&S::bearing_stress, "bearing stress", 14, "{:.6g}", true},
    {&S::bypass_load, "bypass", 14, "{:.6g}", true},
    {&S::peak_hoop, "peak hoop", 14, "{:.6g}", true},
    {&S::peak_angle, "at [deg]", 9, "{:.1f}"},
    {&S::peak_error, "+-", 9, "{:.1e}", false, "?"},
    {&S::gross_concentration, "Kt gross", 8, "{:.3f}"},
    {&S::net_concentration, "Kt net", 8, "{:.3f}"},
    {&S::across, "held across", 12, "{:.6g}", true},
});

/// What a column shows; only `across`, a force, is no quantity of RESULT.h5.
formats::RimQuantity shown(const Column& column) {
  for (const auto& quantity : formats::rim_quantities())
    if (column.value == quantity.value) return quantity;
  return {"across", nullptr, Dimension::force, ""};
}

/// @param cell Text in each column, which stands to the right.
template <class Cell>
std::string row(const std::string& name, Cell cell) {
  std::string text = fmt::format("  {:<24}", name);
  for (const auto& column : columns) text += fmt::format(" {:>{}}", cell(column), column.width);
  return text + "\n";
}

}  // namespace

std::vector<std::string> rim_csv_heads(const std::string& side, const Units& units) {
  std::vector<std::string> heads;
  for (const auto& each : formats::rim_quantities()) {
    heads.push_back(fmt::format("{}_{}", each.name, side));
    if (each.dimension != Dimension::ratio) heads.back() += fmt::format(" [{}]", unit_of(each.dimension, units));
  }
  return heads;
}

std::vector<std::string> rim_csv_fields(const RimHistory& rims, const std::string& hole, Index step) {
  const int at = index_of(rims.hole, hole);
  std::vector<std::string> fields;
  for (const auto& each : formats::rim_quantities()) {
    const bool has = at < count_of(rims.hole) && (!each.needs_section || rims.sections[at] > 0);
    const double value = has ? rims.values[step][at].*each.value : std::nan("");
    fields.push_back(std::isfinite(value) ? fmt::to_string(value) : "");
  }
  return fields;
}

std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < state.plates[i].rims.size(); ++rim) {
      const std::string& hole = joint.plates[i].stresses.rim_hole[rim];
      const bool sections = stresses::n_sections(joint.plates[i].stresses, hole) > 0;
      rows += row(joint.plates[i].name + ":" + hole, [&](const Column& column) {
        const double value = state.plates[i].rims[rim].*column.value;
        const auto quantity = shown(column);
        const bool unloaded = quantity.dimension == Dimension::ratio && value == 0;
        if (!std::isfinite(value) || unloaded || (quantity.needs_section && !sections))
          return std::string(column.unknown);
        return fmt::format(fmt::runtime(column.format), value == 0 ? 0 : value);
      });
    }
  const auto unit_below = [&](const Column& each) {
    return each.has_unit ? fmt::format("[{}]", unit_of(shown(each).dimension, joint.units)) : "";
  };
  return rows.empty() ? rows : row("hole", std::mem_fn(&Column::heading)) + row("", unit_below) + rows;
}

}  // namespace fastjoint::stage3
