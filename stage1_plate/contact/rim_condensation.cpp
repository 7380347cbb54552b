// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/rim_condensation.hpp"

#include "common/plate/plate_states.hpp"

namespace fastjoint::stage1 {

/// The states solved for are unit loads on the rim unknowns, then unit tractions, displacements and friction cases.
RimCondensation condense_to_rims(const PlateProblem& problem, const RimUnknowns& rim) {
  const Eigen::Index n_r = rim.free.size(), q = problem.T_c.cols();
  const Eigen::Index nc = problem.unknowns.n_controlled(), h = problem.unknowns.n_friction_cases();
  Eigen::MatrixXd border = Eigen::MatrixXd::Zero(nc + h, n_r + q + nc + h);
  border.rightCols(nc + h).setIdentity();
  Eigen::SparseMatrix<double> loads(problem.T_f.rows(), border.cols());
  for (Eigen::Index i = 0; i < n_r; ++i) loads.insert(rim.free[i], i) = 1;
  loads.middleCols(n_r, q) = problem.T_f;
  const plate::PlateFactor K(problem, plate::Skeleton(problem), problem.numbering.p);
  const plate::PlateStates states(K, border, loads);
  const Eigen::MatrixXd u_r = states.work().topRows(n_r), forces = states.forces();
  return {u_r.leftCols(n_r),  u_r.middleCols(n_r + q, nc),    u_r.middleCols(n_r, q),
          u_r.rightCols(h),   forces.middleCols(n_r + q, nc), forces.middleCols(n_r, q) - problem.T_c,
          forces.rightCols(h)};
}

}  // namespace fastjoint::stage1
