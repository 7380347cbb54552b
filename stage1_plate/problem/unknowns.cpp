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
void control(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering, int external_index,
             int index, Unknowns& unknowns) {
  const External& external = scene.externals[external_index];
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
}

void number_free(Unknowns& unknowns) {
  int n_free = 0;
  for (int& dof : unknowns.dofs.reshaped())
    if (dof == undecided) dof = n_free++;
}

std::vector<int> externals(const PlateScene& scene, bool rigid) {
  std::vector<int> list;
  for (int i = 0; i < count_of(scene.externals); ++i)
    if ((scene.externals[i].kind == ExternalKind::rigid) == rigid) list.push_back(i);
  return list;
}

}  // namespace

std::vector<int> rigid_externals(const PlateScene& scene) { return externals(scene, true); }

std::vector<int> traction_externals(const PlateScene& scene) { return externals(scene, false); }

int disc_of_point(const PlateScene& scene, const Unknowns& unknowns, int point) {
  return unknowns.n_discs() - (count_of(scene.points) - point) * unknowns.n_directions;
}

Unknowns classify_unknowns(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering) {
  Unknowns unknowns;
  unknowns.dofs.setConstant(2, numbering.n_functions.back(), undecided);
  for (const auto& support : scene.supports)
    for (const auto& direction : support.fix)
      for (const auto& side : plate.sets.at(support.on))
        for (const int function : functions_on(numbering, side))
          unknowns.dofs(component_of(direction), function) = pfem::fixed_dof;
  for (const int external : rigid_externals(scene))
    control(scene, plate, numbering, external, unknowns.n_externals++, unknowns);
  add_discs(scene, unknowns);
  number_free(unknowns);
  unknowns.n_free = plate::count_free(numbering, unknowns.dofs);
  return unknowns;
}

}  // namespace fastjoint::stage1
