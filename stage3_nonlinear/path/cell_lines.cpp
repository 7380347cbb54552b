// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/path/cell_lines.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::PartialPivLU;
using Eigen::VectorXd;

std::optional<Line> CellLines::in(const Cell& cell) {
  constexpr double singular = 1e-13;
  if (auto line = base_ ? from_base(cell) : std::nullopt) return line;
  const auto [J, offset] = joint_.equations(cell);
  PartialPivLU<MatrixXd> lu(J);
  ++n_factors_;
  const double stretch = least_stretch(lu, J);
  if (!(stretch > singular)) return std::nullopt;
  Line line{lu.solve(-offset), lu.solve(q_)};
  base_ = Base{cell, std::move(lu), stretch, std::move(line), {}};
  return base_->line;
}

std::optional<Line> CellLines::from_base(const Cell& cell) {
  constexpr Index most_changed = 8;      // columns of so many: below, a new factor takes no longer
  constexpr double surely_held = 1e-10;  // bound of least_stretch
  constexpr double rounding = 1e-12;     // of the largest entry of a line, out of balance
  const auto planes = joint_.changed(base_->cell, cell);
  const Index m = planes.size();
  if (most_changed * m > q_.size()) return std::nullopt;
  Line line = base_->line;
  if (m == 0) return line;
  MatrixXd Y(q_.size(), m);
  for (Index i = 0; i < m; ++i) {
    auto& [column, solution] = base_->changes[planes[i]];
    if (CellColumn now = joint_.column(cell, planes[i]); column.size() == 0 || column != now) {
      column = std::move(now);
      solution = base_->lu.solve(column - joint_.column(base_->cell, planes[i]));
    }
    Y.col(i) = solution.col(0);
    line.offset -= solution.col(1);
  }
  MatrixXd small = Y(planes, Eigen::all);
  small.diagonal().array() += 1;
  const PartialPivLU<MatrixXd> lu(small);
  const double stretch = least_stretch(lu, small);
  if (!(base_->stretch * stretch > surely_held * (stretch + Y.cwiseAbs().colwise().sum().maxCoeff())))
    return std::nullopt;
  for (VectorXd* x : {&line.offset, &line.rate}) *x -= Y * lu.solve((*x)(planes));
  const auto balances = [&](const VectorXd& forces, const VectorXd& x) {
    return forces.cwiseAbs().maxCoeff() <= rounding * x.cwiseAbs().maxCoeff();
  };
  if (!balances(joint_.forces(cell, line.offset, 1), line.offset) ||
      !balances(joint_.forces(cell, line.rate, 0) - q_, line.rate))
    return std::nullopt;
  return line;
}

}  // namespace fastjoint::stage3
