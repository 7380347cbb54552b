// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/columns/column.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// A joint at an increment that was solved: what its quantities are computed from.
struct JointAt {
  const JointModel& joint;
  const JointEquations& equations;
  const PathStep& step;
  const JointState& state;
  Index increment;  ///< of the path, from 0
};

/// One of its plates.
struct PlateAt {
  const JointAt& of;
  Index plate;

  [[nodiscard]] const PlateModel& model() const { return of.joint.plates[plate]; }
  [[nodiscard]] const PlateState& state() const { return of.state.plates[plate]; }
  [[nodiscard]] const FreeShape& free() const { return of.equations.parameters.free[plate]; }
};

using JointGroup = columns::Group<JointAt>;
using PlateGroup = columns::Group<PlateAt>;

/// Matrix of columns of equal length.
[[nodiscard]] inline MatrixXd side_by_side(const std::vector<VectorXd>& columns) {
  MatrixXd all(columns.empty() ? 0 : columns[0].size(), std::ssize(columns));
  for (Index i = 0; i < all.cols(); ++i) all.col(i) = columns[i];
  return all;
}

}  // namespace fastjoint::stage3
