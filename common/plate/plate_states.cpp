// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_states.hpp"

namespace fastjoint::plate {

using Eigen::Index;
using Eigen::MatrixXd;

PlateStates::PlateStates(const PlateFactor& factor, const MatrixXd& border, const Eigen::SparseMatrix<double>& loads)
    : factor_(factor), border_(border.transpose()) {
  MatrixXd b = -(factor.coupling_.transpose() * border);
  if (loads.nonZeros() > 0) eliminate(loads, b);
  skeleton_ = factor.factor_->solve(b).transpose();
}

void PlateStates::eliminate(const Eigen::SparseMatrix<double>& loads, MatrixXd& skeleton) {
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_row = loads;
  const auto add = [&](int dof, double factor, auto row) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator at(by_row, dof); at; ++at)
      row[at.col()] += factor * at.value();
  };
  for (int dof = 0; dof < by_row.rows(); ++dof)
    if (const int row = factor_.rows_.of_unknown[dof]; row >= 0) add(dof, 1, skeleton.row(row));
  for (int element = 0; element < count_of(factor_.plate_.elements.class_of); ++element) {
    const CondensedElement& K = factor_.condensed(element);
    const auto dofs = pfem::element_dofs(factor_.plate_.numbering, factor_.plate_.unknowns.dofs, element);
    MatrixXd inside = MatrixXd::Zero(K.matrix.n_inside(), loads.cols());
    for (Index i = 0; i < inside.rows(); ++i) add(dofs.dof[K.inside[i]], dofs.sign[K.inside[i]], inside.row(i));
    if (inside.isZero(0)) continue;
    MatrixXd outside = MatrixXd::Zero(K.matrix.n_outside(), loads.cols());
    K.matrix.eliminate(inside, outside);
    for (std::size_t i = 0; i < K.outside.size(); ++i)
      if (const int dof = dofs.dof[K.outside[i]]; pfem::is_free(dof))
        skeleton.row(factor_.rows_.of_unknown[dof]) += dofs.sign[K.outside[i]] * outside.row(i);
    inside_[element] = inside / factor_.plate_.elements.scale[element];
  }
}

MatrixXd PlateStates::outside(int element) const {
  const PlateStiffness& plate = factor_.plate_;
  const CondensedElement& K = factor_.condensed(element);
  const auto dofs = pfem::element_dofs(plate.numbering, plate.unknowns.dofs, element);
  MatrixXd u = MatrixXd::Zero(size(), K.matrix.n_outside());
  Index column = 0;
  for (const int i : K.outside) {
    const int dof = dofs.dof[i];
    if (pfem::is_free(dof)) u.col(column) = dofs.sign[i] * skeleton_.col(factor_.rows_.of_unknown[dof]);
    if (pfem::is_controlled(dof)) u.col(column) = dofs.sign[i] * border_.col(pfem::controlled_index(dof));
    ++column;
  }
  for (const int i : plate.unknowns.border_of(plate.elements.holes[element])) u.col(column++) = border_.col(i);
  return u;
}

MatrixXd PlateStates::coefficients(int element) const {
  const CondensedElement& K = factor_.condensed(element);
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
  const CondensedElement& K = factor.condensed(element);
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
