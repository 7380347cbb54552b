// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/linalg/condensed.hpp"
#include "stage1_plate/problem/elements.hpp"

namespace fastjoint::stage1 {

/// A class of elements at one degree, condensed onto the functions that it shares and onto its border: by hole the
/// discs, then the friction cases. The border's rows are those of a bordered stiffness [K_ff K_fc -L; . K_cc -L_c], in
/// which a friction case has an amplitude as a disc has a displacement.
struct CondensedElement {
  std::vector<int> inside, outside;  ///< degrees of freedom of the element: mode, or n_modes + mode for u_y
  Eigen::Index n_border;
  linalg::Condensed matrix;
};

/// @param K Stiffness of the congruence class at the highest degree and unit thickness, (2 n_modes, 2 n_modes).
[[nodiscard]] CondensedElement condense(const ElementClass& elements, const Eigen::MatrixXd& K,
                                        const pfem::Numbering& numbering, int p);

}  // namespace fastjoint::stage1
