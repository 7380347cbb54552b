// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iterator>

namespace fastjoint {

/// Number of items of a list as an int, in which nodes, elements, holes and degrees of freedom are counted.
template <class List>
[[nodiscard]] constexpr int count_of(const List& list) {
  return static_cast<int>(std::size(list));
}

}  // namespace fastjoint
