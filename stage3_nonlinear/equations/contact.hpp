// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/interfaces/interface.hpp"

namespace fastjoint::stage3 {

/// An interface with its first row and its first friction column among those of the joint.
struct PlacedInterface {
  std::shared_ptr<const Interface> interface;
  Index row = 0, friction = 0;
};

/// Answers of all interfaces of a joint to its contact coordinates: forces and displacements of n shear planes in a
/// directions, row plane * a + direction, behind them those of the moments of rims of contact, r rows in all, and
/// amounts of friction.
struct ContactState {
  VectorXd F;                   ///< (r) bearing forces, force
  VectorXd delta;               ///< (r) relative displacements of the discs, and moments, length
  VectorXd Lambda;              ///< (t) amounts of friction
  std::vector<Response> parts;  ///< of each interface, with derivatives
  MatrixXd direction;           ///< (a, n) unit vectors along c of the planes
  std::optional<Index> spent;   ///< a row past all that its interface can carry

  /// Derivative dF / dc or d delta / dc of a plane along c.
  [[nodiscard]] double along(MatrixXd Response::*slopes, Index plane) const;
  /// Product of A and the block diagonal matrix of derivatives, shape as A, (rows, r).
  [[nodiscard]] MatrixXd times(const MatrixXd& A, MatrixXd Response::*slopes) const;
  /// Product of that matrix and x, (r, columns).
  [[nodiscard]] MatrixXd product(MatrixXd Response::*slopes, const MatrixXd& x) const;
  /// Adds a factor times that matrix to A, (r, r).
  void add(double factor, MatrixXd Response::*slopes, MatrixXd& A) const;
  /// Amounts of friction by contact coordinates, (t, columns): the derivative times dc, (r, columns).
  [[nodiscard]] MatrixXd friction_by(const MatrixXd& dc) const;
};

/// @param history Of each interface, or none. @param n_directions a. @param n_planes n.
/// @param c Contact coordinates, shape (r), force.
[[nodiscard]] ContactState contact_state(const std::vector<PlacedInterface>& interfaces,
                                         const std::vector<History>& history, Index n_directions, Index n_planes,
                                         const VectorXd& c);

/// Lengths of vectors in a directions, row plane * a + direction, or with one direction the entries with their signs,
/// (n).
[[nodiscard]] VectorXd amounts(const VectorXd& vectors, Index n_directions);

}  // namespace fastjoint::stage3
