// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "stage3_nonlinear/scene/bending_scene.hpp"

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A sheet as a beam of s segments between s + 1 nodes: its ends, rows of fasteners, and changes of its section.
struct StackSheet {
  VectorXd at;                    ///< (s + 1) coordinates of the nodes, ascending, length
  VectorXd EI, width, thickness;  ///< (s) force length^2, length, length
  std::array<EndHold, 2> ends{};  ///< how its ends are held against bending
  std::vector<Index> rows;        ///< node of each row of fasteners

  /// Midpoints of the segments, (s).
  [[nodiscard]] VectorXd middles() const { return (at.head(EI.size()) + at.tail(EI.size())) / 2; }
  /// Segment on a side of a node, 0 before it, 1 behind it; -1 beyond an end.
  [[nodiscard]] Index beside(Index node, int side) const;
  /// Mean thickness of the segments at a row.
  [[nodiscard]] double thickness_at(Index row) const;
};

/// A row of fasteners between two neighbouring sheets, or between a sheet and the ground, which is straight.
struct StackLink {
  Index lower, lower_row;
  Index upper, upper_row;  ///< -1 for the ground

  [[nodiscard]] bool operator==(const StackLink&) const = default;
};

/// Forces in the plane of a stack along its axis.
struct StackLoads {
  std::vector<VectorXd> N;  ///< of each sheet, (s) tension of its segments, force; infinite where it is not known
  VectorXd q;               ///< of each link, force on the lower sheet by the upper, positive along + axis
};

/// How the sheets of a stack bend.
struct StackShape {
  std::vector<VectorXd> w, slope;   ///< of each sheet, (s + 1) deflection, length, and its derivative
  std::vector<VectorXd> shortened;  ///< (s + 1) integral of w'^2 / 2 from the first node, length
  std::vector<MatrixXd> moment;     ///< of each sheet, (s + 1, 2) E I w'' before and behind each node, force length
  std::vector<bool> pressed;        ///< of each link: free heads would press one sheet into the other
  bool buckles = false;             ///< compression makes the stack unstable: all the rest is NaN
  bool is_known = true;             ///< false where a tension is not: all the rest is NaN
};

/// Sheets in their order in z as exact beam-columns along an axis. At each link the deflections of both sheets are
/// equal; with clamped heads their slopes are too. Free heads let the slopes differ, but where one sheet would turn
/// into a neighbour that does not give way by a quarter as much, the faces prevent it, and the slopes are equal.
struct SheetStack {
  std::vector<StackSheet> sheets;
  std::vector<StackLink> links;

  [[nodiscard]] StackShape bend(const StackLoads& loads, bool clamped_heads) const;
};

}  // namespace fastjoint::stage3
