// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/solve.hpp"

#include <algorithm>

#include "common/linalg/cholesky.hpp"
#include "stage1_plate/springs.hpp"

namespace fastjoint::stage1 {

formats::PlateCases solve_degree(const PlateProblem& problem, int p, const Eigen::MatrixXd& mixture) {
  const int n = problem.unknowns.n_free[static_cast<std::size_t>(p)];
  const auto nc = problem.K_fc.cols();
  const auto q = problem.T_f.cols();
  Eigen::MatrixXd B(n, nc + q + mixture.cols());
  B.leftCols(nc) = -Eigen::MatrixXd(problem.K_fc.topRows(n));
  B.middleCols(nc, q) = Eigen::MatrixXd(problem.T_f.topRows(n));
  B.rightCols(mixture.cols()) = problem.L_f.topRows(n) * mixture;
  const linalg::Cholesky K(linalg::leading_block(problem.K_ff, n));
  const Eigen::MatrixXd X = K.solve(B);
  return {X.leftCols(nc), X.middleCols(nc, q), X.rightCols(mixture.cols())};
}

namespace {

/// Weights that no symmetry of the plate cancels: 1, 2, 3, ... over their number.
Eigen::MatrixXd probe(Eigen::Index n_friction_cases) {
  if (n_friction_cases == 0) return Eigen::MatrixXd(0, 0);
  const auto n = static_cast<double>(n_friction_cases);
  return Eigen::VectorXd::LinSpaced(n_friction_cases, 1, n) / n;
}

}  // namespace

formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
                                   const std::string& generator, Wanted wanted) {
  formats::PlateSolution a;
  a.header = {generator, scene.name, scene.units, scene.text};
  a.mesh = plate.mesh;
  a.elasticity = scene.elasticity;
  for (const auto& hole : scene.holes) {
    a.hole_id.push_back(hole.id);
    a.hole_spring.push_back(spring_of(hole));
  }
  a.hole_rim = plate.rims;
  a.sections = plate.sections;
  for (const auto& support : scene.supports)
    a.supported.insert(a.supported.end(), support.fix.begin(), support.fix.end());
  std::sort(a.supported.begin(), a.supported.end());
  a.supported.erase(std::unique(a.supported.begin(), a.supported.end()), a.supported.end());
  const Unknowns& unknowns = problem.unknowns;
  a.unknown = Eigen::Map<const Eigen::Matrix2Xi>(unknowns.target.data(), 2,
                                                 static_cast<Eigen::Index>(unknowns.target.size()) / 2);
  a.space = problem.numbering.space;
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
  for (const int i : unknowns.traction) {
    const External& external = scene.externals[static_cast<std::size_t>(i)];
    a.traction_hole.push_back(external.kind == ExternalKind::bearing ? external.on : "");
  }
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
  const auto h = problem.L_f.cols();
  a.friction_mixture = wanted == Wanted::loads ? probe(h) : Eigen::MatrixXd::Identity(h, h);
  constexpr Eigen::Index n_stress_levels = 2;  // their difference estimates the error
  if (wanted == Wanted::loads_and_stresses) a.stress_p = a.p.tail(std::min(a.p.size(), n_stress_levels));
  a.load_displacement.resize(0, problem.K_cc.cols());
  a.load_friction.resize(0, h);
  a.load_traction.resize(0, problem.T_f.cols());
  return a;
}

void add_contact(const ContactState& state, formats::PlateSolution& a) {
  for (const auto& contact : state.holes)
    a.contacts.push_back({contact.hole, contact.iterations, contact.peak_pressure, contact.peak_angle});
  a.load_displacement = state.displacement.transpose();
  a.load_friction = state.friction.transpose();
  a.load_traction = state.traction.transpose();
}

void solve_cases(const PlateProblem& problem, formats::PlateSolution& a) {
  const int first_mixed = a.stress_p.size() > 0 ? a.stress_p[0] : a.p[a.p.size() - 1];
  const Eigen::MatrixXd none(problem.L_f.cols(), 0);
  for (const int p : a.p) a.cases.push_back(solve_degree(problem, p, p >= first_mixed ? a.friction_mixture : none));
}

}  // namespace fastjoint::stage1
