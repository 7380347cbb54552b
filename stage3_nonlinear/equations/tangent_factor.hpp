// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Factor of the tangent J of a joint, (r, r).
///
/// Short waves of pressure around a rim of contact decay quickly and are nearly uncoupled from all but their own rim.
/// The factor neglects the small entries of their rows outside the rim: it eliminates one block for the short waves of
/// each rim, and factorises the Schur complement, for the planes and the long waves of all rims. Iterative refinement
/// then gives the solutions with J, to rounding (docs/theory.md, section 6.6).
class TangentFactor {
 public:
  /// @param rims Numbers of moments of the rims, whose unknowns are the last, rim after rim; if empty, J is factorised.
  TangentFactor(MatrixXd J, const std::vector<Index>& rims);

  /// Solution x of J x = b, (r, columns).
  [[nodiscard]] MatrixXd solve(const MatrixXd& b) const;
  /// The same to a millionth of b, which is enough for a step of Newton's method.
  [[nodiscard]] VectorXd step(const VectorXd& b) const;
  /// Solution x of J^T x = b, (r, columns).
  [[nodiscard]] MatrixXd solve_transposed(const MatrixXd& b) const;
  /// Reciprocal condition number of the Schur complement, which is singular if J is; times its norm if that is below 1,
  /// since J is of order 1 and a small one counts as singular.
  [[nodiscard]] double rcond() const;
  /// Null space of a singular J, (r, n), n >= 1.
  /// @param tolerance Singular values up to this count as zero, relative to the largest of the Schur complement or to 1
  /// if that is more.
  [[nodiscard]] MatrixXd free_motions(double tolerance) const;

  /// Least-squares solution x of J x = b, (r, columns), and the null space of J, (r, n).
  struct Singular {
    MatrixXd x, free;
  };
  [[nodiscard]] Singular solve_singular(const MatrixXd& b, double tolerance) const;
  /// The same for J^T x = b; `free` is the null space of J here too.
  [[nodiscard]] Singular solve_singular_transposed(const MatrixXd& b, double tolerance) const;
  /// J.
  [[nodiscard]] const MatrixXd& matrix() const { return J_; }
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
  /// Solutions with the factor only, without refinement; `solve` solves with the Schur complement.
  template <typename Solve>
  [[nodiscard]] MatrixXd by_factor(const MatrixXd& b, const Solve& solve) const;
  template <typename Solve>
  [[nodiscard]] MatrixXd by_factor_transposed(const MatrixXd& b, const Solve& solve) const;

  /// Null spaces of the Schur complement, and a regular matrix that equals it on the complement of them.
  struct NullSpace {
    MatrixXd right, left;  ///< (kept, n) orthonormal; null spaces of the matrix and of its transpose
    matrices::Lu lifted;   ///< of the matrix plus left right^T times its norm
  };
  [[nodiscard]] const NullSpace& null_space(double tolerance) const;
  [[nodiscard]] NullSpace find_null_space(double tolerance) const;
  /// Motions of all unknowns, the short waves included, by those of the kept unknowns.
  [[nodiscard]] MatrixXd extended(const MatrixXd& kept) const;

  MatrixXd J_;
  double norm_;              ///< 1-norm of J
  std::vector<Index> kept_;  ///< planes and long waves
  std::vector<ShortWaves> short_waves_;
  MatrixXd schur_;
  matrices::Lu lu_;                                  ///< of schur_
  mutable std::map<double, NullSpace> null_spaces_;  ///< found so far, by tolerance
};

}  // namespace fastjoint::stage3
