// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/linalg/cholesky.hpp"
#include "common/linalg/condensed.hpp"
#include "common/plate/skeleton.hpp"

namespace fastjoint::plate {

/// A class of elements at one degree, condensed onto the functions that it shares and onto its border: by hole the
/// discs, then the friction cases. The border's rows are those of a bordered stiffness [K_ff K_fc -L; . K_cc -L_c], in
/// which a friction case has an amplitude as a disc has a displacement.
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
  double elements;  ///< matrices of the congruence classes at the highest degree, condensed ones at the factor's
  double factor;    ///< the skeleton's stiffness and its factor
};
[[nodiscard]] FactorBytes factor_bytes(const PlateStiffness& plate, const Skeleton& skeleton, int p, bool bordered);

/// The plate's stiffness at one degree, factorised: elements are condensed onto their skeletons, each class once; what
/// is left of all is one sparse system, bordered by the controlled displacements and the friction cases.
class PlateFactor {
 public:
  /// Factorises without the border, for solving alone.
  /// @param plate Must outlive this.
  /// Throws NumericalError if the plate, with all controlled displacements held, is not stiff in every direction.
  PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p);
  /// Factorises with the border.
  /// @param diagonal What the border has on its diagonal beside the stiffness of discs and ties, (nc + h).
  PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p, const Eigen::VectorXd& diagonal);

  /// Rows of the factor in the border, shape (nc + h, nc): E_c of the controlled displacements, then E_h of the
  /// friction cases. With the artificial stiffness s, S = E_c E_c^T - diag(s) and R = E_c E_h^T (docs/theory.md,
  /// section 4.4). Of a factor with a border only.
  [[nodiscard]] Eigen::MatrixXd energy_rows() const;
  /// Plate unknowns under loads on them, controlled displacements held, shape (n_p, k).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

  /// Change of the energy of a field u that rounding of the plate's stiffness may make: times the machine's precision,
  /// the sum of the squares of its unknowns on skeletons, each with its diagonal entry.
  [[nodiscard]] double rounding(const Eigen::VectorXd& u) const;

 private:
  friend class PlateStates;
  PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p, const Eigen::VectorXd* diagonal);
  [[nodiscard]] const CondensedElement& condensed(int element) const;
  [[nodiscard]] Eigen::SparseMatrix<double> skeleton_stiffness(const Skeleton& skeleton) const;

  const PlateStiffness& plate_;
  std::vector<CondensedElement> classes_;
  Skeleton::Rows rows_;
  Eigen::VectorXd diagonal_;
  Eigen::SparseMatrix<double> coupling_;  ///< (nc + h, skeleton) of a factor without a border: its rows
  std::unique_ptr<linalg::Cholesky> factor_;
};

}  // namespace fastjoint::plate
