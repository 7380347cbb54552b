// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/interfaces/interface.hpp"

namespace fastjoint::stage3 {

/// An interface with the indices of its first row and its first friction column in the joint.
struct PlacedInterface {
  std::shared_ptr<const Interface> interface;
  Index row = 0, friction = 0;
};

/// Response of an interface with the same indices.
struct PlacedResponse : Response {
  Index row = 0, friction = 0;
};

/// Responses of all interfaces of a joint to its contact coordinates: forces and displacements of n shear planes in a
/// directions, row plane * a + direction, then those of the moments of rims of contact, r rows in all, and amplitudes
/// of friction.
struct ContactState {
  VectorXd F;                         ///< (r) bearing forces, force
  VectorXd delta;                     ///< (r) relative displacements of the discs, and moments, length
  VectorXd Lambda;                    ///< (t) amplitudes of friction
  std::vector<PlacedResponse> parts;  ///< of each interface, with derivatives
  MatrixXd direction;                 ///< (a, n) unit vectors along c of the planes
  std::optional<Index> failed;        ///< a row past the limit load of its interface

  /// Index of the part with a row.
  [[nodiscard]] Index part_of(Index row) const {
    return std::ranges::upper_bound(parts, row, {}, &PlacedResponse::row) - parts.begin() - 1;
  }
  /// Derivative dF / dc or d delta / dc of a plane along c.
  [[nodiscard]] double along(MatrixXd Response::*slopes, Index plane) const;
  /// Sets Lambda and its derivatives to none.
  void leave_out_friction();
  /// Product of A and the block diagonal matrix of derivatives, shape as A, (rows, r).
  [[nodiscard]] MatrixXd times(const MatrixXd& A, MatrixXd Response::*slopes) const;
  /// Product of that matrix and x, (r, columns).
  [[nodiscard]] MatrixXd product(MatrixXd Response::*slopes, const MatrixXd& x) const;
  /// Changes of the amplitudes of friction, (t, columns): the derivative by c times dc, (r, columns).
  [[nodiscard]] MatrixXd friction_by(const MatrixXd& dc) const;
};

/// @param history One of each interface, or none. @param n_directions a. @param n_planes n.
/// @param c Contact coordinates, shape (r), force.
[[nodiscard]] ContactState contact_state(const std::vector<PlacedInterface>& interfaces,
                                         const std::vector<History>& history, Index n_directions, Index n_planes,
                                         const VectorXd& c);

/// Lengths of vectors in a directions, row plane * a + direction, (n); with one direction the entries with their signs.
[[nodiscard]] VectorXd magnitudes(const VectorXd& vectors, Index n_directions);

}  // namespace fastjoint::stage3
