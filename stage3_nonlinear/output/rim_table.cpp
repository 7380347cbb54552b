// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/rim_table.hpp"

#include <fmt/format.h>

#include <cmath>

#include "stage3_nonlinear/output/rim_history.hpp"

namespace fastjoint::stage3 {
namespace {

std::string stress_row(const PlateModel& plate, std::size_t rim, const RimState& state) {
  const std::string& hole = plate.stresses.rim_hole[rim];
  std::string text = fmt::format("  {:<24} {:>14.6g}", fmt::format("{}:{}", plate.name, hole), state.bearing_stress);
  const bool known = n_sections(plate.stresses, hole) > 0;
  text += known ? fmt::format(" {:>14.6g}", state.bypass_load) : fmt::format(" {:>14}", "-");
  text += fmt::format(" {:>14.6g} {:>9.1f}", state.peak_hoop, state.peak_angle);
  text += std::isfinite(state.peak_error) ? fmt::format(" {:>9.1e}", state.peak_error) : fmt::format(" {:>9}", "?");
  text += known && state.gross_concentration != 0
              ? fmt::format(" {:>8.3f} {:>8.3f}", state.gross_concentration, state.net_concentration)
              : fmt::format(" {:>8} {:>8}", "-", "-");
  return text + (std::isfinite(state.across) ? fmt::format(" {:>12.6g}\n", state.across == 0 ? 0 : state.across)
                                             : fmt::format(" {:>12}\n", "-"));
}

}  // namespace

std::string rim_table(const JointModel& joint, const JointState& state) {
  std::string rows;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    for (std::size_t rim = 0; rim < state.plates[i].rims.size(); ++rim)
      rows += stress_row(joint.plates[i], rim, state.plates[i].rims[rim]);
  if (rows.empty()) return rows;
  const std::string stress = fmt::format("[{}]", unit(joint.units, -2, 1));
  const std::string force = fmt::format("[{}]", unit(joint.units, 0, 1));
  return fmt::format("  {:<24} {:>14} {:>14} {:>14} {:>9} {:>9} {:>8} {:>8} {:>12}\n", "hole", "bearing stress",
                     "bypass", "peak hoop", "at [deg]", "+-", "Kt gross", "Kt net", "held across") +
         fmt::format("  {:<24} {:>14} {:>14} {:>14} {:>50}\n", "", stress, force, stress, force) + rows;
}

}  // namespace fastjoint::stage3
