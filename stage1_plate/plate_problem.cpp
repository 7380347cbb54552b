// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/plate_problem.hpp"

#include "common/pfem/congruent_stiffness.hpp"
#include "stage1_plate/assembler.hpp"
#include "stage1_plate/line_springs.hpp"
#include "stage1_plate/loads.hpp"
#include "stage1_plate/springs.hpp"

namespace fastjoint::stage1 {

PlateProblem assemble(const PlateScene& scene, const PlateMesh& plate) {
  PlateProblem problem;
  problem.numbering = pfem::number_by_degree(plate.mesh, plate.edges, scene.space, scene.p_high);
  problem.unknowns = classify_unknowns(scene, plate, problem.numbering);
  Assembler assembler(problem.numbering, problem.unknowns);
  pfem::CongruentStiffness stiffness(plate.mesh, plate.edges, scene.elasticity, scene.space, scene.p_high);
  for (int element = 0; element < plate.mesh.n_elements(); ++element)
    assembler.add_stiffness(element, stiffness(element), plate.mesh.thickness[element]);
  add_springs(scene, plate, problem.numbering, problem.unknowns, assembler);
  add_line_springs(scene, plate, problem.unknowns, assembler);
  problem.K_ff = assembler.K_ff();
  problem.K_fc = assembler.K_fc();
  problem.K_cc = assembler.K_cc();
  add_friction_loads(scene, plate, problem);
  add_traction_loads(scene, plate, problem);
  return problem;
}

}  // namespace fastjoint::stage1
