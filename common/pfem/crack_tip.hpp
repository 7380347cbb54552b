// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace fastjoint::pfem {

/// The tip of a crack in a mesh that is graded towards it.
struct CrackTip {
  std::string id;      ///< name of the crack, and of which end of it if both are tips
  Eigen::Vector2d at;  ///< length
  double angle;        ///< direction in which the crack would grow, radians counter-clockwise from x
  double length;       ///< of the crack: from its other end, a rim or an edge, or half of it if both ends are tips
  /// Elements of each layer around the tip, the outermost first; local coordinate xi is -1 on the inner side of a
  /// layer.
  std::vector<std::vector<int>> layers{};
};

}  // namespace fastjoint::pfem
