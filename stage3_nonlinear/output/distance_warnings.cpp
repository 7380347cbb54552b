// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/near_peaks.hpp"

namespace fastjoint::stage3 {

std::vector<program::Warning> distance_warnings(const JointModel& joint, double distance) {
  std::vector<std::string> holes;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& plate : joint.plates) {
    if (!plate.stress_level) continue;
    const VectorXd room = room_around(plate);
    for (Index i = 0; i < room.size(); ++i)
      if (distance >= room[i]) {
        holes.push_back(plate.name + ":" + plate.stresses.rim_hole[i]);
        least = std::min(least, room[i]);
      }
  }
  if (holes.empty()) return {};
  return {{"distance-too-far",
           fmt::format("{}: --distance {:g}: no stresses at this distance from {}, around which the sheet ends or "
                       "another hole begins, the nearest {:g} {} from the rim",
                       joint.file, distance, fmt::join(holes, ", "), least, unit(joint.units, 1, 0))}};
}

}  // namespace fastjoint::stage3
