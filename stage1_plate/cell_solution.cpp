// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/cell_solution.hpp"

namespace fastjoint::stage1 {

CellSolution::CellSolution(const PlateProblem& problem, const Cell& cell, const CondensedCell& condensed,
                           const std::vector<linalg::Condensed>& elements, const ElementModes& modes,
                           const Outline::Rows& rows)
    : problem_(problem),
      cell_(cell),
      shape_(problem.cells.shapes[static_cast<std::size_t>(cell.shape)]),
      condensed_(condensed),
      elements_(elements),
      modes_(modes),
      rows_(rows) {}

int CellSolution::target(int coefficient) const {
  const int function = cell_.function[static_cast<std::size_t>(coefficient / 2)];
  return problem_.unknowns.target[static_cast<std::size_t>(2 * function + coefficient % 2)];
}

CellSolution::Place CellSolution::place(std::size_t element, const std::vector<int>& modes) const {
  const auto column = static_cast<Eigen::Index>(element);
  Place place{{}, shape_.numbering.sign.col(column)(modes).replicate(2, 1)};
  for (int component = 0; component < 2; ++component)
    for (const int mode : modes) place.coefficient.push_back(2 * shape_.numbering.function(mode, column) + component);
  return place;
}

void CellSolution::eliminate(const Eigen::Ref<const Eigen::MatrixXd>& B) {
  const auto n_coefficients = 2 * shape_.numbering.n_functions.back();
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(n_coefficients, B.cols());
  for (int coefficient = 0; coefficient < n_coefficients; ++coefficient) {
    const int to = target(coefficient);
    if (!Unknowns::is_free(to) || to >= B.rows() || rows_.of_unknown[static_cast<std::size_t>(to)] >= 0) continue;
    load.row(coefficient) = sign(coefficient) * B.row(to);
  }
  loaded_ = !load.isZero(0);
  inside_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(condensed_.inside.size()), B.cols());
  interior_.assign(shape_.element_shape.size(), {});
  if (!loaded_) return;
  for (std::size_t i = 0; i < interior_.size(); ++i) {
    const auto& element = elements_[static_cast<std::size_t>(shape_.element_shape[i])];
    const auto interior = place(i, modes_.interior), outer = place(i, modes_.outer);
    interior_[i] = load(interior.coefficient, Eigen::all);  // interior modes have no sign
    Eigen::MatrixXd around = Eigen::MatrixXd::Zero(element.n_outside(), B.cols());
    element.eliminate(interior_[i], around);
    interior_[i] /= shape_.thickness[static_cast<Eigen::Index>(i)] * cell_.scale;
    for (Eigen::Index r = 0; r < around.rows(); ++r)
      load.row(outer.coefficient[static_cast<std::size_t>(r)]) += outer.sign[r] * around.row(r);
  }
  inside_ = load(condensed_.inside, Eigen::all);
  outside_ = Eigen::MatrixXd::Zero(condensed_.matrix.n_outside(), B.cols());
  outside_.topRows(static_cast<Eigen::Index>(condensed_.outside.size())) = load(condensed_.outside, Eigen::all);
  condensed_.matrix.eliminate(inside_, outside_);
  inside_ /= cell_.scale;
}

void CellSolution::add_to(Eigen::MatrixXd& outline) const {
  if (!loaded_) return;
  for (std::size_t r = 0; r < condensed_.outside.size(); ++r) {
    const int coefficient = condensed_.outside[r];
    const int to = target(coefficient);
    if (Unknowns::is_free(to))
      outline.row(rows_.of_target(to)) += sign(coefficient) * outside_.row(static_cast<Eigen::Index>(r));
  }
}

void CellSolution::restore(const Eigen::MatrixXd& outline, Eigen::Ref<Eigen::MatrixXd> X) {
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(2 * shape_.numbering.n_functions.back(), outline.cols());
  outside_.setZero(condensed_.matrix.n_outside(), outline.cols());
  for (std::size_t r = 0; r < condensed_.outside.size(); ++r) {
    const int coefficient = condensed_.outside[r];
    if (const int to = target(coefficient); Unknowns::is_free(to))
      outside_.row(static_cast<Eigen::Index>(r)) = sign(coefficient) * outline.row(rows_.of_target(to));
    u.row(coefficient) = outside_.row(static_cast<Eigen::Index>(r));
  }
  condensed_.matrix.restore(inside_, outside_);
  for (std::size_t r = 0; r < condensed_.inside.size(); ++r)
    u.row(condensed_.inside[r]) = inside_.row(static_cast<Eigen::Index>(r));
  for (std::size_t i = 0; i < interior_.size(); ++i) {
    const auto& element = elements_[static_cast<std::size_t>(shape_.element_shape[i])];
    const auto interior = place(i, modes_.interior), outer = place(i, modes_.outer);
    if (!loaded_) interior_[i].setZero(element.n_inside(), u.cols());
    element.restore(interior_[i], outer.sign.asDiagonal() * u(outer.coefficient, Eigen::all));
    for (std::size_t r = 0; r < interior.coefficient.size(); ++r)
      u.row(interior.coefficient[r]) = interior_[i].row(static_cast<Eigen::Index>(r));
  }
  for (int coefficient = 0; coefficient < u.rows(); ++coefficient)
    if (const int to = target(coefficient);
        Unknowns::is_free(to) && to < X.rows() && rows_.of_unknown[static_cast<std::size_t>(to)] < 0)
      X.row(to) = sign(coefficient) * u.row(coefficient);
}

}  // namespace fastjoint::stage1
