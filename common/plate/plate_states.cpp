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
  const Eigen::SparseMatrix<double> amounts = border_.sparseView();
  MatrixXd b = -(amounts * factor.coupling_);
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
    MatrixXd inside = MatrixXd::Zero(K.matrix.n_inside(), loads.cols());
    for (Index i = 0; i < inside.rows(); ++i)
      inside.row(i) = dofs.sign[K.inside[i]] * MatrixXd(by_dof.col(dofs.dof[K.inside[i]])).transpose();
    if (inside.isZero(0)) continue;
    MatrixXd outside = MatrixXd::Zero(K.matrix.n_outside(), loads.cols());
    K.matrix.eliminate(inside, outside);
    Index row = 0;
    for (const int i : K.outside) {
      const auto load = dofs.sign[i] * outside.row(row++).transpose();
      if (pfem::is_free(dofs.dof[i])) skeleton_loads_.col(factor_.rows_.of_unknown[dofs.dof[i]]) += load;
      if (pfem::is_controlled(dofs.dof[i])) border_loads_.col(pfem::controlled_index(dofs.dof[i])) += load;
    }
    for (const int i : unknowns.border_of(factor_.plate_.elements.holes[element])) {
      if (i < border_loads_.cols()) border_loads_.col(i) += outside.row(row).transpose();
      ++row;
    }
    inside_[element] = inside / factor_.plate_.elements.scale[element];
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
  for (const auto& [element, y] : inside_) work += factor_.plate_.elements.scale[element] * (y.transpose() * y);
  return work;
}

Eigen::VectorXd PlateStates::rounding() const {
  return std::numeric_limits<double>::epsilon() * (skeleton_.cwiseAbs2() * factor_.diagonal_);
}

MatrixXd PlateStates::outside(int element) const {
  const PlateStiffness& plate = factor_.plate_;
  const CondensedElement& K = factor_.element(element);
  const auto dofs = pfem::element_dofs(plate.numbering, plate.unknowns.dofs, element);
  MatrixXd u = MatrixXd::Zero(size(), K.matrix.n_outside());
  Index column = 0;
  for (const int i : K.outside) {
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
  const MatrixXd outside = this->outside(element).transpose();
  const auto loaded = inside_.find(element);
  MatrixXd inside = loaded != inside_.end() ? loaded->second : MatrixXd::Zero(K.matrix.n_inside(), size());
  K.matrix.restore(inside, outside);
  MatrixXd C = MatrixXd::Zero(2 * factor_.plate_.numbering.function.rows(), size());
  C(K.inside, Eigen::all) = inside;
  C(K.outside, Eigen::all) = outside.topRows(K.outside.size());
  return C;
}

CondensedFunctions PlateStates::condense(const PlateFactor& factor, int element, const MatrixXd& weights) {
  const CondensedElement& K = factor.element(element);
  CondensedFunctions result{element, weights(K.inside, Eigen::all),
                            MatrixXd::Zero(K.matrix.n_outside(), weights.cols())};
  result.outside.topRows(K.outside.size()) = weights(K.outside, Eigen::all);
  K.matrix.eliminate(result.inside, result.outside);
  return result;
}

MatrixXd PlateStates::values(const CondensedFunctions& functions) const {
  MatrixXd values = outside(functions.element) * functions.outside;
  if (const auto loaded = inside_.find(functions.element); loaded != inside_.end())
    values += loaded->second.transpose() * functions.inside;
  return values;
}

}  // namespace fastjoint::plate
