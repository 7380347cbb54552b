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
    const auto [row, sign] = factor_.rows_of(element);
    for (int k = 0; k < count_of(row); ++k) {
      const auto load = sign[k] * boundary.row(k).transpose();
      if (row[k] >= factor_.rows_.n_skeleton)
        border_loads_.col(row[k] - factor_.rows_.n_skeleton) += load;
      else if (row[k] >= 0)
        skeleton_loads_.col(row[k]) += load;
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
  const auto [row, sign] = factor_.rows_of(element);
  MatrixXd u = MatrixXd::Zero(size(), count_of(row));
  for (int k = 0; k < count_of(row); ++k)
    if (row[k] >= factor_.rows_.n_skeleton)
      u.col(k) = sign[k] * border_.col(row[k] - factor_.rows_.n_skeleton);
    else if (row[k] >= 0)
      u.col(k) = sign[k] * skeleton_.col(row[k]);
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

MatrixXd PlateStates::values(const CondensedFunctions& functions) const {
  MatrixXd values = boundary_coefficients(functions.element) * functions.boundary;
  if (const auto loaded = interior_.find(functions.element); loaded != interior_.end())
    values += loaded->second.transpose() * functions.interior;
  return values;
}

}  // namespace fastjoint::plate
