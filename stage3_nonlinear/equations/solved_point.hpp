// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equations/stability.hpp"

namespace fastjoint::stage3 {

/// Derivatives of the bearing forces as vectors, one column for each number (docs/theory.md, section 10).
struct Slopes {
  MatrixXd F;  ///< (r, columns); of the planes alone where the residual is not given and the tangent is regular
  MatrixXd c;  ///< (r, columns) of the contact coordinates
  std::vector<Index> no_column, no_row;  ///< columns and rows of F that have no derivative
};

/// Solution of the equations with its tangent, which is factorised once for all that is asked of it: how stable the
/// solution is, and derivatives by whatever the residual depends on. Without load, where cosine friction must first
/// find the sides that bear, it is factorised for each trial of them.
class SolvedPoint {
 public:
  /// @param equations With the history at the begin of the increment. @param c Contact coordinates, (r), force.
  SolvedPoint(JointEquations equations, double load_factor, VectorXd c);

  [[nodiscard]] const JointEquations& equations() const { return equations_; }
  [[nodiscard]] double load_factor() const { return load_factor_; }
  [[nodiscard]] const VectorXd& c() const { return c_; }
  /// Forces and displacements.
  [[nodiscard]] const ContactState& state() const { return state_; }
  /// State of the tangent, on the side of a corner on which a fastener bears more. Its forces tell on which sides rims
  /// bear; without load, when none bears yet, they are those of a small load.
  [[nodiscard]] const ContactState& beyond() const { return beyond_; }
  [[nodiscard]] const TangentCheck& check() const { return check_; }

  /// Slopes by the implicit function theorem: dF = F_c dc with J dc = -residual.
  /// @param residual Rise of the residual of the condensed system at fixed c, force, shape (r, columns); the identity
  ///                 unless given, for which slopes of moments and of c may be left out.
  [[nodiscard]] Slopes slopes(const std::optional<MatrixXd>& residual = std::nullopt) const;
  /// Slopes of the forces' amounts, (n, columns); infinite where they do not exist.
  [[nodiscard]] MatrixXd of_amounts(const Slopes& slopes) const;

  /// Number of tangents that this thread has factorised for solutions, for tests and benchmarks.
  [[nodiscard]] static Index n_factorised();

 private:
  void factorise();
  void bear();
  [[nodiscard]] Slopes slopes_of_singular(const MatrixXd& rhs) const;
  [[nodiscard]] Slopes back_from_singular() const;

  JointEquations equations_;
  double load_factor_;
  VectorXd c_;
  ContactState state_, beyond_;
  // The tangent's inverse where it has a Hessian that is surely regular; else its factor.
  std::optional<MatrixXd> inverse_;
  std::unique_ptr<TangentFactor> factor_;
  VectorXd scale_;  ///< what its columns are divided by before
  TangentCheck check_;
};

}  // namespace fastjoint::stage3
