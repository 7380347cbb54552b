// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include <cstddef>
#include <vector>

#include "tests/bench/peer_elements.hpp"
#include "tests/bench/peer_mesh.hpp"

namespace fastjoint::peer {

inline constexpr int held = -1, inside_a_cell = -2, with_external = -3;  // unknowns that are no row of the system

/// The panel's finite elements; their unknowns are rows of a system, or left out of it.
struct Discretisation {
  Discretisation(const Panel& of, unsigned int p);
  void leave_out_insides();
  void number_rows();
  [[nodiscard]] std::vector<dealii::types::global_dof_index> indices(const Cell& cell) const;

  Panel panel;
  dealii::Triangulation<2> mesh;
  dealii::FESystem<2> fe;
  dealii::MappingQ<2> mapping;
  dealii::DoFHandler<2> dofs;
  std::vector<int> row;  ///< of each unknown
  unsigned int n_rows = 0;
  std::ptrdiff_t n_unknowns;

 private:
  void hold(Border border, unsigned int component, int as);
};

/// Places of a cell's unknowns, its disc's displacement among them: in the cell's matrix and in the system.
struct Places {
  std::vector<unsigned int> local, global;
  void add(unsigned int here, unsigned int there) {
    local.push_back(here);
    global.push_back(there);
  }
};
struct CellPlaces {
  CellPlaces(const Discretisation& plate, const Cell& cell);
  Places free, controlled;
};

}  // namespace fastjoint::peer
