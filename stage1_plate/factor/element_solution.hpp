// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "stage1_plate/factor/condensed_element.hpp"
#include "stage1_plate/factor/skeleton.hpp"

namespace fastjoint::stage1 {

/// Coefficients of one element while the plate is solved: loads inside it are eliminated before the skeleton is solved,
/// displacements inside it follow from those of the skeleton.
class ElementSolution {
 public:
  /// All must outlive this.
  ElementSolution(const PlateProblem& problem, int element, const CondensedElement& condensed,
                  const Skeleton::Rows& rows)
      : problem_(problem), element_(element), condensed_(condensed), rows_(rows) {}

  /// @param B Loads on the plate's unknowns, (n_p, k).
  void eliminate(const Eigen::Ref<const Eigen::MatrixXd>& B);
  /// Adds what they do to the loads on the skeleton.
  void add_to(Eigen::MatrixXd& skeleton) const;
  /// @param skeleton Displacements of the skeleton. @param X (n_p, k) gets those inside the element.
  void restore(const Eigen::MatrixXd& skeleton, Eigen::Ref<Eigen::MatrixXd> X);

 private:
  [[nodiscard]] int target(int coefficient) const;
  [[nodiscard]] double sign(int coefficient) const;

  const PlateProblem& problem_;
  int element_;
  const CondensedElement& condensed_;
  const Skeleton::Rows& rows_;
  Eigen::MatrixXd inside_, outside_;  ///< between eliminate and restore
};

}  // namespace fastjoint::stage1
