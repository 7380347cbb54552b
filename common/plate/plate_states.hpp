// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>

#include "common/plate/plate_factor.hpp"

namespace fastjoint::plate {

/// Displacements of a plate in k states at one degree. Those of the skeleton are stored; those inside an element are
/// computed on request.
class PlateStates {
 public:
  /// @param factor Factor to solve with; must outlive this.
  /// @param border Controlled displacements and amplitudes of loaded waves and friction cases, shape (n_prescribed, k).
  /// @param loads  Further loads on the plate's unknowns, shape (n_free(p), k); most entries are zero.
  PlateStates(const PlateFactor& factor, const Eigen::MatrixXd& border, const Eigen::SparseMatrix<double>& loads);

  /// Forces on the controlled displacements in every state, without the loads applied to them directly, then the
  /// integrals of PlateFactor::condensed, (n_border, k).
  [[nodiscard]] Eigen::MatrixXd forces() const;
  /// Work of the loads of each state on the displacements of each, shape (k, k).
  [[nodiscard]] Eigen::MatrixXd work() const;
  /// Bound of the change of each state's energy by rounding of the plate's stiffness, (k): the machine precision times
  /// the sum over the skeleton and the controlled displacements of the diagonal entry times the displacement's square.
  [[nodiscard]] Eigen::VectorXd rounding() const;

  [[nodiscard]] Eigen::Index size() const { return skeleton_.rows(); }
  /// Coefficients of all modes of an element, local signs, shape (2 n_modes, k): first those of u_x; 0 for modes above
  /// the degree.
  [[nodiscard]] Eigen::MatrixXd coefficients(int element) const;

  /// Values of the functions in every state, shape (k, r).
  [[nodiscard]] Eigen::MatrixXd values(const CondensedFunctions& functions) const;

 private:
  /// Condenses loads on interior unknowns onto the skeleton and the border.
  void eliminate(const Eigen::SparseMatrix<double>& loads);
  /// Coefficients of an element's boundary unknowns, then of its border, shape (k, n_boundary).
  [[nodiscard]] Eigen::MatrixXd boundary_coefficients(int element) const;

  const PlateFactor& factor_;
  Eigen::MatrixXd border_;                         ///< (k, n_border)
  Eigen::MatrixXd skeleton_;                       ///< (k, skeleton)
  Eigen::MatrixXd skeleton_loads_, border_loads_;  ///< (k, skeleton), (k, n_border); empty if there are no loads
  std::map<int, Eigen::MatrixXd> interior_;        ///< L^-1 b, (n_interior, k), of elements with interior loads
};

}  // namespace fastjoint::plate
