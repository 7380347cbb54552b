// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace fastjoint::pfem {

/// Highest polynomial degree of an element.
inline constexpr int highest_p = 8;

/// Which functions phi_i(xi) phi_j(eta), i, j >= 2, an element of degree p has inside, beside those of its vertices and
/// edges. Szabo & Babuska 1991, section 6.2.
enum class Space {
  trunk,    ///< i + j <= p: what a polynomial of degree p needs; the paper's
  product,  ///< i, j <= p: what a polynomial of degree p in each coordinate needs
};

/// Names of the spaces in inputs and files, in their order.
inline const std::vector<std::string> space_names = {"trunk", "product"};

[[nodiscard]] inline const std::string& name_of(Space space) { return space_names[static_cast<std::size_t>(space)]; }

/// @param name One of space_names.
[[nodiscard]] inline Space space_named(const std::string& name) {
  return static_cast<Space>(std::find(space_names.begin(), space_names.end(), name) - space_names.begin());
}

}  // namespace fastjoint::pfem
