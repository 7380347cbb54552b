// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {
namespace {

/// Derivatives of the load columns by all parameters, (l, columns).
MatrixXd load_changes(const JointNumbers& numbers, const SolvedPoint& point) {
  const JointEquations& equations = point.equations();
  const auto& columns = equations.system->load_columns;
  MatrixXd changes = MatrixXd::Zero(std::ssize(columns), numbers.n_derivatives());
  changes.col(0) = equations.load_rates(point.load_factor());
  const VectorXd acting =
      equations.of_active_columns(point.load_factor(), VectorXd::Ones(equations.parameters.load.size()));
  for (Index i = 0; i < std::ssize(columns); ++i)
    changes(i, numbers.of_load[columns[i].load]) = point.load_factor() * acting[i];
  return changes;
}

/// Derivatives of the forces of rigid fasteners by all parameters, (r, columns).
MatrixXd rigid_forces(const CondensedSystem& system, const MatrixXd& load) {
  MatrixXd q = system.Q * load;
  for (Index i = 0; i < q.cols(); ++i)
    q.col(i) =
        without_rounding(q.col(i), load.col(i).cwiseAbs().cwiseProduct(system.Q_scale).lpNorm<Eigen::Infinity>());
  return q;
}

/// Adds the derivatives of the interfaces at fixed c to StateSlopes, and returns those of the residual.
MatrixXd add_changes(const JointNumbers& numbers, const SolvedPoint& point, StateSlopes& slopes) {
  const CondensedSystem& system = *point.equations().system;
  MatrixXd residual = -rigid_forces(system, slopes.load);
  for (Index i = 0; i < std::ssize(point.equations().interfaces); ++i) {
    const auto& [interface, row, friction] = point.equations().interfaces[i];
    const Index n = interface->size(), t = interface->n_friction();
    for (const Change& change : interface->changes(point.c().segment(row, n), point.state().parts[i])) {
      const Index column = numbers.column(change);
      slopes.F.col(column).segment(row, n) += change.F;
      slopes.delta.col(column).segment(row, n) += change.delta;
      slopes.Lambda.col(column).segment(friction, t) += change.Lambda;
      residual.col(column).segment(row, n) += change.F;
      residual.col(column) += system.S_ud.middleCols(row, n) * change.delta;
      if (t > 0) residual.col(column) += system.H.middleCols(friction, t) * change.Lambda;
    }
  }
  return residual;
}

}  // namespace

StateSlopes state_slopes(const JointNumbers& numbers, const SolvedPoint& point) {
  const Index columns = numbers.n_derivatives();
  const MatrixXd none = MatrixXd::Zero(point.c().size(), columns);
  StateSlopes all{none, none, MatrixXd::Zero(point.state().Lambda.size(), columns), load_changes(numbers, point),
                  {},   {}};
  const Slopes slopes = point.slopes(add_changes(numbers, point, all));
  all.F += slopes.F;
  all.delta += point.beyond().product(&Response::ddelta, slopes.c);
  all.Lambda += point.beyond().friction_by(slopes.c);
  all.none = slopes.no_column;
  all.no_row = slopes.no_row;
  return all;
}

MatrixXd sensitivity(const StateSlopes& slopes, const SolvedPoint& point) {
  return point.of_magnitudes({slopes.F, {}, slopes.none, slopes.no_row});
}

}  // namespace fastjoint::stage3
