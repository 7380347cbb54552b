// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_states.hpp"

#include <limits>
#include <tuple>

namespace fastjoint::plate {

using Eigen::Index;
using Eigen::MatrixXd;

PlateStates::PlateStates(const PlateFactor& factor, const MatrixXd& border, const Eigen::SparseMatrix<double>& loads)
    : factor_(factor), border_(border.transpose()) {
  const Eigen::SparseMatrix<double> amounts = border.sparseView();
  MatrixXd b = -(factor.coupling_.transpose() * amounts);
  if (loads.nonZeros() > 0) {
    eliminate(loads);
    b += skeleton_loads_;
  }
  skeleton_ = factor.factor_->solve(std::move(b)).transpose();
}

void PlateStates::eliminate(const Eigen::SparseMatrix<double>& loads) {
  const auto& [unknowns, numbering] = std::tie(factor_.plate_.unknowns, factor_.plate_.numbering);
  skeleton_loads_ = MatrixXd::Zero(factor_.rows_.n_skeleton, loads.cols());
  border_loads_ = MatrixXd::Zero(border_.cols(), loads.cols());
  const Eigen::SparseMatrix<double, Eigen::RowMajor> by_row = loads;
  const auto add = [&](int dof, double factor, auto row) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator at(by_row, dof); at; ++at)
      row[at.col()] += factor * at.value();
  };
  for (int dof = 0; dof < by_row.rows(); ++dof)
    if (const int row = factor_.rows_.of_unknown[dof]; row >= 0) add(dof, 1, skeleton_loads_.row(row));
  for (int element = 0; element < count_of(factor_.plate_.elements.class_of); ++element) {
    const CondensedElement& K = factor_.element(element);
    const auto dofs = pfem::element_dofs(numbering, unknowns.dofs, element);
    MatrixXd inside = MatrixXd::Zero(K.matrix.n_inside(), loads.cols());
    for (Index i = 0; i < inside.rows(); ++i) add(dofs.dof[K.inside[i]], dofs.sign[K.inside[i]], inside.row(i));
    if (inside.isZero(0)) continue;
    MatrixXd outside = MatrixXd::Zero(K.matrix.n_outside(), loads.cols());
    K.matrix.eliminate(inside, outside);
    Index row = 0;
    for (const int i : K.outside) {
      const auto load = dofs.sign[i] * outside.row(row++);
      if (pfem::is_free(dofs.dof[i])) skeleton_loads_.row(factor_.rows_.of_unknown[dofs.dof[i]]) += load;
      if (pfem::is_controlled(dofs.dof[i])) border_loads_.row(pfem::controlled_index(dofs.dof[i])) += load;
    }
    for (const int i : unknowns.border_of(factor_.plate_.elements.holes[element]))
      border_loads_.row(i) += outside.row(row++);
    inside_[element] = inside / factor_.plate_.elements.scale[element];
  }
}

MatrixXd PlateStates::forces() const {
  const auto nc = factor_.border_.rows();
  MatrixXd forces = factor_.border_ * border_.transpose();
  forces += factor_.coupling_.topRows(nc) * skeleton_.transpose();
  if (border_loads_.size() > 0) forces -= border_loads_.topRows(nc);
  return forces;
}

MatrixXd PlateStates::work() const {
  if (skeleton_loads_.size() == 0) return MatrixXd::Zero(size(), size());
  MatrixXd work = (skeleton_ * skeleton_loads_ + border_ * border_loads_).transpose();
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
  for (const int i : plate.unknowns.border_of(plate.elements.holes[element])) u.col(column++) = border_.col(i);
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
