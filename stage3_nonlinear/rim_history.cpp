// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/rim_history.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using formats::RimHistory;

/// One quantity of a hole: where it comes from, where it goes.
struct Column {
  const char* name;
  double RimState::*state;
  Eigen::MatrixXd RimHistory::*table;
  bool needs_section;
};

constexpr std::array<Column, 10> columns = {{
    {"bearing_load", &RimState::bearing_load, &RimHistory::bearing_load, false},
    {"bearing_load_y", &RimState::bearing_load_y, &RimHistory::bearing_load_y, false},
    {"bearing_stress", &RimState::bearing_stress, &RimHistory::bearing_stress, false},
    {"bypass_load", &RimState::bypass_load, &RimHistory::bypass_load, true},
    {"bypass_error", &RimState::bypass_error, &RimHistory::bypass_error, true},
    {"peak_hoop", &RimState::peak_hoop, &RimHistory::peak_hoop, false},
    {"peak_angle", &RimState::peak_angle, &RimHistory::peak_angle, false},
    {"peak_error", &RimState::peak_error, &RimHistory::peak_error, false},
    {"gross_concentration", &RimState::gross_concentration, &RimHistory::gross_concentration, true},
    {"net_concentration", &RimState::net_concentration, &RimHistory::net_concentration, true},
}};

/// How many sections across x the plate has beside the hole.
int n_sections(const formats::PlateStresses& a, const std::string& hole) {
  int n = 0;
  for (std::size_t i = 0; i < a.section_hole.size(); ++i)
    if (a.section_hole[i] == hole && a.section_side[i].back() == 'x') ++n;
  return n;
}

/// {plate, rim} of the rims of which `what` holds at some step.
std::vector<std::pair<std::size_t, std::size_t>> rims_that(const JointModel& joint,
                                                           const std::vector<JointState>& states,
                                                           bool RimState::*what) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < joint.plates[i].stresses.rim_hole.size(); ++rim) {
      const auto holds = [&](const JointState& state) {
        return rim < state.plates[i].rims.size() && state.plates[i].rims[rim].*what;
      };
      if (std::any_of(states.begin(), states.end(), holds)) result.emplace_back(i, rim);
    }
  return result;
}

std::string stress_row(const PlateModel& plate, std::size_t rim, const RimState& state) {
  const std::string& hole = plate.stresses.rim_hole[rim];
  std::string text = fmt::format("  {:<24} {:>14.6g}", fmt::format("{}:{}", plate.name, hole), state.bearing_stress);
  const bool known = n_sections(plate.stresses, hole) > 0;
  text += known ? fmt::format(" {:>14.6g}", state.bypass_load) : fmt::format(" {:>14}", "-");
  text += fmt::format(" {:>14.6g} {:>9.1f}", state.peak_hoop, state.peak_angle);
  text += std::isfinite(state.peak_error) ? fmt::format(" {:>9.1e}", state.peak_error) : fmt::format(" {:>9}", "?");
  if (known && state.gross_concentration != 0)
    return text + fmt::format(" {:>8.3f} {:>8.3f}\n", state.gross_concentration, state.net_concentration);
  return text + fmt::format(" {:>8} {:>8}\n", "-", "-");
}

}  // namespace

RimHistory rim_history(const PlateModel& plate, const std::vector<JointState>& states, std::size_t at) {
  RimHistory rims;
  if (plate.stress_level) rims.hole = plate.stresses.rim_hole;
  const auto steps = static_cast<Index>(states.size());
  const auto r = static_cast<Index>(rims.hole.size());
  rims.sections.resize(r);
  for (Index i = 0; i < r; ++i) rims.sections[i] = n_sections(plate.stresses, rims.hole[static_cast<std::size_t>(i)]);
  for (const auto& column : columns) {
    Eigen::MatrixXd& table = rims.*column.table;
    table.resize(steps, r);
    for (Index step = 0; step < steps; ++step)
      for (Index i = 0; i < r; ++i)
        table(step, i) =
            states[static_cast<std::size_t>(step)].plates[at].rims[static_cast<std::size_t>(i)].*column.state;
  }
  return rims;
}

std::string rim_csv_names(const std::string& end) {
  std::string text;
  for (const auto& column : columns) text += fmt::format(",{}_{}", column.name, end);
  return text;
}

std::string rim_csv_fields(const RimHistory& rims, const std::string& hole, Index step) {
  const auto found = std::find(rims.hole.begin(), rims.hole.end(), hole);
  if (found == rims.hole.end()) return std::string(columns.size(), ',');
  const Index at = found - rims.hole.begin();
  std::string text;
  for (const auto& column : columns) {
    const double value = (rims.*column.table)(step, at);
    const bool known = std::isfinite(value) && (!column.needs_section || rims.sections[at] > 0);
    text += known ? fmt::format(",{}", value) : std::string(",");
  }
  return text;
}

std::vector<std::string> pulled_rims(const JointModel& joint, const std::vector<JointState>& states) {
  std::vector<std::string> result;
  for (const auto& [plate, rim] : rims_that(joint, states, &RimState::pulls))
    result.push_back(fmt::format(
        "{}: rim/sigma_rr: the springs of hole \"{}\" pull the sheet instead of pushing it: they act on the "
        "arc that does not bear under these loads; give its spring the other \"arc\" in PLATE.json",
        joint.plates[plate].file, joint.plates[plate].stresses.rim_hole[rim]));
  return result;
}

std::vector<std::string> friction_off_axes(const JointModel& joint, const std::vector<JointState>& states) {
  std::vector<std::string> holes;
  for (const auto& [plate, rim] : rims_that(joint, states, &RimState::by_components))
    holes.push_back(fmt::format("{}:{}", joint.plates[plate].name, joint.plates[plate].stresses.rim_hole[rim]));
  if (holes.empty()) return {};
  return {
      fmt::format("{}: friction acts off the axes, by its components along x and y, at {}: the loads hold, but peak "
                  "hoop stresses there may lack what friction adds to them, most of it at 45 degrees",
                  joint.file, fmt::join(holes, ", "))};
}

std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < state.plates[i].rims.size(); ++rim)
      rows += stress_row(joint.plates[i], rim, state.plates[i].rims[rim]);
  if (rows.empty()) return rows;
  const std::string stress = fmt::format("[{}]", formats::unit(joint.units, -2, 1));
  const std::string force = fmt::format("[{}]", formats::unit(joint.units, 0, 1));
  return fmt::format("  {:<24} {:>14} {:>14} {:>14} {:>9} {:>9} {:>8} {:>8}\n", "hole", "bearing F/(d t)", "bypass",
                     "peak hoop", "at [deg]", "+-", "Kt gross", "Kt net") +
         fmt::format("  {:<24} {:>14} {:>14} {:>14}\n", "", stress, force, stress) + rows;
}

}  // namespace fastjoint::stage3
