// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/friction_layout.hpp"

#include <algorithm>

namespace fastjoint::stage3 {
namespace {

/// Adds the friction of a fastener; forces on discs in the other direction follow once both have their columns.
void add_fastener(const JointModel& joint, const FastenerModel& fastener, FrictionLayout& layout) {
  auto& rubbing = layout.rubbing.emplace_back();
  const Index first = std::ssize(layout.columns);
  const bool rubs = std::ranges::any_of(fastener.holes, [](const HoleModel& hole) { return !hole.friction.empty(); });
  for (Index at = 0; rubs && at < std::ssize(fastener.holes); ++at) {
    const HoleModel& hole = fastener.holes[at];
    const Index a = joint.n_directions(), disc = std::ssize(layout.columns) - first;
    for (Index d = 0; d < a; ++d) layout.columns.push_back({hole.plate, -1, hole.disc + d});
    for (Index d = 0; d < a; ++d) {
      RubbingHole& its = rubbing.emplace_back(RubbingHole{at, d, {}, disc + d, {}});
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
  for (const auto& [plate, at, hole] : rim_places(joint)) {
    const PlateModel& its = joint.plates[plate];
    const auto& rim = its.contact[at];
    layout.rim_rubs.push_back(joint.mu(plate, rim.hole) != 0);
    for (Index i = 0; layout.rim_rubs.back() && i < its.waves[at].waves.n_shears(); ++i)
      layout.columns.push_back({plate, its.first_shear(rim) + i, 0});
  }
  return layout;
}

MatrixXd friction_loads(const JointModel& joint, const std::vector<FrictionColumn>& columns, const MatrixXd& Lambda) {
  MatrixXd loads = MatrixXd::Zero(joint.n_unknowns(), Lambda.cols());
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    MatrixXd amounts = MatrixXd::Zero(plate.R.cols(), Lambda.cols());
    for (Index at = 0; at < std::ssize(columns); ++at) {
      if (columns[at].plate != i) continue;
      if (columns[at].case_at >= 0) {
        amounts.row(columns[at].case_at) += Lambda.row(at);
      } else {
        loads.row(joint.offset(i) + columns[at].disc) += Lambda.row(at);
      }
    }
    if (amounts.rows() > 0) loads.middleRows(joint.offset(i), plate.n_unknowns()) += plate.R * amounts;
  }
  return loads;
}

}  // namespace fastjoint::stage3
