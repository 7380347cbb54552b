// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <functional>
#include <iterator>

namespace fastjoint {

/// Number of items of a list as an int, the type of all counts of nodes, elements, holes and degrees of freedom.
template <class List>
[[nodiscard]] constexpr int count_of(const List& list) {
  return static_cast<int>(std::size(list));
}

/// Index of the first item of a list that equals the value, or whose member does; the number of items if none does.
template <class List, class Value, class Member = std::identity>
[[nodiscard]] constexpr int index_of(const List& list, const Value& value, Member member = {}) {
  return static_cast<int>(std::ranges::find(list, value, member) - std::begin(list));
}

}  // namespace fastjoint
