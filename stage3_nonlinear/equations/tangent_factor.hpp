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
/// Short waves of pressure around a rim of contact fade before they reach anything but their own rim. The factor leaves
/// out what little their rows take from elsewhere, so that it is one of a small matrix, for the planes and the long
/// waves of all rims, and of one block for the short waves of each rim. Corrections by the residual bring back what was
/// left out: solutions are those of J, to rounding (docs/theory.md, section 6.6).
class TangentFactor {
 public:
  /// @param rims Numbers of moments of the rims, whose unknowns are the last, rim after rim; none leaves out nothing.
  TangentFactor(MatrixXd J, const std::vector<Index>& rims);

  /// Solution x of J x = b, (r, columns).
  [[nodiscard]] MatrixXd solve(const MatrixXd& b) const;
  /// The same as far as a step of Newton's method needs it: to a millionth of b.
  [[nodiscard]] VectorXd step(const VectorXd& b) const;
  /// Solution x of J^T x = b, (r, columns).
  [[nodiscard]] MatrixXd solve_transposed(const MatrixXd& b) const;
  /// Reciprocal condition number of the small matrix, which is singular where J is, as one that is of order 1, and so
  /// singular also if all of it is small.
  [[nodiscard]] double least_stretch() const;
  /// Motions that a singular J does not resist, (r, n), n >= 1.
  /// @param share Of the largest singular value of the small matrix, or of 1 if that is more, up to which one is none.
  [[nodiscard]] MatrixXd free_motions(double share) const;

  /// Solution x of J x = b by least squares, (r, columns), and the motions (r, n) that J does not resist.
  struct Singular {
    MatrixXd x, free;
  };
  [[nodiscard]] Singular solve_singular(const MatrixXd& b, double share) const;
  /// The same of J^T, whose motions are those of J still.
  [[nodiscard]] Singular solve_singular_transposed(const MatrixXd& b, double share) const;
  /// J.
  [[nodiscard]] const MatrixXd& matrix() const { return J_; }
  /// Number of rows of the small matrix.
  [[nodiscard]] Index n_kept() const { return kept_.size(); }

 private:
  /// Short waves of a rim.
  struct ShortWaves {
    Index first_long, first, end;  ///< unknowns of the rim: long waves, then short ones
    matrices::Lu own;              ///< of their block
    MatrixXd by_long;              ///< (short, long) inverse of the block times what they take from long waves
    MatrixXd on_kept;              ///< (kept, short) what the kept rows take from them
  };
  /// Solutions with the factor alone, whose small matrix `solve` solves.
  template <typename Solve>
  [[nodiscard]] MatrixXd by_factor(const MatrixXd& b, const Solve& solve) const;
  template <typename Solve>
  [[nodiscard]] MatrixXd by_factor_transposed(const MatrixXd& b, const Solve& solve) const;

  /// What the small matrix does not resist, and a matrix that is regular there and the same elsewhere.
  struct NullSpace {
    MatrixXd right, left;  ///< (kept, n) orthonormal; motions, and forces that no motion makes
    matrices::Lu lifted;   ///< of the small matrix and left right^T times its norm
  };
  [[nodiscard]] const NullSpace& null_space(double share) const;
  [[nodiscard]] NullSpace find_null_space(double share) const;
  /// Motions of the kept unknowns with those of the short waves that follow them.
  [[nodiscard]] MatrixXd extended(const MatrixXd& kept) const;

  MatrixXd J_;
  double norm_;              ///< of J, the largest sum of amounts in a column
  std::vector<Index> kept_;  ///< planes and long waves
  std::vector<ShortWaves> short_waves_;
  MatrixXd small_;
  matrices::Lu lu_;                                  ///< of small
  mutable std::map<double, NullSpace> null_spaces_;  ///< that were asked for, by share
};

}  // namespace fastjoint::stage3
