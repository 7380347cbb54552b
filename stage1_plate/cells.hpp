// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/congruent_elements.hpp"
#include "common/pfem/numbering.hpp"
#include "stage1_plate/rim_terms.hpp"
#include "stage1_plate/unknowns.hpp"

namespace fastjoint::stage1 {

/// What congruent cells have in common: elements of equal shapes, alike joined, with equal springs on their rims.
struct CellShape {
  /// A side of a rim, of the first cell that has the shape.
  struct RimSide {
    int hole;     ///< index into Cell::holes
    int element;  ///< of the cell
    RimTerms terms;
  };
  pfem::Numbering numbering;       ///< of the cell as a mesh of its own
  std::vector<int> element_shape;  ///< (elements) index of the element's stiffness
  Eigen::VectorXd thickness;       ///< (elements) of the first cell that has the shape, length
  std::vector<bool> interior;      ///< (functions) lives inside one element
  std::vector<bool> kept;  ///< (functions) on the outline, or not free: no other may be eliminated with the cell
  std::vector<RimSide> rims;
};

/// Elements that are condensed as one onto their outline: a cell of a grid, or one element.
struct Cell {
  int shape;                  ///< index into PlateCells::shapes
  int first_element;          ///< the others follow
  double scale;               ///< its thickness over that of the shape: stiffnesses and loads are proportional to it
  std::vector<int> function;  ///< (functions of the shape) that of the plate
  Eigen::VectorXd sign;       ///< (functions) -1 where the plate's edge runs against the cell's and the mode is odd
  std::vector<int> holes;     ///< sprung holes with a rim in it
};

/// The plate as cells. A riveted panel has few different ones: each is integrated and condensed once.
struct PlateCells {
  pfem::CongruentElements elements;
  std::vector<Eigen::MatrixXd> element_stiffness;  ///< of unit thickness, by the elements' shape
  std::vector<CellShape> shapes;
  std::vector<Cell> cells;
};

/// Finds the cells, the shapes among them and what rims add to each shape; integrates nothing else.
[[nodiscard]] PlateCells find_cells(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                                    const Unknowns& unknowns);

}  // namespace fastjoint::stage1
