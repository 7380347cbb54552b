// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/unknowns.hpp"

#include <fmt/format.h>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

constexpr int undecided = 0;

int component_of(const std::string& direction) { return direction == "x" ? 0 : 1; }

/// Global functions that do not vanish on a side: two vertices, then the edge's modes.
std::vector<int> functions_on(const pfem::Numbering& numbering, const pfem::Side& side) {
  std::vector<int> list = pfem::modes_on_edge(numbering.p, side.local_edge);
  for (int& mode : list) mode = numbering.function(mode, side.element);
  return list;
}

[[noreturn]] void conflict(const PlateScene& scene, const PlateMesh& plate, const External& external, int function) {
  const std::string where =
      function < plate.mesh.n_nodes()
          ? fmt::format("at ({:g}, {:g})", plate.mesh.nodes(0, function), plate.mesh.nodes(1, function))
          : std::string("along an edge");
  reject(scene, "/external",
         fmt::format("external \"{}\" moves the plate in {} {}, where a support or another external holds it",
                     external.id, external.direction, where),
         "one support or rigid external for each displacement");
}

/// The vertices of its sides move with an external; their edge modes, which would bend it, are zero.
void control(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering, int index,
             Unknowns& unknowns) {
  const External& external = scene.externals[unknowns.rigid[index]];
  for (const auto& side : plate.sets.at(external.on))
    for (const int function : functions_on(numbering, side)) {
      int& dof = unknowns.dofs(component_of(external.direction), function);
      const int wanted = function < plate.mesh.n_nodes() ? pfem::controlled_dof(index) : pfem::fixed_dof;
      if (dof != undecided && dof != wanted) conflict(scene, plate, external, function);
      dof = wanted;
    }
}

void add_discs(const PlateScene& scene, Unknowns& unknowns) {
  for (const auto& disc : list_discs(scene)) {
    unknowns.disc_hole.push_back(disc.id);
    unknowns.disc_direction.push_back(disc.direction);
  }
  unknowns.n_directions = count_of(scene.disc_directions);
  int disc = 0;
  for (const auto& hole : scene.holes) {
    unknowns.disc_of_hole.push_back(hole.spring ? disc : -1);
    if (hole.spring) disc += unknowns.n_directions;
  }
  for (int i = 0; i < count_of(scene.points); ++i) unknowns.disc_of_point.push_back(disc + i * unknowns.n_directions);
  unknowns.n_controlled = unknowns.n_externals() + unknowns.n_discs();
}

void number_free(const pfem::Numbering& numbering, Unknowns& unknowns) {
  int n_free = 0, i = 0;
  for (const int n_functions : numbering.n_functions) {
    for (; i < 2 * n_functions; ++i)
      if (int& dof = unknowns.dofs(i % 2, i / 2); dof == undecided) dof = n_free++;
    unknowns.n_free.push_back(n_free);
  }
}

}  // namespace

Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering) {
  Unknowns unknowns;
  unknowns.dofs.setConstant(2, numbering.n_functions.back(), undecided);
  for (const auto& support : scene.supports)
    for (const auto& direction : support.fix)
      for (const auto& side : plate.sets.at(support.on))
        for (const int function : functions_on(numbering, side))
          unknowns.dofs(component_of(direction), function) = pfem::fixed_dof;
  for (int i = 0; i < count_of(scene.externals); ++i)
    (scene.externals[i].kind == ExternalKind::rigid ? unknowns.rigid : unknowns.traction).push_back(i);
  for (int i = 0; i < unknowns.n_externals(); ++i) control(scene, plate, numbering, i, unknowns);
  add_discs(scene, unknowns);
  number_free(numbering, unknowns);
  return unknowns;
}

}  // namespace fastjoint::stage1
