// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "common/matrices/decompositions.hpp"
#include "stage3_nonlinear/equations/condensed_system.hpp"
#include "stage3_nonlinear/equations/contact.hpp"

namespace fastjoint::stage3 {

/// Reciprocal condition, with columns scaled, below which a tangent is singular.
inline constexpr double singular_tangent = 1e-10;

/// Derivative J of the residual by the contact coordinates c at a state, (r, r), dimensionless:
///   J = dF/dc + S_ud d delta/dc + H dLambda/dc.
[[nodiscard]] MatrixXd tangent(const CondensedSystem& system, const ContactState& state);

/// Factor of the tangent J of a joint.
///
/// Short waves of pressure around a rim of contact decay quickly and are nearly uncoupled from all but their own rim.
/// The factor neglects the small entries of their rows outside the rim: it eliminates one block for the short waves of
/// each rim, and factorises the Schur complement, for the planes and the long waves of all rims. J itself is not
/// formed: iterative refinement applies it and gives the solutions with J, to rounding (docs/theory.md, section 6.6).
class TangentFactor {
 public:
  /// @param system Outlives this.
  TangentFactor(const CondensedSystem& system, ContactState state);

  /// Solution x of J x = b, (r, columns), to 1e-12 of b or to rounding.
  [[nodiscard]] MatrixXd solve(const MatrixXd& b) const;
  /// The same to a fraction of b, or as nearly as refinement comes, for a step of Newton's method.
  [[nodiscard]] VectorXd step(const VectorXd& b, double wanted) const;
  /// Solution x of J^T x = b, (r, columns), to about a tenth of b where waves are eliminated rim by rim, for estimates;
  /// by least squares if J is singular.
  [[nodiscard]] MatrixXd estimate_transposed(const MatrixXd& b) const;
  /// True if the reciprocal condition number of the Schur complement, which is singular if J is, is below
  /// singular_tangent; times its norm if that is below 1, since J is of order 1 and a small one counts as singular.
  [[nodiscard]] bool is_singular() const { return is_singular_; }
  /// True if an odd number of eigenvalues of J are real and below 0, by the determinant of the factor; eigenvalues of
  /// the null space do not count.
  [[nodiscard]] bool is_negative() const;
  /// Null space of a singular J, (r, n), n >= 1.
  [[nodiscard]] MatrixXd free_motions() const { return unscaled(extended(null_space().right)); }
  /// Least-squares solution x of J x = b for a singular J, (r, columns).
  [[nodiscard]] MatrixXd solve_singular(const MatrixXd& b) const;
  /// J x, (r, columns).
  [[nodiscard]] MatrixXd times(const MatrixXd& x) const { return product(scale_.asDiagonal() * x); }
  /// Number of rows of the Schur complement.
  [[nodiscard]] Index n_kept() const { return kept_.size(); }

 private:
  /// Short waves of a rim.
  struct ShortWaves {
    Index first_long, first, end;  ///< unknowns of the rim: long waves, then short ones
    matrices::Lu block;            ///< of their diagonal block
    MatrixXd by_long;              ///< (short, long) inverse of the block times their coupling to the long waves
    MatrixXd on_kept;              ///< (kept, short) coupling of the kept rows to them
  };
  /// Solves with the Schur complement, or with its transpose.
  using Solve = std::function<MatrixXd(const MatrixXd&)>;
  [[nodiscard]] Solve by_lu() const {
    return [this](const MatrixXd& f) { return lu_.solve(f); };
  }
  /// Solutions with the factor only, without refinement.
  [[nodiscard]] MatrixXd by_factor(const MatrixXd& b, const Solve& solve) const;
  [[nodiscard]] MatrixXd by_factor_transposed(const MatrixXd& b, const Solve& solve) const;
  /// The same, refined until the residual is rounding or does not fall any more.
  /// @param wanted Residual over b. @param enough The same, above which a factor of the whole J is used, if given.
  [[nodiscard]] MatrixXd refined(const MatrixXd& b, const Solve& by_schur, double wanted,
                                 std::optional<double> enough) const;

  /// Null spaces of the Schur complement, and a regular matrix that equals it on the complement of them. Singular
  /// values up to singular_tangent times the largest, or times 1 if that is more, count as zero.
  struct NullSpace {
    MatrixXd right, left;  ///< (kept, n) orthonormal; null spaces of the matrix and of its transpose
    matrices::Lu lifted;   ///< of the matrix plus left right^T times its norm
  };
  [[nodiscard]] const NullSpace& null_space() const;
  /// Motions of all unknowns, the short waves included, by those of the kept unknowns.
  [[nodiscard]] MatrixXd extended(const MatrixXd& kept) const;

  /// Product of J with its columns divided by scale_ and x, (r, columns).
  [[nodiscard]] MatrixXd product(const MatrixXd& x) const;
  [[nodiscard]] MatrixXd unscaled(const MatrixXd& x) const { return scale_.cwiseInverse().asDiagonal() * x; }

  const CondensedSystem& system_;
  ContactState state_;       ///< with derivatives divided by scale_
  VectorXd scale_;           ///< (r) >= 1, divisors of the columns of J, whose entries are then of order 1 or less
  std::vector<Index> kept_;  ///< planes and long waves
  std::vector<ShortWaves> short_waves_;
  MatrixXd schur_;
  matrices::Lu lu_;  ///< of schur_
  bool is_singular_;
  mutable std::optional<NullSpace> null_space_;  ///< if it has been found
};

}  // namespace fastjoint::stage3
