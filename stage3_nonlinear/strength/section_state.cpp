// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/section_state.hpp"

#include <algorithm>
#include <cmath>

#include "common/infinite.hpp"

namespace fastjoint::stage3 {

SectionState section_state(const HoleSections& sections, const std::vector<SectionForces>& forces,
                           const Eigen::Vector2d& T, double largest, double energy_error, double peak) {
  SectionState state;
  if (sections.number() == 0) return state;
  const auto load = [&](const Principal& stress) {
    return stress.value * sections.gross_area_across(stress.direction);
  };
  const auto bypass = [&](std::size_t level) { return larger_principal(sections.bypass(forces[level], T, largest)); };
  constexpr double rounding = 1e-9;
  const MeanStress passing_by = sections.bypass(forces[0], T, largest);
  const Principal passing = larger_principal(passing_by);
  state.bypass_load = load(passing);
  state.bypass_stress = passing.value;
  state.bypass_across = passing_by[0] + passing_by[1] - passing.value;  // the trace is that of any axes
  if (!passing_by.allFinite()) state.bypass_across = infinite;
  if (std::abs(state.bypass_load) > rounding * largest) state.bypass_direction = passing.direction;
  const bool is_known = forces.size() > 1 && std::isfinite(state.bypass_load);
  state.bypass_error =
      is_known ? std::max(std::abs(load(bypass(1)) - state.bypass_load), energy_error * largest) : infinite;
  const Principal net = largest_tension(sections.net(forces[0], T, largest));
  state.net_stress = net.value;
  const MeanStress more_loaded = sections.gross(forces[0], T, largest);
  state.gross_stress = more_loaded.head<2>();
  const Principal gross = larger_principal(more_loaded);
  const double carried = std::abs(load(gross));
  // The peak has nothing to do with what the sections carry if that is less than this part of the load.
  constexpr double min_carried = 1e-3;
  if (!std::isfinite(carried) || !(carried > min_carried * std::max(largest, T.norm()))) return state;
  state.net_direction = net.direction;
  // Interference makes stresses without resultants, so that these are errors only.
  if (forces.size() > 1 && carried < state.bypass_error) return state;
  state.in_tension = gross.value > 0;
  if (std::isnan(peak)) return state;
  state.gross_concentration = peak / std::abs(gross.value);
  const double share = sections.net_share(gross.direction);
  if (std::isfinite(net.value)) state.net_concentration = state.gross_concentration * share;
  return state;
}

}  // namespace fastjoint::stage3
