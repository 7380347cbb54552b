// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/law.hpp"

namespace fastjoint::stage3 {

/// A fastener as its contact coordinate c (force units) sees it: theory.md section 7, with w = k gap.
///
/// |c| < w: open, F = 0, delta = c / k. Beyond: the law at s = |c| - w, odd in c. One-sided: open for every c
/// < w.
struct Contact {
  std::shared_ptr<const Law> law;
  double gap = 0;        ///< delta0 of the law + clearance, length
  double stiffness = 1;  ///< k, force / length: that of the plates at this fastener, so that dF and S ddelta balance
  bool one_sided = false;
};

/// Forces and displacements of n fasteners and their derivatives by the contact coordinates; all of shape
/// (n).
struct ContactState {
  Eigen::VectorXd F;                  ///< bearing forces, force
  Eigen::VectorXd delta;              ///< relative displacements of the discs, length
  Eigen::VectorXd dF;                 ///< dF_j / dc_j, dimensionless; 0 where open
  Eigen::VectorXd ddelta;             ///< ddelta_j / dc_j, length / force
  std::optional<Eigen::Index> spent;  ///< a fastener past all that it can carry
};

/// @param c Contact coordinates, shape (n), force.
[[nodiscard]] ContactState contact_state(const std::vector<Contact>& contacts, const Eigen::VectorXd& c);

/// Coordinates at which the bearing forces are F, or about that; where a fastener cannot carry F it is left
/// open.
///
/// @param F Shape (n), force.
[[nodiscard]] Eigen::VectorXd contact_coordinates(const std::vector<Contact>& contacts, const Eigen::VectorXd& F);

}  // namespace fastjoint::stage3
