// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/bending_feedback.hpp"

#include <algorithm>

#include "stage3_nonlinear/interfaces/friction_layout.hpp"
#include "stage3_nonlinear/model/disc_rows.hpp"

namespace fastjoint::stage3 {

VectorXd shortened(const PlateModel& plate, int axis, const StackSheet& sheet, const VectorXd& integral) {
  const double from = plate.places.support_middle(axis, 0), to = plate.places.support_middle(axis, 1);
  if (to - from > row_tolerance(plate, axis))
    return VectorXd::Zero(integral.size());  // supports hold both ends, and its shortening is a strain
  Index fixed = 0;                           // any node of a sheet without supports, which moves freely
  (sheet.at.array() - from).abs().minCoeff(&fixed);
  return integral[fixed] - integral.array();
}

Index node_at(const PlateModel& plate, Index external, const StackSheet& sheet) {
  Index node = 0;
  (sheet.at.array() - plate.places.external.row(external).mean()).abs().minCoeff(&node);
  return node;
}

BendingFeedback::BendingFeedback(const JointModel& joint, const std::vector<AxisStack>& axes,
                                 const JointEquations& equations)
    : joint_(joint), axes_(axes), equations_(equations) {
  for (const auto& axis : axes) first_.push_back(m_), m_ += std::ssize(axis.stack.links);
  const auto all = loads_of(joint);
  for (Index i = 0; i < std::ssize(all); ++i) {
    if (!equations.parameters.held.displaced[i]) continue;
    const int along = joint.plates[all[i].plate].external_axis[all[i].at];
    const auto axis = std::ranges::find(axes, along, &AxisStack::axis);
    if (axis != axes.end()) loads_.push_back({i, all[i].plate, all[i].at, axis - axes.begin()}), ++m_;
  }
}

VectorXd BendingFeedback::amounts(const StackShapes& shapes) const {
  VectorXd z(m_);
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const SheetStack& stack = axes_[k].stack;
    // The common face of both sheets is half a thickness away from their middles.
    const auto of_row = [&](Index plate, Index row, double sign) {
      const StackSheet& sheet = stack.sheets[plate];
      const Index node = sheet.rows[row];
      const double moved = shortened(joint_.plates[plate], axes_[k].axis, sheet, shapes[k].shortened[plate])[node];
      return sign * moved - sheet.thickness_at(row) / 2 * shapes[k].slope[plate][node];
    };
    for (Index j = 0; j < std::ssize(stack.links); ++j) {
      const StackLink& link = stack.links[j];
      z[first_[k] + j] = of_row(link.lower, link.lower_row, 1);
      if (link.upper >= 0) z[first_[k] + j] += of_row(link.upper, link.upper_row, -1);
    }
  }
  for (Index i = 0; i < std::ssize(loads_); ++i) {
    const auto& [of, plate, external, axis] = loads_[i];
    const StackSheet& sheet = axes_[axis].stack.sheets[plate];
    const PlateModel& model = joint_.plates[plate];
    z[m_ - std::ssize(loads_) + i] =
        shortened(model, axes_[axis].axis, sheet, shapes[axis].shortened[plate])[node_at(model, external, sheet)];
  }
  return z;
}

JointEquations BendingFeedback::displaced(const VectorXd& z) const {
  JointEquations result = equations_;
  const Index a = joint_.n_directions();
  VectorXd &offset = result.parameters.offset, &given = result.parameters.free_given;
  if (offset.size() == 0) offset = VectorXd::Zero(joint_.n_planes() * a);
  if (given.size() == 0) given = VectorXd::Zero(result.parameters.load.size());
  for (std::size_t k = 0; k < axes_.size(); ++k)
    for (Index j = 0; j < joint_.n_planes(); ++j)
      if (const Index link = axes_[k].link_of_plane[j]; link >= 0)
        offset[j * a + axes_[k].direction] += z[first_[k] + link];
  for (Index i = 0; i < std::ssize(loads_); ++i) given[loads_[i].of] += z[m_ - std::ssize(loads_) + i];
  return result;
}

std::vector<JointState> BendingFeedback::responses(const SolvedPoint& point) const {
  const CondensedSystem& system = *equations_.system;
  const double factor = point.load_factor();
  const Index a = joint_.n_directions(), r = equations_.n_unknowns();
  const VectorXd rigid = equations_.rigid_forces(factor), load = equations_.load_at(factor),
                 no_change = equations_.deforming(VectorXd::Zero(r));
  MatrixXd forces(r, m_), loads(load.size(), m_), offsets(r, m_);
  for (Index i = 0; i < m_; ++i) {
    const JointEquations moved = displaced(VectorXd::Unit(m_, i));
    forces.col(i) = moved.rigid_forces(factor) - rigid;
    loads.col(i) = moved.load_at(factor) - load;
    offsets.col(i) = moved.deforming(VectorXd::Zero(r)) - no_change;
  }
  const Slopes slopes = point.slopes(-forces);
  const MatrixXd delta = point.beyond().product(&Response::ddelta, slopes.c),
                 Lambda = point.beyond().friction_by(slopes.c);
  const MatrixXd D = displacements(joint_, system, loads, delta + offsets, Lambda);
  const MatrixXd friction = friction_loads(joint_, system.friction.columns, Lambda);
  std::vector<JointState> all(m_);
  for (Index i = 0; i < m_; ++i) {
    for (const auto& plate : joint_.plates) {
      PlateState& its = all[i].plates.emplace_back();
      its.bearing = its.friction = VectorXd::Zero(plate.n_disc_unknowns());
      its.Pe = VectorXd::Zero(plate.n_externals()), its.traction = VectorXd::Zero(plate.n_tractions());
    }
    for (Index j = 0; j < joint_.n_planes(); ++j) {
      const auto holes = joint_.holes(joint_.planes[j]);
      for (std::size_t side = 0; side < holes.size(); ++side)
        all[i].plates[holes[side].plate].bearing.segment(holes[side].disc, a) +=
            (side == 0 ? -1 : 1) * slopes.F.col(i).segment(j * a, a);
    }
    for (const auto& [of, plate, external, axis] : loads_) {
      const PlateModel& model = joint_.plates[plate];
      const Index first = joint_.offset(plate), row = model.n_disc_unknowns() + external;
      all[i].plates[plate].Pe[external] =
          model.S.row(row).dot(D.col(i).segment(first, model.n_unknowns())) + friction(first + row, i);
    }
    for (std::size_t k = 0; k < joint_.plates.size(); ++k) {
      PlateState& its = all[i].plates[k];
      for (Index e = 0; e < its.Pe.size(); ++e) its.by_supports[joint_.plates[k].external_axis[e]] -= its.Pe[e];
      for (Index d = 0; d < its.bearing.size(); ++d) its.by_supports[joint_.plates[k].axis_of(d)] -= its.bearing[d];
    }
  }
  return all;
}

}  // namespace fastjoint::stage3
