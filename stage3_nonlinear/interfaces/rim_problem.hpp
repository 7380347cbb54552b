// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>

#include "stage3_nonlinear/interfaces/rim_contact.hpp"
#include "stage3_nonlinear/interfaces/rim_friction.hpp"
#include "stage3_nonlinear/model/contact_rims.hpp"

namespace fastjoint::stage3 {

/// Solution of a rim's own problem.
struct RimSolution {
  VectorXd w;             ///< (n) all waves of the disc's normal displacement against the sheet, without what an
                          ///< elastic disk yields, length
  Touching touching;      ///< where disc and rim touch
  VectorXd forces;        ///< (n) all waves of the pressure times the area, force
  RimFriction friction;   ///< of all waves; of no forces if nothing rubs
  MatrixXd w_by_c;        ///< (n, n_long) derivative by the contact coordinates, length / force
  VectorXd w_by_mu;       ///< (n) by the coefficient of friction, length; 0 if nothing rubs
  bool converged = true;  ///< where there is no friction there is one solution, which is always found
};

/// Stiffness K A of the springs between a rim and its disc, or of those that keep an elastic disk from overlapping,
/// force / length. @param k Of the rim's contact coordinates, likewise.
[[nodiscard]] double contact_stiffness(const formats::ContactRim& rim, const ShortWaves& waves, double k);

/// The problem of a rim of contact of its own: which waves its displacement and pressure have, short ones included, for
/// given contact coordinates c = F + k delta of its long waves (docs/theory.md, section 6.4),
///   w + M_k f + M_tau tau = (c / k, 0),   f = K A <w - g>_+ in waves,   M_k = M / A, and 1 / k more of long waves.
/// Without friction it is the place at which a strictly convex function is least.
///
/// An elastic disk has its own compliance in M_k and yields nothing else: the rims must not overlap. Springs that are
/// stiffer than any wave of the disk see to that, and what they yield is taken off M_k again (docs/theory.md,
/// section 6.7).
class RimProblem {
 public:
  /// @param area Of the rim, length^2. @param k Stiffness of the coordinates, force / length.
  RimProblem(RimContact contact, std::shared_ptr<const ShortWaves> waves, double area, double k);

  [[nodiscard]] const RimContact& contact() const { return contact_; }
  [[nodiscard]] const ShortWaves& waves() const { return *waves_; }
  [[nodiscard]] double area() const { return area_; }
  [[nodiscard]] double k() const { return k_; }
  [[nodiscard]] Index n_long() const { return waves_->n_long; }
  /// Pressure per overlap of the rims, force / length^3.
  [[nodiscard]] double modulus() const { return contact_.stiffness() / area_; }
  /// Waves of the disc's normal displacement against the sheet, with what an elastic disk yields, (n), length.
  /// @param shear Waves of the shear on the sheet, none without friction.
  [[nodiscard]] VectorXd against_sheet(const VectorXd& w, const VectorXd& pressure, const VectorXd& shear) const;
  /// The same rim with another gap and friction, whose first solution begins at the last one of this.
  [[nodiscard]] RimProblem with(double gap, double mu) const;

  /// @param c (n_long) force. The last solution is kept, since it is asked for again, and the next one begins there.
  [[nodiscard]] const RimSolution& solve(const VectorXd& c) const;

 private:
  [[nodiscard]] RimSolution solution(const VectorXd& c, const VectorXd& start) const;
  /// A displacement w = b + root s, (n), with what it makes.
  struct State {
    VectorXd s, w;
    Touching touching;
    VectorXd forces, pushed;  ///< f, and root^T f
    RimFriction friction;
    VectorXd residual;  ///< w + M_k f + M_tau tau - b
  };
  [[nodiscard]] VectorXd forward(const VectorXd& s) const;           ///< root s
  [[nodiscard]] VectorXd back(const VectorXd& f) const;              ///< root^T f
  [[nodiscard]] MatrixXd solve_root(const MatrixXd& x) const;        ///< root^-1 x
  [[nodiscard]] MatrixXd curvature(const Touching& touching) const;  ///< 1 + root^T df/dw root
  [[nodiscard]] State frictionless(const VectorXd& b, VectorXd s) const;
  [[nodiscard]] State without_friction(const VectorXd& b, const VectorXd& w) const;
  [[nodiscard]] State rubbing(const VectorXd& b, VectorXd w) const;
  [[nodiscard]] bool with_friction(const VectorXd& b, State& at) const;
  /// Derivative of the residual by w, (n, n), dimensionless.
  [[nodiscard]] MatrixXd jacobian(const State& at) const;

  RimContact contact_;
  std::shared_ptr<const ShortWaves> waves_;
  double area_, k_;
  bool is_diagonal_;  ///< M_k, as in an isotropic sheet
  VectorXd more_;     ///< (n) what M_k has on its diagonal besides M / A, length / force
  Eigen::SparseMatrix<double, Eigen::RowMajor> M_tau_;  ///< of a diagonal M_k, since few entries are not zero
  MatrixXd root_;                                       ///< M_k = root root^T; of a diagonal one its diagonal, (n, 1)
  mutable bool is_solved_ = false;                      ///< of these numbers; else of the rim that this was made of
  mutable VectorXd last_c_;
  mutable RimSolution last_;
};

}  // namespace fastjoint::stage3
