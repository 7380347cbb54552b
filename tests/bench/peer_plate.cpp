// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/peer_plate.hpp"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>

#include <algorithm>

namespace fastjoint::peer {

using namespace dealii;

Discretisation::Discretisation(const Panel& of, unsigned int p) : panel(of), fe(FE_Q<2>(p), 2), mapping(p) {
  make_mesh(panel, mesh);
  dofs.reinit(mesh);
  dofs.distribute_dofs(fe);
  row.assign(dofs.n_dofs(), 0);
  hold(left, 0, held);
  hold(bottom, 1, held);
  hold(right, 0, with_external);
  n_unknowns = std::count(row.begin(), row.end(), 0);
}

void Discretisation::hold(Border border, unsigned int component, int as) {
  const auto mask = fe.component_mask(FEValuesExtractors::Scalar(component));
  for (const auto dof : DoFTools::extract_boundary_dofs(dofs, mask, {border})) row[dof] = as;
}

void Discretisation::leave_out_insides() {
  for (const auto& cell : dofs.active_cell_iterators()) {
    const auto index = indices(cell);
    for (unsigned int i = fe.get_first_quad_index(); i < index.size(); ++i) row[index[i]] = inside_a_cell;
  }
}

void Discretisation::number_rows() {
  n_rows = 0;
  for (int& each : row)
    if (each >= 0) each = static_cast<int>(n_rows++);
}

std::vector<types::global_dof_index> Discretisation::indices(const Cell& cell) const {
  std::vector<types::global_dof_index> index(fe.n_dofs_per_cell());
  cell->get_dof_indices(index);
  return index;
}

CellPlaces::CellPlaces(const Discretisation& plate, const Cell& cell) {
  const auto index = plate.indices(cell);
  for (unsigned int i = 0; i < index.size(); ++i) {
    const int row = plate.row[index[i]];
    if (row >= 0) free.add(i, static_cast<unsigned int>(row));
    if (row == with_external) controlled.add(i, 0);
  }
  controlled.add(plate.fe.n_dofs_per_cell(), 1 + plate.panel.hole_of(cell->active_cell_index()));
}

}  // namespace fastjoint::peer
