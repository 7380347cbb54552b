// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/friction_layout.hpp"

#include <algorithm>

namespace fastjoint::stage3 {
namespace {

/// Adds the friction columns of a fastener: for each hole those of its discs, then those of its friction cases.
void add_fastener(const JointModel& joint, const FastenerModel& fastener, FrictionLayout& layout) {
  auto& friction = layout.friction_holes.emplace_back();
  const Index first = std::ssize(layout.columns);
  const bool has_friction =
      std::ranges::any_of(fastener.holes, [](const HoleModel& hole) { return !hole.friction.empty(); });
  for (Index at = 0; has_friction && at < std::ssize(fastener.holes); ++at) {
    const HoleModel& hole = fastener.holes[at];
    const Index a = joint.n_directions(), disc = std::ssize(layout.columns) - first;
    for (Index d = 0; d < a; ++d) layout.columns.push_back({hole.plate, -1, hole.disc + d});
    for (Index d = 0; d < a; ++d) {
      FrictionHole& its = friction.emplace_back(FrictionHole{at, d, {}, disc + d, {}});
      if (a > 1) its.other_disc = disc + 1 - d;
      for (const Side side : {plus_side, minus_side}) {
        if (hole.friction.empty() || hole.friction[d][side].column < 0) continue;
        its.sides[side] = hole.friction[d][side];
        its.sides[side].column = std::ssize(layout.columns) - first;
        layout.columns.push_back({hole.plate, hole.friction[d][side].column, 0});
      }
    }
  }
  layout.n_columns.push_back(std::ssize(layout.columns) - first);
}

}  // namespace

FrictionLayout friction_layout(const JointModel& joint) {
  FrictionLayout layout;
  for (const auto& fastener : joint.fasteners) add_fastener(joint, fastener, layout);
  for (const auto& [plate, at, hole, has_friction] : rim_places(joint)) {
    const PlateModel& its = joint.plates[plate];
    const auto& rim = its.contact[at];
    for (Index i = 0; has_friction && i < its.waves[at].waves.n_shears(); ++i)
      layout.columns.push_back({plate, its.first_shear(rim) + i, 0});
  }
  return layout;
}

MatrixXd friction_loads(const JointModel& joint, const std::vector<FrictionColumn>& columns, const MatrixXd& Lambda) {
  MatrixXd loads = MatrixXd::Zero(joint.n_unknowns(), Lambda.cols());
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    MatrixXd coefficients = MatrixXd::Zero(plate.R.cols(), Lambda.cols());
    for (Index at = 0; at < std::ssize(columns); ++at) {
      if (columns[at].plate != i) continue;
      if (columns[at].case_at >= 0) {
        coefficients.row(columns[at].case_at) += Lambda.row(at);
      } else {
        loads.row(joint.offset(i) + columns[at].disc) += Lambda.row(at);
      }
    }
    if (coefficients.rows() > 0) loads.middleRows(joint.offset(i), plate.n_unknowns()) += plate.R * coefficients;
  }
  return loads;
}

}  // namespace fastjoint::stage3
