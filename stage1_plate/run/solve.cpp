// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/solve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/linalg/processor.hpp"
#include "common/plate/cracks.hpp"
#include "common/plate/plate_states.hpp"
#include "common/plate/sections.hpp"
#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "common/program/progress.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

/// Changes of S between unit systems are up to 4 times the estimate of rounding, in slender cells of nearly
/// incompressible sheets (tests/attack/same_answers.py).
constexpr double rounding_margin = 5;

/// Coefficients of the probe, 1, 2, 3, ... over their number, which no symmetry of the plate cancels.
Eigen::VectorXd probe_coefficients(Eigen::Index n_cases) {
  const auto n = double(n_cases);
  return Eigen::VectorXd::LinSpaced(n_cases, 1, n) / n;
}

}  // namespace

formats::PlateSolution to_solution(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem,
                                   const std::string& generator) {
  formats::PlateSolution a;
  a.header = {generator, scene.name, scene.units, scene.text};
  a.mesh = plate.mesh;
  a.elasticity = scene.elasticity;
  for (int i = 0; i < count_of(scene.holes); ++i) {
    a.hole_id.push_back(scene.holes[i].id);
    a.hole_spring.push_back(std::optional<rim::HoleSpring>(scene.holes[i].spring).value_or(rim::HoleSpring{}));
  }
  for (const bool loaded : {true, false})
    for (int i = 0; i < count_of(scene.holes); ++i) {
      const auto& waves = problem.waves[i];
      if (!waves || waves->loaded != loaded) continue;
      const double radius = plate.rims[i].radius, thickness = plate.mesh.thickness[plate.rims[i].sides[0].element];
      const double area = thickness * radius * waves->shape.sweep;
      a.waves.push_back({a.hole_id[i], waves->shape, radius, area, a.hole_spring[i].modulus,
                         rim_compliance(scene, plate, i), a.hole_spring[i].arcs});
      if (!loaded) continue;
      rim::Harmonics pressures = waves->shape;
      if (a.waves.back().has_closed_form()) pressures.highest = scene.holes[i].sprung().harmonics.value_or(0);
      a.contact.push_back(
          {a.hole_id[i], pressures, a.hole_spring[i].modulus, radius, area, scene.holes[i].sprung().disk});
    }
  a.hole_rim = plate.rims;
  a.sections = plate.sections;
  a.tips = plate.tips;
  a.border = outline_of(scene, plate);
  std::set<std::string> supported;
  for (const auto& support : scene.supports)
    for (const rim::Axis axis : support.fix) supported.insert(rim::name_of(axis));
  a.supported.assign(supported.begin(), supported.end());
  const Unknowns& unknowns = problem.unknowns;
  a.unknown = unknowns.dofs;
  a.places = places_of(scene, plate, problem);
  a.bays = bays_of(scene, plate, a.border, a.places);
  if (scene.expansion) {
    a.expansion.resize(3);
    a.expansion << (*scene.expansion)(0, 0), (*scene.expansion)(1, 1), (*scene.expansion)(0, 1);
  }
  a.space = problem.numbering.space;
  a.p = degrees(scene);
  a.ndof = a.p.unaryExpr([&](int p) { return unknowns.n_free[p]; });
  for (const int i : rigid_externals(scene)) {
    a.external_id.push_back(scene.externals[i].id);
    a.external_direction.push_back(rim::name_of(scene.externals[i].direction));
  }
  for (const auto& [i, side, unit_force] : problem.tractions) {
    const External& external = scene.externals[i];
    a.traction_id.push_back(external.id);
    const bool is_moment = external.kind == ExternalKind::moment;
    a.traction_direction.push_back(is_moment ? formats::rotation : rim::name_of(external.direction));
    a.traction_arm.push_back(is_moment ? edge_moments(plate, external.on).arm : 0);
    a.traction_hole.push_back(side != 0 ? external.on : "");
    a.traction_bearing.push_back(side == 0 ? "" : rim::name_of({external.direction, side}));
  }
  if (unknowns.held_at) {
    a.held_at = *unknowns.held_at;
    a.traction_moment = resultants(scene, plate, problem.tractions, *unknowns.held_at).row(2).transpose();
  }
  a.disc_hole = unknowns.disc_hole;
  for (const rim::Axis axis : unknowns.disc_direction) a.disc_direction.push_back(rim::name_of(axis));
  a.friction_hole = problem.friction_hole;
  a.friction_bearing = problem.friction_bearing;
  a.T_f = problem.T_f;
  a.points = problem.ties;
  return a;
}

/// The states are the unit tractions, then the two of the probe.
/// @param sections Normal forces over all sections, then shear forces.
SolvedCases solve_degree(const PlateProblem& problem, const plate::PlateFactor& K, int p,
                         const plate::PlateFactor::Functions& sections,
                         const plate::PlateFactor::Functions& intensities) {
  const Unknowns& unknowns = problem.unknowns;
  const Eigen::Index nc = unknowns.n_controlled(), k = unknowns.n_loaded, h = unknowns.n_friction;
  const Eigen::Index q = problem.T_c.cols(), n_prescribed = unknowns.n_prescribed(), s = count_of(sections) / 2;
  auto functions = sections;
  functions.insert(functions.end(), intensities.begin(), intensities.end());
  const Eigen::Index n_functions = count_of(functions);
  const Eigen::VectorXd displacement = probe_coefficients(nc), wave = probe_coefficients(k);
  const Eigen::VectorXd friction = probe_coefficients(h);
  Eigen::MatrixXd border = Eigen::MatrixXd::Zero(n_prescribed, q + 2);
  border.col(q).head(nc) = displacement;
  border.col(q + 1).tail(k + h) << wave, friction;
  Eigen::SparseMatrix<double> loads = problem.T_f.topRows(unknowns.n_free[p]);
  loads.conservativeResize(loads.rows(), q + 2);
  const plate::PlateStates states(K, border, loads);
  const Eigen::MatrixXd forces = states.forces(), work = states.work(), SR = K.condensed(functions);
  const Eigen::Index n_other = forces.rows() - n_prescribed;
  const auto waves = [&](const auto& rows, Eigen::Index first, Eigen::Index n) -> Eigen::MatrixXd {
    Eigen::MatrixXd both(k + n_other, n);
    both << rows.block(nc, first, k, n), rows.block(n_prescribed, first, n_other, n);
    return both;
  };
  Eigen::MatrixXd W(k + n_other, n_prescribed + q), values = Eigen::MatrixXd::Zero(n_functions, n_prescribed + q);
  W << waves(SR, 0, n_prescribed), waves(forces, 0, q);
  values.leftCols(n_prescribed) = SR.bottomRows(n_functions);
  for (Eigen::Index i = 0; i < n_functions; ++i)
    for (const auto& part : functions[i]) values.row(i).tail(q) += states.values(part).topRows(q).transpose();
  const double rounding = rounding_margin * states.rounding()[q] / std::max(displacement.squaredNorm(), 1e-300);
  Eigen::MatrixXd S = SR.topLeftCorner(nc, nc);
  if (nc > 0 && S.cwiseAbs().maxCoeff() <= rounding) S.setZero();  // one disc alone holds the sheet
  return {
      {std::move(S), SR.block(0, nc + k, nc, h), forces.topLeftCorner(nc, q) - problem.T_c, work.topLeftCorner(q, q),
       std::move(W), values.topRows(s), values.middleRows(s, s), values.bottomRows(n_functions - 2 * s)},
      {displacement, wave, friction, forces.col(q).head(nc), forces.col(q + 1).head(nc), waves(forces, q, 1),
       waves(forces, q + 1, 1), work.col(q).head(q) + problem.T_c.transpose().lazyProduct(displacement), rounding}};
}

void solve_cases(const PlateProblem& problem, const plate::Skeleton& skeleton, formats::PlateSolution& a) {
  std::mutex reporting;
  double done = 0;
  const auto report = [&](double unknowns) {  // the time for a degree is about proportional to its unknowns
    const std::lock_guard lock(reporting);
    program::report_share((done += unknowns) / a.ndof.sum());
  };
  report(0);
  a.cases.resize(a.p.size());
  const pfem::Edges edges = pfem::find_edges(a.mesh);
  linalg::for_each_index(a.p.size(), [&](std::size_t i) {
    const Eigen::Index at = a.p.size() - 1 - i;  // starts with the highest degree, which takes longest
    const bool with_stresses = a.has_stresses(at);
    const plate::PlateFactor K(problem, skeleton, a.p[at], with_stresses);
    report(0.5 * a.ndof[at]);
    const auto sections = plate::section_forces(K, a.mesh, edges, problem.numbering, a.elasticity,
                                                with_stresses ? a.sections : std::vector<rim::Section>());
    const auto intensities = plate::stress_intensities(K, a.mesh, edges, problem.numbering, a.elasticity, a.tips);
    auto [cases, probe] = solve_degree(problem, K, a.p[at], sections, intensities);
    a.cases[at] = std::move(cases);
    if (i == 0) a.probe = std::move(probe), a.held_stiffness = K.diagonal_of_K_cc();
    report(0.5 * a.ndof[at]);
  });
}

SolvedPlate solve_plate(const PlateScene& scene, const std::string& generator, program::Timings& timings) {
  timings.phase("mesh");
  const PlateMesh plate = make_mesh(scene);
  PlateProblem problem = number_unknowns(scene, plate);
  check_rigid_motions(scene, plate, problem.unknowns);
  const plate::Skeleton skeleton(problem);
  const MemoryNeed need =
      memory_need(problem, skeleton, degrees(scene), 2 * count_of(plate.sections) + 2 * count_of(plate.tips));
  require_memory(scene.file, scene.p_high, need);
  timings.phase("integrate");
  integrate(scene, plate, problem);
  auto solution = to_solution(scene, plate, problem, generator);
  timings.phase("solve");
  with_extremes(scene, plate, problem, [&] { solve_cases(problem, skeleton, solution); });
  for (int i = 0; i < solution.p.size(); ++i) timings.set_unknowns(solution.p[i], solution.ndof[i]);
  return {need, std::move(solution), missing_symmetry(scene, plate, problem.unknowns), few_waves(scene, plate),
          plate.moved_lines};
}

std::string summary(const SolvedPlate& plate, const std::string& file) {
  using program::counted;
  const auto& a = plate.solution;
  std::string text = fmt::format("{}: {}, {}, {}, {}, {}; the run needs about {}\n", file,
                                 counted(a.mesh.n_elements(), "element"), counted(a.mesh.n_nodes(), "node"),
                                 counted(a.disc_hole.size(), "disc"), counted(a.external_id.size(), "rigid external"),
                                 counted(a.traction_id.size(), "traction"), program::bytes_text(plate.need.total()));
  for (int i = 0; i < a.p.size(); ++i) text += fmt::format("  p = {}: {}\n", a.p[i], counted(a.ndof[i], "unknown"));
  if (a.held_at.size() > 0)
    text +=
        fmt::format("  nothing holds the sheet: its loads must be in balance; its fields are held at ({:g}, {:g})\n",
                    a.held_at[0], a.held_at[1]);
  for (const auto& move : plate.moved_lines) text += fmt::format("  cell line {}\n", move);
  const auto on_springs = std::ranges::count_if(a.contact, [](const auto& rim) { return !rim.disk.is_given(); });
  if (on_springs > 0)
    text += fmt::format(
        "  contact by springs at {}: they model a pin for its mean pressure only; the peak hoop stress by a pin of the "
        "sheet's material is 3 to 6 % too low; \"law\": \"elastic\" models the pin itself\n",
        counted(on_springs, "hole"));
  return text;
}

MemoryNeed memory_need(const PlateProblem& problem, const plate::Skeleton& skeleton, const Eigen::VectorXi& p,
                       int n_sections) {
  const auto n_at_once = std::min<Eigen::Index>(linalg::threads(), p.size());
  plate::FactorBytes need{};
  for (const int degree : p.tail(n_at_once)) {
    const auto of_degree = plate::factor_bytes(problem, skeleton, degree);
    need = {of_degree.elements, need.condensed + of_degree.condensed, need.factor + of_degree.factor,
            need.elimination + of_degree.elimination};
  }
  const double nc = problem.unknowns.n_prescribed(), all = problem.unknowns.n_border() + n_sections;
  const double q = count_of(problem.tractions);
  const double n_p = problem.unknowns.n_free[p[p.size() - 1]];
  // Successive steps keep each other's results: two copies of the fields, three of the condensed rows.
  const double fields = double(n_at_once) * (2 * n_p * (q + 2) + 3 * all * nc);
  const double degrees = count_of(p), full = std::min<double>(degrees, formats::n_stress_degrees);
  const double file = 2 * nc * (full * all + (degrees - full) * nc);
  constexpr double number = sizeof(double), libraries = 20e6;
  return {need.elements + need.condensed, need.factor, need.elimination + number * fields, number * file, libraries};
}

void require_memory(const std::string& file, int p, const MemoryNeed& need) {
  using program::bytes_text;
  program::require_memory(fmt::format("{}: at p = {} this", file, p), need.total(),
                          fmt::format(" (shapes {}, factor {}, fields {}, file {})", bytes_text(need.elements),
                                      bytes_text(need.factor), bytes_text(need.fields), bytes_text(need.file)),
                          fmt::format("fewer degrees or a lower one (--p), or fewer holes{}",
                                      linalg::threads() > 1 ? ", or --threads 1" : ""));
}

}  // namespace fastjoint::stage1
