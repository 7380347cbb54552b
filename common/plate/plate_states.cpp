// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_states.hpp"

#include <limits>
#include <tuple>

namespace fastjoint::plate {

using Eigen::Index;
using Eigen::MatrixXd;

PlateStates::PlateStates(const PlateFactor& factor, const MatrixXd& border, const Eigen::SparseMatrix<double>& loads)
    : factor_(factor), border_(MatrixXd::Zero(border.cols(), factor.rows_.n_border)) {
  border_.leftCols(border.rows()) = border.transpose();
  const Eigen::SparseMatrix<double> prescribed = border_.sparseView();
  MatrixXd b = -(prescribed * factor.coupling_);
  if (loads.nonZeros() > 0) {
    eliminate(loads);
    b += skeleton_loads_;
  }
  skeleton_ = factor.factor_->solve(std::move(b));
}

void PlateStates::eliminate(const Eigen::SparseMatrix<double>& loads) {
  const auto& [unknowns, numbering] = std::tie(factor_.plate_.unknowns, factor_.plate_.numbering);
  skeleton_loads_ = MatrixXd::Zero(loads.cols(), factor_.rows_.n_skeleton);
  border_loads_ = MatrixXd::Zero(loads.cols(), border_.cols());
  const Eigen::SparseMatrix<double> by_dof = loads.transpose();
  for (int dof = 0; dof < by_dof.cols(); ++dof)
    if (const int row = factor_.rows_.of_unknown[dof]; row >= 0) skeleton_loads_.col(row) += by_dof.col(dof);
  for (int element = 0; element < count_of(factor_.plate_.elements.class_of); ++element) {
    const CondensedElement& K = factor_.element(element);
    const auto dofs = pfem::element_dofs(numbering, unknowns.dofs, element);
    MatrixXd interior = MatrixXd::Zero(K.matrix.n_interior(), loads.cols());
    for (Index i = 0; i < interior.rows(); ++i)
      interior.row(i) = dofs.sign[K.interior[i]] * MatrixXd(by_dof.col(dofs.dof[K.interior[i]])).transpose();
    if (interior.isZero(0)) continue;
    MatrixXd boundary = MatrixXd::Zero(K.matrix.n_boundary(), loads.cols());
    K.matrix.eliminate(interior, boundary);
    Index row = 0;
    for (const int i : K.boundary) {
      const auto load = dofs.sign[i] * boundary.row(row++).transpose();
      if (pfem::is_free(dofs.dof[i])) skeleton_loads_.col(factor_.rows_.of_unknown[dofs.dof[i]]) += load;
      if (pfem::is_controlled(dofs.dof[i])) border_loads_.col(pfem::controlled_index(dofs.dof[i])) += load;
    }
    for (const int i : unknowns.border_of(factor_.plate_.elements.holes[element])) {
      if (i < border_loads_.cols()) border_loads_.col(i) += boundary.row(row).transpose();
      ++row;
    }
    interior_[element] = interior / factor_.plate_.elements.scale[element];
  }
}

MatrixXd PlateStates::forces() const {
  MatrixXd forces = factor_.border_ * border_.transpose();
  forces += factor_.coupling_ * skeleton_.transpose();
  if (border_loads_.size() > 0) forces -= border_loads_.transpose();
  return forces;
}

MatrixXd PlateStates::work() const {
  if (skeleton_loads_.size() == 0) return MatrixXd::Zero(size(), size());
  MatrixXd work = skeleton_loads_ * skeleton_.transpose() + border_loads_ * border_.transpose();
  for (const auto& [element, y] : interior_) work += factor_.plate_.elements.scale[element] * (y.transpose() * y);
  return work;
}

Eigen::VectorXd PlateStates::rounding() const {
  const Eigen::VectorXd& K_cc = factor_.diagonal_of_K_cc_;
  return std::numeric_limits<double>::epsilon() *
         (skeleton_.cwiseAbs2() * factor_.diagonal_ + border_.leftCols(K_cc.size()).cwiseAbs2() * K_cc);
}

MatrixXd PlateStates::boundary_coefficients(int element) const {
  const PlateStiffness& plate = factor_.plate_;
  const CondensedElement& K = factor_.element(element);
  const auto dofs = pfem::element_dofs(plate.numbering, plate.unknowns.dofs, element);
  MatrixXd u = MatrixXd::Zero(size(), K.matrix.n_boundary());
  Index column = 0;
  for (const int i : K.boundary) {
    const int dof = dofs.dof[i];
    if (pfem::is_free(dof)) u.col(column) = dofs.sign[i] * skeleton_.col(factor_.rows_.of_unknown[dof]);
    if (pfem::is_controlled(dof)) u.col(column) = dofs.sign[i] * border_.col(pfem::controlled_index(dof));
    ++column;
  }
  for (const int i : plate.unknowns.border_of(plate.elements.holes[element])) {
    if (i < border_.cols()) u.col(column) = border_.col(i);
    ++column;
  }
  return u;
}

MatrixXd PlateStates::coefficients(int element) const {
  const CondensedElement& K = factor_.element(element);
  const MatrixXd boundary = boundary_coefficients(element).transpose();
  const auto loaded = interior_.find(element);
  MatrixXd interior = loaded != interior_.end() ? loaded->second : MatrixXd::Zero(K.matrix.n_interior(), size());
  K.matrix.restore(interior, boundary);
  MatrixXd C = MatrixXd::Zero(2 * factor_.plate_.numbering.function.rows(), size());
  C(K.interior, Eigen::all) = interior;
  C(K.boundary, Eigen::all) = boundary.topRows(K.boundary.size());
  return C;
}

CondensedFunctions PlateStates::condense(const PlateFactor& factor, int element, const MatrixXd& weights) {
  const CondensedElement& K = factor.element(element);
  CondensedFunctions result{element, weights(K.interior, Eigen::all),
                            MatrixXd::Zero(K.matrix.n_boundary(), weights.cols())};
  result.boundary.topRows(K.boundary.size()) = weights(K.boundary, Eigen::all);
  K.matrix.eliminate(result.interior, result.boundary);
  return result;
}

MatrixXd PlateStates::values(const CondensedFunctions& functions) const {
  MatrixXd values = boundary_coefficients(functions.element) * functions.boundary;
  if (const auto loaded = interior_.find(functions.element); loaded != interior_.end())
    values += loaded->second.transpose() * functions.interior;
  return values;
}

}  // namespace fastjoint::plate
