// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Law of a shear plane as a map from its contact coordinate c, a vector in force units with one entry for each
/// direction of the joint's discs: F and delta are along c, and their amounts those of the law at |c|. With one
/// direction the law is odd; with two the clearance is a circle.
struct Contact {
  LawPointer law;
  double clearance = 0;    ///< length
  double stiffness = 1;    ///< k, force / length: of the plates at this plane, so that F and k delta balance
  bool one_sided = false;  ///< open for every c < 0; one direction only

  /// True if it is one-sided and c, shape (a), is on its other side.
  [[nodiscard]] bool is_pulled_open(const VectorXd& c) const { return one_sided && c[0] < 0; }
};

/// Derivative of a vector by c for each plane: `along` c and `across` it (of one direction only `along` counts), and
/// for each rim of contact.
struct Blocks {
  VectorXd along, across;           ///< (n)
  std::vector<MatrixXd> rims = {};  ///< symmetric
};

/// Forces and displacements of n shear planes in a directions, row plane * a + direction, behind them those of the
/// moments of rims of contact, r rows in all, and their derivatives by c.
struct ContactState {
  VectorXd F;                         ///< (r) bearing forces, force
  VectorXd delta;                     ///< (r) relative displacements of the discs, length
  MatrixXd direction;                 ///< (a, n) unit vectors along c
  Blocks dF;                          ///< dF / dc, dimensionless; 0 where open
  Blocks ddelta;                      ///< d delta / dc, length / force
  std::optional<Index> spent;         ///< a plane past all that it can carry
  VectorXd shear = {};                ///< (s) forces of the shears of rims of contact with friction, rim after rim
  std::vector<MatrixXd> dshear = {};  ///< of each rim of contact its shears by its c; no rows without friction

  /// Product of A and the block diagonal matrix, shape as A, (rows, r).
  [[nodiscard]] MatrixXd times(const MatrixXd& A, const Blocks& blocks) const;
  /// Adds a factor times the block diagonal matrix to A, (r, r).
  void add(double factor, const Blocks& blocks, MatrixXd& A) const;
};

/// Lengths of vectors in a directions, row plane * a + direction, or with one direction the entries with their signs,
/// (n).
[[nodiscard]] VectorXd amounts(const VectorXd& vectors, Index n_directions);

// The functions below know the planes alone: r = n a.

/// @param c Contact coordinates, shape (n a), force.
[[nodiscard]] ContactState contact_state(const std::vector<Contact>& contacts, const VectorXd& c);

/// Coordinates at which the bearing forces are F, or about that; where a fastener cannot carry F it is left open.
///
/// @param F Shape (n a), force.
[[nodiscard]] VectorXd contact_coordinates(const std::vector<Contact>& contacts, const VectorXd& F);

}  // namespace fastjoint::stage3
