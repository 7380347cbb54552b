// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "stage3_nonlinear/interfaces/compression_only_rim.hpp"
#include "stage3_nonlinear/interfaces/rim_friction.hpp"
#include "stage3_nonlinear/model/contact_rims.hpp"

namespace fastjoint::stage3 {

/// Solution of the local problem of a rim.
struct RimSolution {
  VectorXd w;             ///< (n) all waves of the disc's normal displacement relative to the sheet, without the
                          ///< compliance of an elastic disk, length
  Touching touching;      ///< where disc and rim touch
  VectorXd forces;        ///< (n) all waves of the pressure times the area, force
  RimFriction friction;   ///< of all waves; empty without friction
  bool converged = true;  ///< without friction there is one solution, which is always found
  // Only of RimProblem::solve.
  MatrixXd w_by_c{};   ///< (n, n_long) derivative by the contact coordinates, length / force
  VectorXd w_by_mu{};  ///< (n) by the coefficient of friction, length; 0 without friction
};

/// The local problem of a rim of contact: all waves of its displacement and pressure, short ones included, for given
/// contact coordinates c = F + k delta of its long waves (docs/theory.md, section 6.4),
///   w + M_k f + M_tau tau = (c / k, 0),   f = kappa <w - g>_+ in waves,   M_k = M / A - 1 / kappa
/// and 1 / k for long waves.
/// Without friction the solution minimises a strictly convex function.
///
/// Between the rims are springs of the compliance that all waves beyond the shortest have; it is subtracted from M_k
/// (docs/theory.md, section 6.8).
class RimProblem {
 public:
  /// @param area Area of the rim, length^2. @param k Stiffness of the coordinates, force / length.
  /// @param compared The same rim with other waves, which shows the error of peaks by these; may be null.
  RimProblem(std::shared_ptr<const ShortWaves> waves, double area, double k, double gap, double mu,
             std::shared_ptr<const RimProblem> compared = nullptr);

  [[nodiscard]] const CompressionOnlyRim& contact() const { return contact_; }
  [[nodiscard]] const std::shared_ptr<const ShortWaves>& waves() const { return waves_; }
  [[nodiscard]] const std::shared_ptr<const RimProblem>& compared() const { return compared_; }
  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] double k() const { return k_; }
  [[nodiscard]] Index n_long() const { return waves_->n_long; }
  /// Pressure per unit of overlap of the rims, force / length^3.
  [[nodiscard]] double modulus() const { return contact_.stiffness() / area_; }
  /// Waves of the disc's normal displacement relative to the sheet, with the compliance of an elastic disk, (n),
  /// length.
  /// @param shear Waves of the shear on the sheet, none without friction.
  [[nodiscard]] VectorXd against_sheet(const VectorXd& w, const VectorXd& pressure, const VectorXd& shear) const;
  /// The same rim with another gap and friction, whose first iteration starts at the last solution of this one.
  [[nodiscard]] RimProblem with(double gap, double mu) const;

  /// Solution at contact coordinates c, (n_long), force. The last one is kept for repeated calls and as the next start.
  [[nodiscard]] const RimSolution& solve(const VectorXd& c) const;
  /// That of `compared`, which starts at the solution of this problem.
  [[nodiscard]] const RimSolution& solve_compared(const VectorXd& c) const;
  /// `compared` if it has more waves and a solution at c, else this problem; and the solution.
  [[nodiscard]] const RimProblem& finest_at(const VectorXd& c) const {
    return compared_ && compared_->waves_->n > waves_->n && solve_compared(c).converged ? *compared_ : *this;
  }
  [[nodiscard]] const RimSolution& solve_finest(const VectorXd& c) const {
    return &finest_at(c) == this ? solve(c) : solve_compared(c);
  }
  /// Contact for given waves w, (n), length, whatever their coordinates.
  [[nodiscard]] RimSolution contact_at(VectorXd w) const;

 private:
  [[nodiscard]] bool is_solved_at(const VectorXd& c) const { return is_solved_ && last_c_ == c; }
  /// Keeps the solution at c. @param start (n) w, or none.
  void solve_from(const VectorXd& start, const VectorXd& c) const;
  [[nodiscard]] RimSolution solution(const VectorXd& c, const VectorXd& start) const;
  void add_derivatives(RimSolution& solution) const;
  /// Contact at a displacement w = b + root s, (n).
  struct State {
    VectorXd s, w;
    Touching touching;
    VectorXd forces, scaled_forces;  ///< f, and root^T f
    RimFriction friction;
    VectorXd residual;  ///< w + M_k f + M_tau tau - b
  };
  [[nodiscard]] VectorXd forward(const VectorXd& s) const;           ///< root s
  [[nodiscard]] VectorXd back(const VectorXd& f) const;              ///< root^T f
  [[nodiscard]] MatrixXd solve_root(const MatrixXd& x) const;        ///< root^-1 x
  [[nodiscard]] MatrixXd curvature(const Touching& touching) const;  ///< 1 + root^T df/dw root
  [[nodiscard]] State frictionless_state(const VectorXd& b, VectorXd s) const;
  [[nodiscard]] State solve_frictionless(const VectorXd& b, const VectorXd& w) const;
  [[nodiscard]] State state_with_friction(const VectorXd& b, VectorXd w) const;
  [[nodiscard]] bool solve_with_friction(const VectorXd& b, State& at) const;
  /// @param w Solution without friction. @param at Solution, if there is one.
  [[nodiscard]] bool solve_by_more_friction(const VectorXd& b, VectorXd w, State& at) const;
  /// Derivative of the residual by w, (n, n), dimensionless.
  [[nodiscard]] MatrixXd jacobian(const Touching& touching, const RimFriction& friction) const;

  std::shared_ptr<const ShortWaves> waves_;
  std::shared_ptr<const RimProblem> compared_;
  double area_, k_;
  CompressionOnlyRim contact_;
  bool is_diagonal_;                                    ///< M_k, as in an isotropic sheet
  VectorXd diagonal_;                                   ///< (n) M_k - M / A, which is diagonal, length / force
  Eigen::SparseMatrix<double, Eigen::RowMajor> M_tau_;  ///< used if M_k is diagonal: few entries are not zero
  MatrixXd root_;                   ///< M_k = root root^T; only its diagonal, (n, 1), if M_k is diagonal
  mutable bool is_solved_ = false;  ///< last_ is of this rim; else of the rim that this one was copied from
  mutable VectorXd last_c_;
  mutable RimSolution last_;
};

}  // namespace fastjoint::stage3
