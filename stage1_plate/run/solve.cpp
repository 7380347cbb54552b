// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/solve.hpp"

#include <algorithm>

#include "stage1_plate/factor/plate_factor.hpp"
#include "stage1_plate/problem/springs.hpp"
#include "stage1_plate/scene/degree_range.hpp"

namespace fastjoint::stage1 {

namespace {

bool has_fields(const formats::PlateSolution& a, int p) {
  return std::find(a.stress_p.begin(), a.stress_p.end(), p) != a.stress_p.end();
}

formats::PlateCases solve_degree(const PlateProblem& problem, const PlateFactor& K, int n, bool with_fields) {
  const Eigen::MatrixXd E = K.energy_rows();
  const auto solve = [&](const Eigen::SparseMatrix<double>& loads, bool wanted) -> Eigen::MatrixXd {
    return wanted ? K.solve(Eigen::MatrixXd(loads.topRows(n))) : Eigen::MatrixXd(n, 0);
  };
  const auto nc = problem.K_fc.cols();
  return {E.topRows(nc), E.bottomRows(E.rows() - nc), solve(-problem.K_fc, with_fields), solve(problem.T_f, true),
          solve(problem.L_f, with_fields)};
}

/// Amounts that no symmetry of the plate cancels: 1, 2, 3, ... over their number.
Eigen::VectorXd amounts(Eigen::Index n_cases) {
  const auto n = static_cast<double>(n_cases);
  return n_cases > 0 ? Eigen::VectorXd(Eigen::VectorXd::LinSpaced(n_cases, 1, n) / n) : Eigen::VectorXd();
}

formats::Probe probe(const PlateProblem& problem, const PlateFactor& K) {
  const Eigen::VectorXd displacement = amounts(problem.K_fc.cols()), friction = amounts(problem.L_f.cols());
  Eigen::MatrixXd B(problem.K_fc.rows(), 2);
  B << -(problem.K_fc * displacement), problem.L_f * friction;
  const Eigen::MatrixXd X = K.solve(B);
  return {displacement, friction, X.col(0), X.col(1),
          K.rounding(X.col(0)) / std::max(displacement.squaredNorm(), 1e-300)};
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
  a.unknown = unknowns.dofs;
  a.space = problem.numbering.space;
  a.p = degrees(scene);
  a.ndof = a.p.unaryExpr([&](int p) { return unknowns.n_free[p]; });
  const auto name = [&](const std::vector<int>& list, auto& ids, auto& directions) {
    for (const int i : list) {
      ids.push_back(scene.externals[i].id);
      directions.push_back(scene.externals[i].direction);
    }
  };
  name(unknowns.rigid, a.external_id, a.external_direction);
  name(unknowns.traction, a.traction_id, a.traction_direction);
  for (const int i : unknowns.traction) {
    const External& external = scene.externals[i];
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
  a.shift = shift(problem);
  constexpr Eigen::Index n_stress_levels = 2;  // their difference estimates the error
  if (wanted == Wanted::loads_and_stresses) a.stress_p = a.p.tail(std::min(a.p.size(), n_stress_levels));
  a.load_displacement.resize(0, problem.K_cc.cols());
  a.load_friction.resize(0, problem.L_f.cols());
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

void solve_cases(const PlateProblem& problem, const Skeleton& skeleton, formats::PlateSolution& a,
                 program::Timings& timings) {
  for (Eigen::Index i = 0; i < a.p.size(); ++i) {
    timings.phase("factorise");
    const PlateFactor K(problem, skeleton, a.p[i]);
    timings.phase("solve");
    a.cases.push_back(solve_degree(problem, K, a.ndof[i], has_fields(a, a.p[i])));
    if (i + 1 == a.p.size()) a.probe = probe(problem, K);
  }
}

}  // namespace fastjoint::stage1
