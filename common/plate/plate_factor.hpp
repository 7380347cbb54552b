// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/linalg/cholesky.hpp"
#include "common/linalg/condensed.hpp"
#include "common/plate/skeleton.hpp"

namespace fastjoint::plate {

/// Linear functions of an element's coefficients, by what is left of them when the element is condensed: weights of
/// what it shares with others and of its border, and of the loads inside it. They are condensed as loads are, since the
/// stiffness is symmetric.
struct CondensedFunctions {
  int element;
  Eigen::MatrixXd inside, outside;  ///< (n_inside, r), (n_outside, r)
};

/// A class of elements at one degree, condensed onto the functions that it shares and onto its border: by hole the
/// discs, the waves, the friction cases. The border's rows are those of a bordered stiffness
/// [K_ff K_fc -P -L; . K_cc H^T -L_c; . . 0 0], in which a wave or friction case has an amplitude as a disc has a
/// displacement.
struct CondensedElement {
  std::vector<int> inside, outside;  ///< degrees of freedom of the element: mode, or n_modes + mode for u_y
  Eigen::Index n_border;
  linalg::Condensed matrix;
};

/// @param K Stiffness of the congruence class at the highest degree and unit thickness, (2 n_modes, 2 n_modes).
[[nodiscard]] CondensedElement condense(const ElementClass& elements, const Eigen::MatrixXd& K,
                                        const pfem::Numbering& numbering, int p);

/// Bytes that a factor takes, known before anything is integrated.
struct FactorBytes {
  double elements;     ///< matrices of the congruence classes at the highest degree, which all factors share
  double condensed;    ///< condensed ones at the factor's degree
  double factor;       ///< the skeleton's stiffness and its factor
  double elimination;  ///< of the border's rows, while it lasts (PlateFactor::condensed)

  [[nodiscard]] double total() const { return elements + condensed + factor; }
};
[[nodiscard]] FactorBytes factor_bytes(const PlateStiffness& plate, const Skeleton& skeleton, int p);

/// The plate's stiffness at one degree, factorised with all controlled displacements held: elements are condensed onto
/// their skeletons, each class once; what is left of all is one sparse system. It is bordered by the controlled
/// displacements, the waves and the friction cases, which are eliminated with it (condensed) or given (PlateStates).
class PlateFactor {
 public:
  /// @param plate Must outlive this.
  /// @param with_other_waves Also carries the waves that nothing loads, which are the last of the border.
  /// Throws NumericalError if the plate, with all controlled displacements held, is not stiff in every direction.
  PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p, bool with_other_waves);

  /// Functions of the plate's displacements, each a sum of condensed ones (PlateStates::condense).
  using Functions = std::vector<std::vector<CondensedFunctions>>;
  /// Values by unit of each of the n_amounts columns of the border: forces that must act on the controlled
  /// displacements, then the integrals over the rims of the disc's displacement relative to the sheet, each times the
  /// distribution of a wave, as products in energy of the unit fields, which makes them superconvergent
  /// (docs/theory.md, section 4.4); then those of `functions`. Shape (n_border + functions, n_amounts); the rows of
  /// friction cases mean nothing. S is zero where rounding is all that is left of its terms, as in a sheet held by one
  /// disc alone.
  [[nodiscard]] Eigen::MatrixXd condensed(const Functions& functions = {}) const;
  /// Stiffness of each controlled displacement with all of the plate held, shape (nc): the diagonal of K_cc.
  [[nodiscard]] const Eigen::VectorXd& held_stiffness() const { return held_; }

 private:
  friend class PlateStates;
  [[nodiscard]] const CondensedElement& element(int element) const;
  /// Stiffness of the skeleton and its border, lower triangle.
  [[nodiscard]] Eigen::SparseMatrix<double> bordered_stiffness(const Skeleton& skeleton);

  const PlateStiffness& plate_;
  std::vector<CondensedElement> classes_;
  Skeleton::Rows rows_;
  Eigen::VectorXd held_;
  Eigen::VectorXd diagonal_;              ///< of the skeleton's stiffness
  Eigen::SparseMatrix<double> coupling_;  ///< (n_border, skeleton) between border and skeleton
  Eigen::SparseMatrix<double> border_;    ///< (n_border, n_border) of the border with the skeleton held
  std::unique_ptr<linalg::Cholesky> factor_;
};

}  // namespace fastjoint::plate
