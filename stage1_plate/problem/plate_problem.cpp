// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>

#include <numeric>

#include "stage1_plate/problem/assembler.hpp"
#include "stage1_plate/problem/line_springs.hpp"
#include "stage1_plate/problem/loads.hpp"
#include "stage1_plate/problem/rim_couplings.hpp"

namespace fastjoint::stage1 {
namespace {

/// What elements at rigid externals add to K_fc and K_cc.
void add_externals(const PlateMesh& plate, const PlateProblem& problem, Assembler& assembler) {
  std::vector<int> modes(problem.numbering.function.rows());
  std::iota(modes.begin(), modes.end(), 0);
  for (int element = 0; element < plate.mesh.n_elements(); ++element) {
    const std::size_t shape = problem.elements.congruent.shape[element];
    assembler.add_stiffness(element, modes, problem.elements.stiffness[shape], plate.mesh.thickness[element]);
  }
}

}  // namespace

PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem;
  problem.numbering = pfem::number_by_degree(plate.mesh, plate.edges, scene.space, scene.p_high);
  problem.unknowns = classify_unknowns(scene, plate, problem.numbering);
  problem.elements = find_kinds(scene, plate, problem.numbering, problem.unknowns);
  problem.ties = tie_points(scene, plate, problem.unknowns);
  for (const auto& hole : scene.holes) {
    if (!hole.spring) continue;
    for (const auto& direction : scene.disc_directions)
      for (const char* sign : {"+", "-"}) {
        problem.friction_hole.push_back(hole.id);
        problem.friction_bearing.push_back(fmt::format("{}{}", sign, direction));
      }
  }
  return problem;
}

void integrate(const PlateScene& scene, const PlateMesh& plate, PlateProblem& problem) {
  problem.elements.stiffness =
      pfem::integrate(problem.elements.congruent, plate.mesh, plate.edges, scene.elasticity, scene.space, scene.p_high);
  Assembler assembler(problem.numbering, problem.unknowns);
  if (problem.unknowns.n_externals() > 0) add_externals(plate, problem, assembler);
  add_springs(scene, problem, assembler);
  for (const auto& tie : problem.ties) assembler.add_spring(tie.target, tie.controlled, tie.stiffness);
  problem.K_fc = assembler.K_fc();
  problem.K_cc = assembler.K_cc();
  add_friction_loads(problem);
  add_traction_loads(scene, plate, problem);
}

PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem = number_unknowns(scene, plate);
  integrate(scene, plate, problem);
  return problem;
}

}  // namespace fastjoint::stage1
