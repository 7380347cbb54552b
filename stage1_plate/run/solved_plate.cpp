// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/solved_plate.hpp"

#include <fmt/format.h>

#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "stage1_plate/problem/rigid_body_check.hpp"
#include "stage1_plate/run/contact_summary.hpp"
#include "stage1_plate/scene/degree_range.hpp"

namespace fastjoint::stage1 {

SolvedPlate solve_plate(PlateScene scene, Wanted wanted, const std::string& generator, program::Timings& timings) {
  timings.phase("mesh");
  const PlateMesh plate = make_mesh(scene);
  PlateProblem problem = number_unknowns(scene, plate);
  check_held(scene, plate, problem.unknowns);
  const Skeleton skeleton(problem);  // of vertices and edges, whatever arcs contact finds
  const int n_rim = scene.loads ? count_of(find_rim_unknowns(scene, plate, problem).free) : 0;
  const MemoryNeed need = memory_need(problem, skeleton, degrees(scene), wanted, n_rim);
  require_memory(scene.file, scene.p_high, need);
  timings.phase("integrate");
  integrate(scene, plate, problem);
  std::optional<ContactState> contact;
  if (scene.loads) {
    timings.phase("factorise");
    contact = find_contact(scene, plate, problem);
    timings.phase("integrate");
    scene = with_arcs(std::move(scene), *contact);
    problem = assemble(scene, plate);
    check_held(scene, plate, problem.unknowns);
  }
  auto solution = to_solution(scene, plate, problem, generator, wanted);
  if (contact) add_contact(*contact, solution);
  solve_cases(problem, skeleton, solution, timings);
  for (Eigen::Index i = 0; i < solution.p.size(); ++i) timings.set_unknowns(solution.p[i], solution.ndof[i]);
  return {std::move(scene), std::move(contact), need, std::move(solution)};
}

std::string summary(const SolvedPlate& plate, const std::string& file) {
  using program::counted;
  const auto& a = plate.solution;
  std::string text = fmt::format("{}: {}, {}, {}, {}, {}; the run needs about {}\n", file,
                                 counted(a.mesh.n_elements(), "element"), counted(a.mesh.n_nodes(), "node"),
                                 counted(a.disc_hole.size(), "disc"), counted(a.external_id.size(), "rigid external"),
                                 counted(a.traction_id.size(), "traction"), program::bytes_text(plate.need.total()));
  for (Eigen::Index i = 0; i < a.p.size(); ++i)
    text += fmt::format("  p = {}: {}\n", a.p[i], counted(a.ndof[i], "unknown"));
  return plate.contact ? text + contact_summary(plate.scene, *plate.contact) : text;
}

}  // namespace fastjoint::stage1
