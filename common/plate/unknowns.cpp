// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/unknowns.hpp"

#include <algorithm>

namespace fastjoint::plate {

int Unknowns::n_friction_cases() const {
  const auto n_sprung = std::ranges::count_if(disc_of_hole, [](int disc) { return disc >= 0; });
  return 2 * n_directions * static_cast<int>(n_sprung);
}

std::vector<int> Unknowns::border_of(const std::vector<int>& holes) const {
  std::vector<int> list;
  for (const int hole : holes) {
    const int disc = disc_of_hole[hole];
    for (int a = 0; a < n_directions; ++a) list.push_back(controlled_of_disc(disc + a));
    for (int c = 0; c < 2 * n_directions; ++c) list.push_back(n_controlled() + 2 * disc + c);
  }
  return list;
}

std::vector<int> count_free(const pfem::Numbering& numbering, const Eigen::Matrix2Xi& dofs) {
  std::vector<int> n_free;
  for (const int n : numbering.n_functions) n_free.push_back(static_cast<int>((dofs.leftCols(n).array() >= 0).count()));
  return n_free;
}

}  // namespace fastjoint::plate
