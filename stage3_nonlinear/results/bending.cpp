// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/bending.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/infinite.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/bending_feedback.hpp"
#include "stage3_nonlinear/results/row_forces.hpp"
#include "stage3_nonlinear/strength/hole_bending.hpp"

namespace fastjoint::stage3 {
namespace {

/// Forces of the fasteners on a disc.
double force_on(const PlateState& plate, Index disc) { return plate.bearing[disc] + plate.friction[disc]; }

/// Mean stress of a sheet on a side of a node, 0 before it, 1 behind it; 0 beyond its end.
double gross_stress(const StackSheet& sheet, const VectorXd& N, Index node, int side) {
  const Index segment = sheet.beside(node, side);
  return segment < 0 ? 0 : N[segment] / (sheet.width[segment] * sheet.thickness[segment]);
}

/// The side of a node on which the sheet is more loaded; of equal ones that before it.
int more_loaded_side(const StackSheet& sheet, const VectorXd& N, Index node) {
  constexpr double equal = 1 + 1e-9;
  const double before = std::abs(gross_stress(sheet, N, node, 0)), behind = std::abs(gross_stress(sheet, N, node, 1));
  return behind > equal * before ? 1 : 0;
}

/// Stress on the lower face of a sheet under a moment on a side of a node; 0 beyond its end.
double bending_stress(const StackSheet& sheet, Index node, int side, double moment) {
  const Index segment = sheet.beside(node, side);
  return segment < 0 ? 0 : 6 * moment / (sheet.width[segment] * sheet.thickness[segment] * sheet.thickness[segment]);
}

/// Concentration of bending and Poisson's ratio at each hole of a plate, (r, 2); NaN where they are not known.
MatrixXd concentrations(const PlateModel& plate) {
  const formats::PlateStresses& a = plate.stresses;
  MatrixXd all = MatrixXd::Constant(plate.stress_level ? std::ssize(a.rim_hole) : 0, 2, std::nan(""));
  for (Index i = 0; i < all.rows(); ++i)
    for (const auto& rim : plate.waves)
      if (rim.hole == a.rim_hole[i] && rim.has_closed_form() && a.rim_thickness[i] > 0) {
        const double nu = -rim.compliance(0, 1) / rim.compliance(0, 0);
        all.row(i) << bending_concentration(a.rim_radius[i] / a.rim_thickness[i], nu), nu;
      }
  return all;
}

}  // namespace

Bending::Bending(const JointModel& joint, const JointScene& scene)
    : joint_(joint), scene_(scene), axes_(axis_stacks(joint, scene)) {
  for (const auto& plate : joint.plates) K_.push_back(concentrations(plate));
}

std::vector<StackLoads> Bending::loads(const JointState& state) const {
  std::vector<StackLoads> all;
  for (const AxisStack& its : axes_) {
    StackLoads& loads = all.emplace_back();
    for (Index i = 0; i < std::ssize(joint_.plates); ++i)
      loads.N.push_back(tensions(joint_.plates[i], its.axis, state.plates[i], its.stack.sheets[i].middles()));
    loads.q = VectorXd::Zero(std::ssize(its.stack.links));
    for (Index j = 0; j < joint_.n_planes(); ++j) {
      if (its.link_of_plane[j] < 0) continue;
      const ShearPlane& plane = joint_.planes[j];
      const auto& holes = joint_.fasteners[plane.fastener].holes;
      for (Index k = 0; k <= plane.first; ++k)  // what the plane passes on balances all sheets below
        loads.q[its.link_of_plane[j]] += force_on(state.plates[holes[k].plate], holes[k].disc + its.direction);
    }
  }
  return all;
}

std::vector<bool> Bending::carrying(const std::vector<StackLoads>& all) const {
  constexpr double little = 0.05;  // of the forces along the other axis: contraction makes them, no load
  double largest = 0;
  for (const auto& each : all) largest = std::max(largest, each.q.lpNorm<Eigen::Infinity>());
  std::vector<bool> result;
  for (const auto& each : all) result.push_back(each.q.lpNorm<Eigen::Infinity>() > little * largest);
  return result;
}

Bending::Shapes Bending::bent(std::vector<StackLoads> all, const std::vector<bool>& carries, Heads heads) const {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!carries[i]) {
      all[i].q.setZero();
      for (auto& N : all[i].N) N.setZero();
    }
  Shapes shapes;
  for (std::size_t i = 0; i < axes_.size(); ++i) shapes.push_back(axes_[i].stack.bend(all[i], heads == clamped_heads));
  return shapes;
}

Eigen::Vector2d Bending::change(const Shapes& before, const Shapes& now) const {
  Eigen::Vector2d all = Eigen::Vector2d::Zero();
  double largest = 0;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    for (std::size_t k = 0; k < now[i].moment.size(); ++k) {
      const MatrixXd &a = before[i].moment[k], &b = now[i].moment[k];
      if (b.size() == 0) continue;
      largest = std::max(largest, b.lpNorm<Eigen::Infinity>());
      double& its = all[axes_[i].axis];
      its = std::max(its, (b - a).lpNorm<Eigen::Infinity>());
    }
  return largest > 0 ? Eigen::Vector2d(all / largest) : all;
}

std::optional<VectorXd> Bending::predicted(const BentPoint& from, const BendingFeedback& feedback,
                                           const std::vector<bool>& carries, Heads heads, Shapes& shapes) const {
  constexpr int most = 30, most_halvings = 10;
  constexpr double enough = 1e-2, step = 1e-6;            // of the mismatch allowed; of the amounts, for differences
  const auto left = [&](const VectorXd& z) -> VectorXd {  // G(z) - z
    std::vector<StackLoads> loads = from.loads;
    for (Index k = 0; k < z.size(); ++k)
      for (std::size_t axis = 0; axis < loads.size(); ++axis) {
        const StackLoads& by = from.slopes[k][axis];
        loads[axis].q += (z[k] - from.z[k]) * by.q;
        for (std::size_t sheet = 0; sheet < by.N.size(); ++sheet)
          loads[axis].N[sheet] += (z[k] - from.z[k]) * by.N[sheet];
      }
    shapes = bent(std::move(loads), carries, heads);
    return feedback.amounts(shapes) - z;
  };
  VectorXd z = from.z, r = left(z);
  const double scale = r.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < most; ++i) {
    if (!r.allFinite()) return std::nullopt;
    const double size = std::max(z.lpNorm<Eigen::Infinity>(), scale);
    if (r.lpNorm<Eigen::Infinity>() <= enough * scene_.bending.mismatch * size) return z;
    MatrixXd J(z.size(), z.size());
    for (Index k = 0; k < z.size(); ++k)
      J.col(k) = (left(z + step * size * VectorXd::Unit(z.size(), k)) - r) / (step * size);
    VectorXd change = -J.partialPivLu().solve(r), next = left(z + change);
    for (int halvings = 0; !(next.norm() < r.norm()); ++halvings) {
      if (halvings == most_halvings) return std::nullopt;
      change /= 2, next = left(z + change);
    }
    z += change, r = std::move(next);
  }
  return std::nullopt;
}

Eigen::Vector2d Bending::solve_back(const SolvedPoint& point, const PathStep& step, double largest_force,
                                    const std::vector<bool>& carries, Heads heads, BentPoint& near,
                                    std::optional<JointState>& state, Shapes& shapes) const {
  constexpr int most = 10;
  constexpr double negligible = 0.1;  // of the mismatch allowed
  const double factor = point.load_factor();
  const BendingFeedback feedback(joint_, axes_, point.equations());
  const VectorXd z = feedback.amounts(shapes), in_plane = point.equations().rigid_forces(factor);
  if (!z.allFinite()) return Eigen::Vector2d::Constant(infinite);
  const auto by_bending = [&](const VectorXd& at) -> VectorXd {
    return feedback.displaced(at).rigid_forces(factor) - in_plane;
  };
  if (by_bending(z).lpNorm<Eigen::Infinity>() <= negligible * scene_.bending.mismatch * largest_force) {
    state = joint_state(joint_, feedback.displaced(z), step, false);  // moved, under the same forces
    return Eigen::Vector2d::Zero();
  }
  const PathOptions options{scene_.initial, scene_.solver};
  Eigen::Vector2d mismatch = Eigen::Vector2d::Constant(infinite);
  if (near.z.size() == 0) near.z = VectorXd::Zero(z.size());
  for (int i = 0; i < most; ++i) {
    const SolvedPoint& now = near.own ? *near.own : point;
    if (near.slopes.empty())
      for (const JointState& each : feedback.responses(now)) near.slopes.push_back(loads(each));
    Shapes expected;
    const auto next = predicted(near, feedback, carries, heads, expected);
    if (!next) return Eigen::Vector2d::Constant(infinite);
    const VectorXd change_of_c = now.slopes(-by_bending(*next - near.z)).c;
    JointEquations displaced = feedback.displaced(*next);
    Walk walk(displaced, options);
    if (!(change_of_c.allFinite() && walk.jump({factor, now.c() + change_of_c})) && !walk.jump({factor, now.c()}))
      return Eigen::Vector2d::Constant(infinite);
    state = joint_state(joint_, displaced, walk.unchecked_step(), false);
    const auto bent_loads = loads(*state);
    shapes = bent(bent_loads, carries, heads);
    mismatch = change(expected, shapes);
    if (mismatch.maxCoeff() <= scene_.bending.mismatch) return mismatch;
    near.own.emplace(std::move(displaced), factor, walk.here().c);
    near.z = *next, near.loads = bent_loads, near.slopes.clear();
  }
  return mismatch;
}

void Bending::set_rows(Index k, Index at, const StackLoads& loads, const StackShape& shape, Heads heads,
                       PlateBending& bending) const {
  const StackSheet& sheet = axes_[k].stack.sheets[at];
  for (Index row = 0; row < std::ssize(sheet.rows); ++row) {
    const Index of_all = axes_[k].first_row[at] + row, node = sheet.rows[row];
    const int loaded = more_loaded_side(sheet, loads.N[at], node);
    for (const int side : {0, 1}) bending.moment(of_all, 2 * side + heads) = shape.moment[at](node, side);
    const double gross = gross_stress(sheet, loads.N[at], node, loaded);
    const double bent = bending_stress(sheet, node, loaded, shape.moment[at](node, loaded));
    bending.k_b(of_all, heads) = gross == 0 ? 0 : std::abs(bent / gross);
    bending.deflection(of_all, heads) = shape.w[at][node];
  }
  for (Index j = 0; heads == free_heads && j < std::ssize(shape.pressed); ++j) {
    const StackLink& link = axes_[k].stack.links[j];
    for (const auto& [plate, row] : {std::pair(link.lower, link.lower_row), std::pair(link.upper, link.upper_row)})
      if (plate == at && shape.pressed[j]) bending.pressed[axes_[k].first_row[at] + row] = 1;
  }
  // Loads along the axis open cracks that grow across it.
  for (Index t = 0; t < bending.at_tip.rows() && !sheet.rows.empty(); ++t) {
    const pfem::CrackTip& tip = joint_.plates[at].cracks.tips[t];
    if ((std::abs(std::sin(tip.angle)) > std::abs(std::cos(tip.angle))) != (axes_[k].axis == 0)) continue;
    Index row = 0;
    (sheet.at(sheet.rows).array() - tip.at[axes_[k].axis]).abs().minCoeff(&row);
    bending.at_tip(t, heads) = bending.k_b(axes_[k].first_row[at] + row, heads);
  }
}

void Bending::set_hole(Index at, Index hole, const std::vector<StackLoads>& in_plane, const Shapes& shapes,
                       const HoleState& state, Heads heads, PlateBending& bending) const {
  const PlateModel& plate = joint_.plates[at];
  std::array<std::array<double, 2>, 2> lower{}, upper{};  // along x and y, before and behind the hole
  for (std::size_t k = 0; k < axes_.size(); ++k) {
    const StackSheet& sheet = axes_[k].stack.sheets[at];
    const int axis = axes_[k].axis;
    Index node = 0;
    (sheet.at.array() - plate.stresses.rim_center(hole, axis)).abs().minCoeff(&node);
    // The strip of a hole may carry more than the mean of the sheet.
    const VectorXd& N = in_plane[k].N[at];
    const double strip = state.gross_stress[axis],
                 gross = gross_stress(sheet, N, node, more_loaded_side(sheet, N, node));
    const double share = std::isfinite(strip) && std::isfinite(gross) && gross != 0 ? std::abs(strip / gross) : 1;
    for (const int side : {0, 1}) {
      lower[axis][side] = share * bending_stress(sheet, node, side, shapes[k].moment[at](node, side));
      upper[axis][side] = -lower[axis][side];
    }
  }
  const auto on_lower = peak_with_bending(state.hoop, lower, K_[at](hole, 0), K_[at](hole, 1)),
             on_upper = peak_with_bending(state.hoop, upper, K_[at](hole, 0), K_[at](hole, 1));
  bending.lower(hole, heads) = on_lower.value, bending.lower_angle(hole, heads) = on_lower.angle;
  bending.upper(hole, heads) = on_upper.value, bending.upper_angle(hole, heads) = on_upper.angle;
  double& largest = bending.stress(hole, heads) = 0;
  for (const auto& along : on_upper.value > on_lower.value ? upper : lower)
    for (const double each : along) largest = std::isnan(each) ? each : std::max(largest, each);
}

void Bending::set(const std::vector<StackLoads>& in_plane, const Shapes& shapes, const JointState& bent, Heads heads,
                  JointState& state) const {
  const auto bent_loads = loads(bent);
  for (Index at = 0; at < std::ssize(joint_.plates); ++at) {
    const PlateState& its = bent.plates[at];
    PlateBending& bending = state.plates[at].bending;
    bending.computed[heads] = true;
    bending.De.col(heads) += its.De, bending.Pe.col(heads) = its.Pe;
    for (Index k = 0; k < std::ssize(axes_); ++k) {
      for (Index i = 0; i < its.De.size() && scene_.bending.way_back; ++i)
        if (const StackSheet& sheet = axes_[k].stack.sheets[at]; joint_.plates[at].external_axis[i] == axes_[k].axis)
          bending.De(i, heads) += shortened(joint_.plates[at], axes_[k].axis, sheet,
                                            shapes[k].shortened[at])[node_at(joint_.plates[at], i, sheet)];
      set_rows(k, at, bent_loads[k], shapes[k], heads, bending);
    }
    for (Index hole = 0; hole < bending.stress.rows(); ++hole)
      set_hole(at, hole, in_plane, shapes, state.plates[at].rims[hole], heads, bending);
  }
  state.bent_transferred.col(heads) = bent.transferred_first;
}

void Bending::add(const SolvedPoint& point, const PathStep& step, JointState& state) const {
  if (axes_.empty()) return;
  state.bending_mismatch.setConstant(2, 2, std::nan(""));
  for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
    const PlateModel& plate = joint_.plates[i];
    PlateBending& its = state.plates[i].bending;
    its = {std::ssize(disc_rows(plate)), std::ssize(state.plates[i].rims), plate.n_externals(),
           std::ssize(plate.cracks.tips)};
    for (const Heads heads : scene_.bending.heads) its.De.col(heads) = point.equations().parameters.free[i].De;
  }
  state.bent_transferred.setConstant(joint_.n_planes(), 2, std::nan(""));
  const auto in_plane = loads(state);
  const auto carries = carrying(in_plane);
  BentPoint near{{}, {}, in_plane, {}};
  for (const Heads heads : scene_.bending.heads) {
    std::optional<JointState> solved;
    Shapes shapes = bent(in_plane, carries, heads);
    if (scene_.bending.way_back) {
      auto mismatch = state.bending_mismatch.col(heads);
      const Eigen::Vector2d found = solve_back(point, step, state.largest_force, carries, heads, near, solved, shapes);
      for (const AxisStack& its : axes_) mismatch[its.axis] = found[its.axis];
    }
    set(in_plane, shapes, solved ? *solved : state, heads, state);
    if (state.bending_mismatch.col(heads).array().isInf().any())
      state.no_bending = "the joint was not solved with the sheets displaced by it, so that it acts one way alone";
    for (const auto& shape : shapes)
      if (shape.buckles)
        state.no_bending = "compression makes the sheets buckle between rows";
      else if (!shape.is_known)
        state.no_bending = "forces act along a sheet on an edge beside its rows, so that its tension is not known";
  }
}

}  // namespace fastjoint::stage3
