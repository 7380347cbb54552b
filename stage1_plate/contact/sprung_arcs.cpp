// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/sprung_arcs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::stage1 {

constexpr double touching = 1e-9;  // radians: ends of neighbouring sides differ by rounding only

Arcs joined(std::vector<rim::AngleRange> pieces) {
  for (auto& piece : pieces) {
    const double length = piece.to - piece.from;
    piece.from = rim::wrapped(piece.from + touching) - touching;  // an end at pi is one at -pi
    piece.to = piece.from + length;
  }
  std::sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  Arcs arcs;
  for (const auto& piece : pieces) {
    if (!arcs.empty() && piece.from - arcs.back().to < touching)
      arcs.back().to = piece.to;
    else
      arcs.push_back(piece);
  }
  if (arcs.empty()) return arcs;
  if (arcs.size() == 1 && arcs[0].to - arcs[0].from > rim::full_turn - touching)
    return {{-rim::full_turn / 2, rim::full_turn / 2}};
  if (arcs.size() > 1 && arcs.front().from + rim::full_turn - arcs.back().to < touching) {
    arcs.back().to = arcs.front().to + rim::full_turn;
    arcs.erase(arcs.begin());
  }
  return arcs;
}

double largest_move(const Arcs& before, const Arcs& after) {
  if (before.size() != after.size()) return std::numeric_limits<double>::infinity();
  double move = 0;
  for (const auto& arc : after) {
    double nearest = std::numeric_limits<double>::infinity();  // an arc moved over pi changes its place in the list
    for (const auto& old : before)
      nearest = std::min(
          nearest, std::max(std::abs(rim::wrapped(arc.from - old.from)), std::abs(rim::wrapped(arc.to - old.to))));
    move = std::max(move, nearest);
  }
  return move;
}

}  // namespace fastjoint::stage1
