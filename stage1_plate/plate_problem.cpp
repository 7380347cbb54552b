// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/plate_problem.hpp"

#include <fmt/format.h>

#include <numeric>

#include "stage1_plate/assembler.hpp"
#include "stage1_plate/line_springs.hpp"
#include "stage1_plate/loads.hpp"
#include "stage1_plate/rim_couplings.hpp"

namespace fastjoint::stage1 {
namespace {

/// What elements at rigid externals add to K_fc and K_cc.
void add_externals(const PlateMesh& plate, const PlateProblem& problem, Assembler& assembler) {
  std::vector<int> modes(static_cast<std::size_t>(problem.numbering.function.rows()));
  std::iota(modes.begin(), modes.end(), 0);
  for (const auto& cell : problem.cells.cells) {
    const auto& shape = problem.cells.shapes[static_cast<std::size_t>(cell.shape)];
    for (std::size_t i = 0; i < shape.element_shape.size(); ++i) {
      const int element = cell.first_element + static_cast<int>(i);
      assembler.add_stiffness(element, modes,
                              problem.cells.element_stiffness[static_cast<std::size_t>(shape.element_shape[i])],
                              plate.mesh.thickness[element]);
    }
  }
}

}  // namespace

PlateProblem number_unknowns(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem;
  problem.numbering = pfem::number_by_degree(plate.mesh, plate.edges, scene.space, scene.p_high);
  problem.unknowns = classify_unknowns(scene, plate, problem.numbering);
  problem.cells = find_cells(scene, plate, problem.numbering, problem.unknowns);
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
  problem.cells.element_stiffness =
      pfem::integrate(problem.cells.elements, plate.mesh, plate.edges, scene.elasticity, scene.space, scene.p_high);
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
