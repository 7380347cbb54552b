// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::RimHistory;

using S = RimState;
using H = RimHistory;
enum Unit { force, stress, degrees, ratio };

/// Column of the summary's table; its unit, if it has one, stands below the heading.
struct Heading {
  const char* text;
  int width;
  const char* format;
  bool has_unit = false;
  const char* unknown = "-";
};

/// Quantity of a hole: where it comes from and where it goes, to RESULT.h5 and the CSV, to the summary.
struct Quantity {
  const char* name;  ///< in the CSV
  Unit unit;
  double S::*state;
  Eigen::MatrixXd H::*history;  ///< none: in the summary alone
  bool needs_section = false;
  Heading heading{};  ///< without text: not in the summary
};

constexpr std::array<Quantity, 11> quantities = {{
    {"bearing_load", force, &S::bearing_load, &H::bearing_load},
    {"bearing_load_y", force, &S::bearing_load_y, &H::bearing_load_y},
    {"bearing_stress", stress, &S::bearing_stress, &H::bearing_stress, false, {"bearing stress", 14, "{:.6g}", true}},
    {"bypass_load", force, &S::bypass_load, &H::bypass_load, true, {"bypass", 14, "{:.6g}", true}},
    {"bypass_error", force, &S::bypass_error, &H::bypass_error, true},
    {"peak_hoop", stress, &S::peak_hoop, &H::peak_hoop, false, {"peak hoop", 14, "{:.6g}", true}},
    {"peak_angle", degrees, &S::peak_angle, &H::peak_angle, false, {"at [deg]", 9, "{:.1f}"}},
    {"peak_error", stress, &S::peak_error, &H::peak_error, false, {"+-", 9, "{:.1e}", false, "?"}},
    {"gross_concentration", ratio, &S::gross_concentration, &H::gross_concentration, true, {"Kt gross", 8, "{:.3f}"}},
    {"net_concentration", ratio, &S::net_concentration, &H::net_concentration, true, {"Kt net", 8, "{:.3f}"}},
    {"across", force, &S::across, nullptr, false, {"held across", 12, "{:.6g}", true}},
}};

std::string unit_of(const Quantity& quantity, const Units& units) {
  if (quantity.unit == ratio) return "";
  return fmt::format("[{}]", std::array{unit(units, 0, 1), unit(units, -2, 1), std::string("deg")}[quantity.unit]);
}

/// Number of sections across x that the plate has beside the hole.
int n_sections(const formats::PlateStresses& a, const std::string& hole) {
  int n = 0;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i)
    n += a.section_hole[i] == hole && a.section_side[i].back() == 'x';
  return n;
}

/// @param cell Text of each quantity, which stands to the right.
template <class Cell>
std::string row(const std::string& name, Cell cell) {
  std::string text = fmt::format("  {:<24}", name);
  for (const auto& quantity : quantities)
    if (quantity.heading.text) text += fmt::format(" {:>{}}", cell(quantity), quantity.heading.width);
  return text + "\n";
}

}  // namespace

RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states, std::size_t at) {
  RimHistory rims;
  if (plate.stress_level) rims.hole = plate.stresses.rim_hole;
  const Index steps = states.size(), r = rims.hole.size();
  rims.sections.resize(r);
  for (Index i = 0; i < r; ++i) rims.sections[i] = n_sections(plate.stresses, rims.hole[i]);
  for (const auto& quantity : quantities)
    if (quantity.history)
      rims.*quantity.history = Eigen::MatrixXd::NullaryExpr(
          steps, r, [&](Index step, Index i) { return states[step].plates[at].rims[i].*quantity.state; });
  return rims;
}

std::vector<std::string> rim_csv_heads(const std::string& side, const Units& units) {
  std::vector<std::string> heads;
  for (const auto& quantity : quantities)
    if (quantity.history) {
      const std::string unit = unit_of(quantity, units);
      heads.push_back(fmt::format("{}_{}{}{}", quantity.name, side, unit.empty() ? "" : " ", unit));
    }
  return heads;
}

std::vector<std::string> rim_csv_fields(const RimHistory& rims, const std::string& hole, Index step) {
  const Index at = std::find(rims.hole.begin(), rims.hole.end(), hole) - rims.hole.begin();
  std::vector<std::string> fields;
  for (const auto& quantity : quantities) {
    if (!quantity.history) continue;
    const bool has = at < std::ssize(rims.hole) && (!quantity.needs_section || rims.sections[at] > 0);
    const double value = has ? (rims.*quantity.history)(step, at) : std::nan("");
    fields.push_back(std::isfinite(value) ? fmt::to_string(value) : "");
  }
  return fields;
}

std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < state.plates[i].rims.size(); ++rim) {
      const std::string& hole = joint.plates[i].stresses.rim_hole[rim];
      const bool sections = n_sections(joint.plates[i].stresses, hole) > 0;
      const RimState& values = state.plates[i].rims[rim];
      rows += row(joint.plates[i].name + ":" + hole, [&](const Quantity& quantity) {
        const double value = values.*quantity.state;
        const bool unloaded = quantity.unit == ratio && value == 0;
        if (!std::isfinite(value) || unloaded || (quantity.needs_section && !sections))
          return std::string(quantity.heading.unknown);
        return fmt::format(fmt::runtime(quantity.heading.format), value == 0 ? 0 : value);
      });
    }
  const auto unit_below = [&](const Quantity& each) { return each.heading.has_unit ? unit_of(each, joint.units) : ""; };
  const auto heading = [](const Quantity& each) { return each.heading.text; };
  return rows.empty() ? rows : row("hole", heading) + row("", unit_below) + rows;
}

}  // namespace fastjoint::stage3
