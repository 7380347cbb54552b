// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

namespace fastjoint::peer {

inline constexpr unsigned int n_octants = 8;  // cells around a hole

/// The panel that scripts/measure/make_panel prints: nx times ny unit squares, each with a hole and a disc in it.
struct Panel {
  unsigned int nx, ny, rings;
  /// Rigid displacements: the external's, then those of the discs row by row.
  [[nodiscard]] unsigned int n_controlled() const { return 1 + n_holes(); }
  [[nodiscard]] unsigned int n_holes() const { return nx * ny; }
  [[nodiscard]] unsigned int cells_per_square() const { return n_octants * (rings + 1); }
  [[nodiscard]] unsigned int hole_of(unsigned int cell) const { return cell / cells_per_square(); }
  [[nodiscard]] dealii::Point<2> center(unsigned int hole) const { return {hole % nx + 0.5, hole / nx + 0.5}; }
};

inline constexpr double radius = 0.125;

/// Boundary ids; 0 where nothing is held.
enum Border : unsigned int { left = 1, bottom = 2, right = 3, rim = 4 };

/// The elements that stage1_plate makes of it, arcs as manifolds. Cells go square by square, in the same order in each:
/// those at the rim first.
void make_mesh(const Panel& panel, dealii::Triangulation<2>& mesh);

}  // namespace fastjoint::peer
