// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "common/linalg/cholesky.hpp"
#include "common/linalg/condensed.hpp"
#include "stage1_plate/factor/skeleton.hpp"

namespace fastjoint::stage1 {

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

/// The plate's stiffness at one degree, factorised: elements are condensed onto their skeletons, each class once; what
/// is left of all is one sparse system, bordered by the controlled displacements and the friction cases. The problem
/// must outlive this.
class PlateFactor {
 public:
  /// Throws NumericalError if the plate, with all controlled displacements held, is not stiff in every direction.
  PlateFactor(const PlateProblem& problem, const Skeleton& skeleton, int p);

  /// Rows of the factor in the border, shape (nc + h, nc): E_c of the controlled displacements, then E_h of the
  /// friction cases. With s = shift(problem), S = E_c E_c^T - diag(s) and R = E_c E_h^T (docs/theory.md, section 4.4).
  [[nodiscard]] Eigen::MatrixXd energy_rows() const;
  /// Plate unknowns under loads on them, controlled displacements held, shape (n_p, k).
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const;

  /// Change of the energy of a field u that rounding of the plate's stiffness may make: times the machine's precision,
  /// the sum of the squares of its unknowns on skeletons, each with its diagonal entry.
  [[nodiscard]] double rounding(const Eigen::VectorXd& u) const;

 private:
  [[nodiscard]] const CondensedElement& condensed(int element) const;
  [[nodiscard]] Eigen::SparseMatrix<double> skeleton_stiffness(const Skeleton& skeleton) const;

  const PlateProblem& problem_;
  std::vector<CondensedElement> classes_;
  Skeleton::Rows rows_;
  Eigen::VectorXd diagonal_;
  std::unique_ptr<linalg::Cholesky> factor_;
};

/// Artificial stiffness of each controlled displacement, shape (nc), force / length: as much as its diagonal entry of
/// K_cc. It keeps the factor of a floating sheet regular and is subtracted from S again (docs/theory.md, section 4.5).
[[nodiscard]] Eigen::VectorXd shift(const PlateProblem& problem);

}  // namespace fastjoint::stage1
