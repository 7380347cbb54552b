// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/stability.hpp"

namespace fastjoint::stage3 {

/// Derivatives of the bearing forces as vectors, one column for each parameter (docs/theory.md, section 10).
struct Slopes {
  MatrixXd F;                            ///< (r, columns)
  MatrixXd c;                            ///< (r, columns) of the contact coordinates
  std::vector<Index> no_column, no_row;  ///< columns and rows of F that have no derivative
};

/// Solution of the equations with its tangent. One factorisation serves the check of stability and all derivatives of
/// the solution. Without load the bearing sides of cosine friction are found by trial, with a factorisation for each.
class SolvedPoint {
 public:
  /// @param equations With the history at the start of the increment. @param c Contact coordinates, (r), force.
  SolvedPoint(JointEquations equations, double load_factor, VectorXd c);

  [[nodiscard]] const JointEquations& equations() const { return equations_; }
  [[nodiscard]] double load_factor() const { return load_factor_; }
  [[nodiscard]] const VectorXd& c() const { return c_; }
  /// Forces and displacements.
  [[nodiscard]] const ContactState& state() const { return state_; }
  /// State of the tangent: at a corner it is that on the side of more bearing. Its forces determine the bearing sides
  /// of rims; without load they are those of a small load.
  [[nodiscard]] const ContactState& beyond() const { return beyond_; }
  [[nodiscard]] const TangentCheck& check() const { return check_; }

  /// Slopes by the implicit function theorem: dF = F_c dc with J dc = -residual.
  /// @param residual Derivative of the residual of the condensed system at fixed c, force, shape (r, columns).
  [[nodiscard]] Slopes slopes(const MatrixXd& residual) const;
  /// Slopes of the forces of the planes for the identity as that derivative, without those of c. In contact with rims
  /// they are estimates, to about a hundredth.
  [[nodiscard]] Slopes estimated_slopes() const;
  /// Slopes of the magnitudes of the forces, (n, columns); infinite where they do not exist.
  [[nodiscard]] MatrixXd of_magnitudes(const Slopes& slopes) const;

  /// Number of tangents that this thread has factorised for solutions, for tests and benchmarks.
  [[nodiscard]] static Index n_factorised();

 private:
  void factorise();
  /// Derivatives of the forces of the first rows by the contact coordinates, (rows, r).
  [[nodiscard]] MatrixXd forces_by_c(Index rows) const;
  /// Sets the rows of forces that have no derivative since they change along the null space of J.
  void find_rows_without_slope(Slopes& slopes) const;
  void find_bearing_sides();

  JointEquations equations_;
  double load_factor_;
  VectorXd c_;
  ContactState state_, beyond_;
  std::unique_ptr<TangentFactor> factor_;
  TangentCheck check_;
};

}  // namespace fastjoint::stage3
