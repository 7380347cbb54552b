// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "stage3_nonlinear/model/disc_rows.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/strength/sheet_stack.hpp"

namespace fastjoint::stage3 {

/// Secondary bending of a joint: its sheets as exact beam-columns around the joint in the plane, along x and along y,
/// with free and with clamped heads (docs/theory.md, section 11.9).
class Bending {
 public:
  /// Throws InputError if fasteners contradict each other in the order of the sheets.
  /// @param joint, scene Outlive this.
  Bending(const JointModel& joint, const JointScene& scene);

  /// Sets the bending of an increment that was solved: JointState::bending and that of its plates. The slopes and the
  /// shortening of the sheets act back on the forces in the plane: the joint is solved again with the sheets displaced
  /// by them, until the moments change by no more than BendingScene::mismatch.
  /// @param equations With the history at the start of the increment.
  void add(const JointEquations& equations, const PathStep& step, JointState& state) const;

 private:
  /// The sheets along one axis, in the order of the plates.
  struct Axis {
    Index direction;                   ///< of the joint
    int axis;                          ///< 0 x, 1 y
    std::vector<Index> first_row;      ///< of each plate, among all its rows
    std::vector<Index> link_of_plane;  ///< (n) -1 where the discs do not move along the axis
    SheetStack stack;
  };
  using Shapes = std::vector<StackShape>;  ///< of each axis

  void add_axis(Index direction);
  [[nodiscard]] StackSheet sheet(const PlateModel& plate, int axis, Index& first_row) const;
  void check_order() const;
  [[nodiscard]] std::vector<StackLoads> loads(const JointState& state) const;
  [[nodiscard]] Shapes bent(const std::vector<StackLoads>& loads, Heads heads) const;
  /// Displacements of the free sheets by their slopes and shortening: (n a) offsets of the planes, then of each load.
  [[nodiscard]] VectorXd displaced(const Shapes& shapes, const JointEquations& equations) const;
  /// Displacement of a sheet by its shortening at each node of its beam, length.
  [[nodiscard]] VectorXd shortened(const Axis& its, const Shapes& shapes, Index at, Index plate) const;
  /// Node at a rigid external.
  [[nodiscard]] Index nearest(const Axis& its, Index plate, Index external) const;
  /// Largest change of the moments along each axis, relative to the largest of all.
  [[nodiscard]] Eigen::Vector2d change(const Shapes& before, const Shapes& now) const;
  /// Bends with the way back. @param state That in the plane, replaced by the last. @return mismatch by axis.
  Eigen::Vector2d solve_back(const JointEquations& equations, const PathStep& step, Heads heads, JointState& state,
                             Shapes& shapes) const;
  void set(const std::vector<StackLoads>& loads, const Shapes& shapes, const JointState& bent, Heads heads,
           JointState& state) const;

  const JointModel& joint_;
  const JointScene& scene_;
  std::vector<Axis> axes_;
  std::vector<Eigen::VectorXd> K_;  ///< of each plate, bending_concentration at its holes; NaN if not known
};

/// What bending adds to the results of a sheet, and of the joint; none of one without bending.
[[nodiscard]] std::vector<PlateGroup> bending_quantities(const PlateModel& plate);
[[nodiscard]] std::vector<JointGroup> bending_quantities(const JointModel& joint);

}  // namespace fastjoint::stage3
