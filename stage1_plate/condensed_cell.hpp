// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/linalg/condensed.hpp"
#include "stage1_plate/cells.hpp"

namespace fastjoint::stage1 {

/// Local modes of an element that the space of a lower degree has.
struct ElementModes {
  std::vector<int> outer;     ///< vertices and edges
  std::vector<int> interior;  ///< condensed with the element
};
[[nodiscard]] ElementModes modes_up_to(int p, const pfem::Numbering& numbering);

/// Stiffness of an element with its interior modes condensed: interior coefficients, then outer ones; of each first all
/// of u_x, then all of u_y, local signs.
/// @param K Of the highest degree, (2 n_modes, 2 n_modes).
[[nodiscard]] linalg::Condensed condense_element(const Eigen::MatrixXd& K, const ElementModes& modes);

/// A shape of cells at one degree, condensed onto its outline and its border: by hole the discs, then the friction
/// cases. The border's rows are those of a bordered stiffness [K_ff K_fc -L; . K_cc -L_c], in which a friction case has
/// an amplitude as a disc has a displacement.
struct CondensedCell {
  std::vector<int> inside, outside;  ///< coefficients of the shape's own functions: 2 function + component
  int n_border;
  linalg::Condensed matrix;
};

/// @param elements Condensed stiffness of each element shape, of unit thickness.
[[nodiscard]] CondensedCell condense_cell(const CellShape& shape, const std::vector<linalg::Condensed>& elements,
                                          const ElementModes& modes, int p);

}  // namespace fastjoint::stage1
