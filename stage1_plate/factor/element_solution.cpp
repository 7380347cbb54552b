// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/factor/element_solution.hpp"

namespace fastjoint::stage1 {

int ElementSolution::target(int coefficient) const {
  const auto n_modes = static_cast<int>(problem_.numbering.function.rows());
  const int function = problem_.numbering.function(coefficient % n_modes, element_);
  return problem_.unknowns.target[2 * function + coefficient / n_modes];
}

double ElementSolution::sign(int coefficient) const {
  return problem_.numbering.sign(coefficient % problem_.numbering.sign.rows(), element_);
}

void ElementSolution::eliminate(const Eigen::Ref<const Eigen::MatrixXd>& B) {
  inside_.resize(condensed_.inside.size(), B.cols());
  for (std::size_t i = 0; i < condensed_.inside.size(); ++i)
    inside_.row(i) = sign(condensed_.inside[i]) * B.row(target(condensed_.inside[i]));
  outside_.setZero(condensed_.matrix.n_outside(), B.cols());
  if (inside_.isZero(0)) return;
  condensed_.matrix.eliminate(inside_, outside_);
  inside_ /= problem_.elements.scale[element_];
}

void ElementSolution::add_to(Eigen::MatrixXd& skeleton) const {
  for (std::size_t i = 0; i < condensed_.outside.size(); ++i)
    if (const int to = target(condensed_.outside[i]); Unknowns::is_free(to))
      skeleton.row(rows_.of_target(to)) += sign(condensed_.outside[i]) * outside_.row(i);
}

void ElementSolution::restore(const Eigen::MatrixXd& skeleton, Eigen::Ref<Eigen::MatrixXd> X) {
  outside_.setZero();
  for (std::size_t i = 0; i < condensed_.outside.size(); ++i)
    if (const int to = target(condensed_.outside[i]); Unknowns::is_free(to))
      outside_.row(i) = sign(condensed_.outside[i]) * skeleton.row(rows_.of_target(to));
  condensed_.matrix.restore(inside_, outside_);
  for (std::size_t i = 0; i < condensed_.inside.size(); ++i)
    X.row(target(condensed_.inside[i])) = sign(condensed_.inside[i]) * inside_.row(i);
}

}  // namespace fastjoint::stage1
