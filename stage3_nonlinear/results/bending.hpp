// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "stage3_nonlinear/model/disc_rows.hpp"
#include "stage3_nonlinear/results/at_increment.hpp"
#include "stage3_nonlinear/results/bending_feedback.hpp"
#include "stage3_nonlinear/strength/axis_stack.hpp"

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
  /// @param point, step The solution; with its tangent, by which the way back is predicted.
  void add(const SolvedPoint& point, const PathStep& step, JointState& state) const;

 private:
  using Shapes = StackShapes;

  /// Forces in the plane of each stack, linear in the state.
  [[nodiscard]] std::vector<StackLoads> loads(const JointState& state) const;
  /// Whether the joint carries load along each axis.
  [[nodiscard]] std::vector<bool> carrying(const std::vector<StackLoads>& loads) const;
  /// Shapes of the stacks along the axes that carry; those of the others are straight.
  [[nodiscard]] Shapes bent(std::vector<StackLoads> loads, const std::vector<bool>& carries, Heads heads) const;
  /// Largest change of the moments along each axis, relative to the largest of all.
  [[nodiscard]] Eigen::Vector2d change(const Shapes& before, const Shapes& now) const;
  /// Loads of the stacks as linear functions of the amounts of the feedback, from which a solution is predicted: those
  /// of the solution in the plane, or of the last with bending.
  struct BentPoint {
    std::optional<SolvedPoint> own;  ///< none: the solution in the plane
    VectorXd z;                      ///< its amounts; none: 0
    std::vector<StackLoads> loads;
    std::vector<std::vector<StackLoads>> slopes;  ///< by each amount; none: not known yet
  };
  /// Amounts with which the shapes are those that they lead to; none if that finds none. @param shapes Are set to
  /// these.
  [[nodiscard]] std::optional<VectorXd> predicted(const BentPoint& from, const BendingFeedback& feedback,
                                                  const std::vector<bool>& carries, Heads heads, Shapes& shapes) const;
  /// Bends with the way back. @param near Where it starts; set where one solution from there is not enough.
  /// @param state Is set to the joint with bending; none if it was not solved. @return Mismatch by axis.
  Eigen::Vector2d solve_back(const SolvedPoint& point, const PathStep& step, double largest_force,
                             const std::vector<bool>& carries, Heads heads, BentPoint& near,
                             std::optional<JointState>& state, Shapes& shapes) const;
  /// Sets what follows from the shapes. @param in_plane Loads of the solution in the plane. @param bent The joint with
  /// bending. @param state The solution in the plane.
  void set(const std::vector<StackLoads>& in_plane, const Shapes& shapes, const JointState& bent, Heads heads,
           JointState& state) const;
  /// Sets the rows of a plate along the axis k.
  void set_rows(Index k, Index at, const StackLoads& loads, const StackShape& shape, Heads heads,
                PlateBending& bending) const;
  /// Sets a hole of a plate by the moments there.
  void set_hole(Index at, Index hole, const std::vector<StackLoads>& in_plane, const Shapes& shapes,
                const HoleState& state, Heads heads, PlateBending& bending) const;

  const JointModel& joint_;
  const JointScene& scene_;
  std::vector<AxisStack> axes_;
  std::vector<MatrixXd> K_;  ///< of each plate, bending_concentration and Poisson's ratio at its holes
};

/// What bending adds to the results of a sheet, and of the joint; none of one without bending.
[[nodiscard]] std::vector<PlateGroup> bending_quantities(const PlateModel& plate);
[[nodiscard]] std::vector<JointGroup> bending_quantities(const JointModel& joint);

}  // namespace fastjoint::stage3
