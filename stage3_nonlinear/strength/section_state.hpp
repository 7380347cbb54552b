// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <vector>

#include "stage3_nonlinear/strength/section_stress.hpp"

namespace fastjoint::stage3 {

/// What the sections next to a hole say of it in one state; 0 of a hole without sections, infinite where not known.
struct SectionState {
  double bypass_load = 0, bypass_error = 0;
  double gross_concentration = 0, net_concentration = 0;  ///< for the larger section force; 0 without one
  double net_stress = 0;                                  ///< largest tension over the net sections, in any direction
  double bypass_stress = 0;                               ///< bypass load over the gross section, tension positive
  double bypass_across = 0;                               ///< the other principal stress of what passes by
  double bypass_direction = 0, net_direction = 0;         ///< of these two, degrees
  /// Normal stress of the more loaded sections across x and across y; not finite where it is not known.
  Eigen::Vector2d gross_stress{NAN, NAN};
  bool in_tension = false;  ///< the section used for the concentrations is in tension
};

/// Bypass load and its error, net stress, and concentrations (docs/theory.md, section 11.6).
///
/// A concentration is 0 if the force of its section is within rounding or within the error of the bypass load. That
/// error is its change from the degree below, but at least the square root of the relative error of S times the largest
/// force on the plate.
/// @param forces       At the joint's degree, then at the one below, if there is one.
/// @param T            Force of the fastener, friction included.
/// @param largest      Largest force on the plate.
/// @param energy_error Relative error of the plate's fields in the energy norm; resultants of stresses have about the
///                     same.
/// @param peak         Largest hoop stress of the hole; NaN if it is not known.
[[nodiscard]] SectionState section_state(const HoleSections& sections, const std::vector<SectionForces>& forces,
                                         const Eigen::Vector2d& T, double largest, double energy_error, double peak);

}  // namespace fastjoint::stage3
