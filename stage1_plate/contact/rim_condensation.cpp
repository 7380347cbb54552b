// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/rim_condensation.hpp"

#include "common/plate/plate_factor.hpp"

namespace fastjoint::stage1 {

RimCondensation condense_to_rims(const PlateProblem& problem, const RimUnknowns& rim, bool with_friction) {
  const auto n = problem.K_fc.rows();
  const Eigen::Index n_r = rim.free.size();
  const auto nc = problem.K_fc.cols();
  const auto q = problem.T_f.cols();
  const auto h = problem.L_f.cols();
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(n, nc + q + n_r + (with_friction ? h : 0));
  B.leftCols(nc) = -Eigen::MatrixXd(problem.K_fc);
  B.middleCols(nc, q) = Eigen::MatrixXd(problem.T_f);
  for (Eigen::Index i = 0; i < n_r; ++i) B(rim.free[i], nc + q + i) = 1;
  if (with_friction) B.rightCols(h) = Eigen::MatrixXd(problem.L_f);
  const Eigen::MatrixXd X = plate::PlateFactor(problem, plate::Skeleton(problem), problem.numbering.p).solve(B);
  const Eigen::MatrixXd X_r = X(rim.free, Eigen::all);
  const auto U = X.leftCols(nc);
  RimCondensation a;
  a.U_r = X_r.leftCols(nc);
  a.V_r = X_r.middleCols(nc, q);
  a.C = X_r.middleCols(nc + q, n_r);
  a.W_r = with_friction ? Eigen::MatrixXd(X_r.rightCols(h)) : Eigen::MatrixXd::Zero(n_r, h);
  a.S = problem.K_cc + problem.K_fc.transpose() * U;
  a.T = -(U.transpose() * problem.T_f + problem.T_c);
  a.R = -(U.transpose() * problem.L_f + problem.L_c);
  return a;
}

}  // namespace fastjoint::stage1
