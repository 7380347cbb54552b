// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/solve.hpp"

#include <algorithm>

#include "common/linalg/cholesky.hpp"

namespace fastjoint::stage1 {

formats::PlateCases solve_degree(const PlateProblem& problem, int p, const Eigen::VectorXd& probe) {
  const int n = problem.unknowns.n_free[static_cast<std::size_t>(p)];
  const auto nc = problem.K_fc.cols();
  const auto q = problem.T_f.cols();
  Eigen::MatrixXd B(n, nc + q + 1);
  B.leftCols(nc) = -Eigen::MatrixXd(problem.K_fc.topRows(n));
  B.middleCols(nc, q) = Eigen::MatrixXd(problem.T_f.topRows(n));
  B.rightCols(1) = problem.L_f.topRows(n) * probe;
  const linalg::Cholesky K(linalg::leading_block(problem.K_ff, n));
  const Eigen::MatrixXd X = K.solve(B);
  return {X.leftCols(nc), X.middleCols(nc, q), X.rightCols(1)};
}

Eigen::VectorXd probe_weights(Eigen::Index n_friction_cases) {
  return Eigen::VectorXd::LinSpaced(n_friction_cases, 1, static_cast<double>(n_friction_cases)) /
         std::max(1.0, static_cast<double>(n_friction_cases));
}

formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
                                   const std::string& generator) {
  formats::PlateSolution a;
  a.header = {generator, scene.name, scene.units, scene.text};
  a.mesh = plate.mesh;
  for (const auto& hole : scene.holes) a.hole_id.push_back(hole.id);
  a.hole_rim = plate.rims;
  for (const auto& support : scene.supports)
    a.supported.insert(a.supported.end(), support.fix.begin(), support.fix.end());
  std::sort(a.supported.begin(), a.supported.end());
  a.supported.erase(std::unique(a.supported.begin(), a.supported.end()), a.supported.end());
  const Unknowns& unknowns = problem.unknowns;
  a.p = Eigen::VectorXi::LinSpaced(scene.p_high - scene.p_low + 1, scene.p_low, scene.p_high);
  a.ndof = a.p.unaryExpr([&](int p) { return unknowns.n_free[static_cast<std::size_t>(p)]; });
  const auto name = [&](const std::vector<int>& list, auto& ids, auto& directions) {
    for (const int i : list) {
      ids.push_back(scene.externals[static_cast<std::size_t>(i)].id);
      directions.push_back(scene.externals[static_cast<std::size_t>(i)].direction);
    }
  };
  name(unknowns.rigid, a.external_id, a.external_direction);
  name(unknowns.traction, a.traction_id, a.traction_direction);
  a.disc_hole = unknowns.disc_hole;
  a.disc_direction = unknowns.disc_direction;
  a.friction_hole = problem.friction_hole;
  a.friction_bearing = problem.friction_bearing;
  a.K_fc = problem.K_fc;
  a.K_cc = problem.K_cc;
  a.L_f = problem.L_f;
  a.L_c = problem.L_c;
  a.T_f = problem.T_f;
  a.T_c = problem.T_c;
  a.friction_probe = probe_weights(problem.L_f.cols());
  return a;
}

}  // namespace fastjoint::stage1
