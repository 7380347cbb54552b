// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::stresses {

/// Contact of a plate's fasteners with its rims in one state.
struct Contacts {
  std::vector<formats::ContactRim> rims{};  ///< (g)
  Eigen::VectorXd added{};                  ///< (k) amounts of their pressures, rim after rim, stress
  Eigen::VectorXd gap{};                    ///< (g) radial; interference is negative, length
};

/// Points of a rim of contact with the hoop stress there.
struct RimHoop {
  Eigen::VectorXd angle;  ///< (n) degrees counter-clockwise from x
  Eigen::MatrixXd hoop;   ///< (n, l) at l degrees, stress
};

/// Hoop stress at a rim of contact under the pressure max(K (w - gap), 0) itself, of which the unit cases hold waves of
/// some length only: each piece of 5 degrees is cut into ten, and the kinks of pressure at the ends of contact stand in
/// the hoop stress (docs/theory.md, section 11.1).
/// @param at     Hoop stresses of the state by the unit cases, at n points in equal steps.
/// @param radial Radial stresses likewise, (n, l).
/// @param share  Hoop stress over radial stress of short waves of pressure, (n).
/// @param rim    Of the contacts.
[[nodiscard]] RimHoop under_contact(const RimHoop& at, const Eigen::MatrixXd& radial, const Eigen::VectorXd& share,
                                    const Contacts& contacts, int rim);

}  // namespace fastjoint::stresses
