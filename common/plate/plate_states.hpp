// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>

#include "common/plate/plate_factor.hpp"

namespace fastjoint::plate {

/// Displacements of a plate in k states at one degree: those of the skeleton, from which those inside an element follow
/// where they are asked for.
class PlateStates {
 public:
  /// @param factor Factor to solve with; must outlive this.
  /// @param border Amounts of controlled displacements, waves that are loaded and friction cases, shape (n_amounts, k).
  /// @param loads  On the plate's unknowns beside, shape (n_p, k); few of them are not zero.
  PlateStates(const PlateFactor& factor, const Eigen::MatrixXd& border, const Eigen::SparseMatrix<double>& loads);

  /// Forces that must act on the controlled displacements in every state beside those of the loads on them, then the
  /// integrals of PlateFactor::condensed, (n_border, k).
  [[nodiscard]] Eigen::MatrixXd forces() const;
  /// Work of the loads of every state on the displacements of each, shape (k, k).
  [[nodiscard]] Eigen::MatrixXd work() const;
  /// Change of the energy of every state that rounding of the plate's stiffness may make, (k): times the machine's
  /// precision, the sum of the squares of the displacements on skeletons, each with its diagonal entry.
  [[nodiscard]] Eigen::VectorXd rounding() const;

  [[nodiscard]] Eigen::Index size() const { return skeleton_.rows(); }
  /// Coefficients of all modes of an element, local signs, shape (2 n_modes, k): first those of u_x; 0 of those above
  /// the degree.
  [[nodiscard]] Eigen::MatrixXd coefficients(int element) const;

  /// Condenses functions of an element's coefficients.
  /// @param weights Weight of each coefficient of all modes of the element, shape (2 n_modes, r).
  [[nodiscard]] static CondensedFunctions condense(const PlateFactor& factor, int element,
                                                   const Eigen::MatrixXd& weights);
  /// Values of the functions in every state, shape (k, r).
  [[nodiscard]] Eigen::MatrixXd values(const CondensedFunctions& functions) const;

 private:
  /// Takes loads inside elements to the skeleton and the border.
  void eliminate(const Eigen::SparseMatrix<double>& loads);
  /// Displacements that an element shares with others, then those of its border, shape (k, n_outside).
  [[nodiscard]] Eigen::MatrixXd outside(int element) const;

  const PlateFactor& factor_;
  Eigen::MatrixXd border_;                         ///< (k, n_border)
  Eigen::MatrixXd skeleton_;                       ///< (k, skeleton): what an element takes of it lies together
  Eigen::MatrixXd skeleton_loads_, border_loads_;  ///< (k, skeleton), (k, n_border); empty if there are no loads
  std::map<int, Eigen::MatrixXd> inside_;          ///< of the elements with loads inside, eliminated, (n_inside, k)
};

}  // namespace fastjoint::plate
