// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/linalg/cholesky.hpp"
#include "common/linalg/condensed.hpp"
#include "common/plate/skeleton.hpp"

namespace fastjoint::plate {

/// Linear functions of an element's coefficients after static condensation: weights of its boundary unknowns and
/// border, and of the loads on its interior. They are condensed as loads are, since the stiffness is symmetric.
struct CondensedFunctions {
  int element;
  Eigen::MatrixXd interior, boundary;  ///< (n_interior, r), (n_boundary, r)
};

/// A class of elements at one degree, condensed onto its boundary unknowns (functions shared with other elements) and
/// onto its border: discs, waves and friction cases of each hole. The border's rows are those of a bordered stiffness
/// [K_ff K_fc -P -L; . K_cc H^T -L_c; . . 0 0], in which a wave or friction case has an amplitude as a disc has a
/// displacement.
struct CondensedElement {
  std::vector<int> interior, boundary;  ///< degrees of freedom of the element: mode for u_x, n_modes + mode for u_y
  Eigen::Index n_border;
  linalg::Condensed matrix;
};

/// @param K Stiffness of the congruence class at the highest degree and unit thickness, (2 n_modes, 2 n_modes).
[[nodiscard]] CondensedElement condense(const ElementClass& elements, const Eigen::MatrixXd& K,
                                        const pfem::Numbering& numbering, int p);

/// Memory of a factor in bytes, known before integration.
struct FactorBytes {
  double elements;     ///< matrices of the congruence classes at the highest degree, shared by all factors
  double condensed;    ///< condensed element matrices at the factor's degree
  double factor;       ///< the skeleton's stiffness and its factor
  double elimination;  ///< temporary memory while border rows are eliminated (PlateFactor::condensed)

  [[nodiscard]] double total() const { return elements + condensed + factor; }
};
[[nodiscard]] FactorBytes factor_bytes(const PlateStiffness& plate, const Skeleton& skeleton, int p);

/// The plate's stiffness at one degree, factorised with all controlled displacements fixed. Each class of elements is
/// condensed once onto its skeleton; the Schur complements are assembled to one sparse system. It is bordered by the
/// controlled displacements, the waves and the friction cases, whose amplitudes are unit ones (condensed) or given
/// (PlateStates).
class PlateFactor {
 public:
  /// @param plate Must outlive this.
  /// @param with_other_waves Includes the waves without tractions, which come last in the border.
  /// Throws NumericalError if the stiffness with all controlled displacements fixed is not positive definite.
  PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p, bool with_other_waves);

  /// Functions of the plate's displacements, each a sum of condensed ones.
  using Functions = std::vector<std::vector<CondensedFunctions>>;
  /// Condenses functions of an element's coefficients.
  /// @param weights Weight of each coefficient of all modes of the element, shape (2 n_modes, r).
  [[nodiscard]] CondensedFunctions condense_functions(int element, const Eigen::MatrixXd& weights) const;
  /// Schur complement of the border: values per unit of each of the n_prescribed columns. Rows: forces on the
  /// controlled displacements, then integrals over the rims of the disc's displacement relative to the sheet times the
  /// distribution of each wave, then `functions`. They are energy products of the unit fields, and so superconvergent
  /// (docs/theory.md, section 4.4). Shape (n_border + functions, n_prescribed); rows of friction cases have no meaning.
  /// S is set to zero if it is rounding only, as in a sheet that one disc alone supports.
  [[nodiscard]] Eigen::MatrixXd condensed(const Functions& functions = {}) const;
  /// Diagonal of K_cc, shape (nc): stiffness of each controlled displacement with all plate unknowns fixed.
  [[nodiscard]] const Eigen::VectorXd& diagonal_of_K_cc() const { return diagonal_of_K_cc_; }

 private:
  friend class PlateStates;
  /// Rows of the bordered stiffness for the boundary unknowns of an element and then its border, -1 for those that it
  /// does not have, and the sign of each.
  struct ElementRows {
    std::vector<int> row;
    Eigen::VectorXd sign;
  };
  [[nodiscard]] ElementRows rows_of(int element) const;
  [[nodiscard]] const CondensedElement& element(int element) const;
  /// Stiffness of the skeleton and its border, lower triangle.
  [[nodiscard]] Eigen::SparseMatrix<double> bordered_stiffness(const Skeleton& skeleton);

  const PlateStiffness& plate_;
  std::vector<CondensedElement> classes_;
  Skeleton::Rows rows_;
  Eigen::VectorXd diagonal_of_K_cc_;
  Eigen::VectorXd diagonal_;              ///< diagonal of the skeleton's stiffness
  Eigen::SparseMatrix<double> coupling_;  ///< (n_border, skeleton) block between border and skeleton
  Eigen::SparseMatrix<double> border_;    ///< (n_border, n_border) block of the border itself
  std::unique_ptr<linalg::Cholesky> factor_;
};

}  // namespace fastjoint::plate
