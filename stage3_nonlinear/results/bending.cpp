// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/bending.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/infinite.hpp"
#include "stage3_nonlinear/path/walk.hpp"
#include "stage3_nonlinear/results/row_forces.hpp"
#include "stage3_nonlinear/strength/hole_bending.hpp"

namespace fastjoint::stage3 {
namespace {

/// Forces of the fasteners on a disc.
double force_on(const PlateState& plate, Index disc) { return plate.bearing[disc] + plate.friction[disc]; }

/// Fixed point of y = G(y) by Anderson's method: the next y from all before.
class FixedPoint {
 public:
  VectorXd next(const VectorXd& y, const VectorXd& G) {
    const VectorXd r = G - y;
    VectorXd result = G;
    if (!r_.empty()) {
      dr_.conservativeResize(r.size(), dr_.cols() + 1), dG_.conservativeResize(r.size(), dG_.cols() + 1);
      dr_.rightCols(1) = r - r_.back(), dG_.rightCols(1) = G - G_;
      result -= dG_ * dr_.completeOrthogonalDecomposition().solve(r);
    }
    r_.assign(1, r), G_ = G;
    return result;
  }

 private:
  std::vector<VectorXd> r_;  ///< the last
  VectorXd G_;
  MatrixXd dr_{0, 0}, dG_{0, 0};
};

/// Concentration of bending at each hole of a plate; NaN where thickness or Poisson's ratio are not known.
VectorXd concentrations(const PlateModel& plate) {
  const formats::PlateStresses& a = plate.stresses;
  VectorXd K = VectorXd::Constant(plate.stress_level ? std::ssize(a.rim_hole) : 0, std::nan(""));
  for (Index i = 0; i < K.size(); ++i)
    for (const auto& rim : plate.waves)
      if (rim.hole == a.rim_hole[i] && rim.has_closed_form() && a.rim_thickness[i] > 0)
        K[i] =
            bending_concentration(a.rim_radius[i] / a.rim_thickness[i], -rim.compliance(0, 1) / rim.compliance(0, 0));
  return K;
}

}  // namespace

Bending::Bending(const JointModel& joint, const JointScene& scene) : joint_(joint), scene_(scene) {
  if (!joint.plates.front().bends) return;
  check_order();
  for (Index d = 0; d < joint.n_directions(); ++d) add_axis(d);
  for (const auto& plate : joint.plates) K_.push_back(concentrations(plate));
}

/// Sheets follow from lowest to highest as fasteners name them; a sheet above itself is a contradiction.
void Bending::check_order() const {
  const Index n = std::ssize(joint_.plates);
  Eigen::MatrixXi above = Eigen::MatrixXi::Zero(n, n);
  for (const auto& plane : joint_.planes) {
    if (joint_.is_to_ground(plane)) continue;
    const Index lower = joint_.first_hole(plane).plate, upper = joint_.second_hole(plane).plate;
    above(lower, upper) = 1;
    for (Index i = 0; i < n; ++i)  // all below the lower are below all above the upper
      for (Index k = 0; k < n; ++k)
        if ((i == lower || above(i, lower) != 0) && (k == upper || above(upper, k) != 0)) above(i, k) = 1;
    if (above.diagonal().isZero()) continue;
    refuse(scene_.fasteners[plane.fastener].where + "/between",
           fmt::format("\"{}\" below \"{}\", against the order of fasteners before", joint_.plates[lower].name,
                       joint_.plates[upper].name),
           "the holes of every fastener from the lowest sheet to the highest, or \"bending\": \"none\"");
  }
}

StackSheet Bending::sheet(const PlateModel& plate, int axis, Index& first_row) const {
  const double tolerance = row_tolerance(plate, axis);
  std::vector<std::pair<double, bool>> nodes;  // coordinates, and whether a row is there
  const auto rows = disc_rows(plate);
  first_row = -1;
  for (Index i = 0; i < std::ssize(rows); ++i) {
    if (rows[i].axis != axis) continue;
    if (first_row < 0) first_row = i;
    nodes.emplace_back(rows[i].at, true);
  }
  const auto add = [&](double at) {
    const auto is_there = [&](const auto& node) { return std::abs(node.first - at) <= tolerance; };
    if (std::ranges::none_of(nodes, is_there)) nodes.emplace_back(at, false);
  };
  std::vector<formats::Bay> bays;
  for (const auto& bay : plate.bays)
    if (bay.direction == rim::axis_names[axis]) bays.push_back(bay);
  for (const auto& bay : bays) add(bay.from), add(bay.to);
  for (Index i = 0; i < plate.n_externals(); ++i)
    if (plate.external_axis[i] == axis) add(plate.places.external.row(i).mean());
  for (Index i = 0; i < plate.n_tractions(); ++i)
    if (plate.traction_axis[i] == axis && !plate.is_moment(i)) add(plate.places.traction.row(i).mean());
  std::ranges::sort(nodes);
  StackSheet sheet;
  const Index n = std::ssize(nodes);
  sheet.at.resize(n), sheet.EI.resize(n - 1), sheet.width.resize(n - 1), sheet.thickness.resize(n - 1);
  for (Index i = 0; i < n; ++i) {
    sheet.at[i] = nodes[i].first;
    if (nodes[i].second) sheet.rows.push_back(i);
    if (i == 0) continue;
    const double middle = (nodes[i - 1].first + nodes[i].first) / 2;
    const auto found = std::ranges::find_if(bays, [&](const auto& bay) { return middle < bay.to; });
    const formats::Bay& bay = found == bays.end() ? bays.back() : *found;
    sheet.EI[i - 1] = bay.bending, sheet.width[i - 1] = bay.width, sheet.thickness[i - 1] = bay.thickness;
  }
  const auto given = scene_.bending.ends.find(plate.name);
  for (const int end : {0, 1}) {
    const bool is_held = end == 0 ? bays.front().held_from != 0 : bays.back().held_to != 0;
    const auto its = given == scene_.bending.ends.end() ? std::nullopt : given->second[2 * axis + end];
    sheet.ends[end] = its.value_or(is_held ? EndHold::hinged : EndHold::free);
  }
  return sheet;
}

void Bending::add_axis(Index direction) {
  Axis its{direction, joint_.axes[direction], {}, {}, {}};
  std::vector<std::vector<DiscRow>> rows;
  for (const auto& plate : joint_.plates) {
    its.stack.sheets.push_back(sheet(plate, its.axis, its.first_row.emplace_back()));
    rows.push_back(disc_rows(plate));
  }
  const auto row_of = [&](const HoleModel& hole) {
    const auto& all = rows[hole.plate];
    const auto found = std::ranges::find_if(
        all, [&](const DiscRow& row) { return std::ranges::count(row.discs, hole.disc + direction) > 0; });
    return found == all.end() ? -1 : found - all.begin() - its.first_row[hole.plate];
  };
  for (const auto& plane : joint_.planes) {
    const HoleModel& first = joint_.first_hole(plane);
    StackLink link{first.plate, row_of(first), -1, -1};
    if (!joint_.is_to_ground(plane)) {
      const HoleModel& second = joint_.second_hole(plane);
      link.upper = second.plate, link.upper_row = row_of(second);
    }
    auto& links = its.stack.links;
    const bool moves = link.lower_row >= 0 && (link.upper < 0 || link.upper_row >= 0);
    const Index at = std::ranges::find(links, link) - links.begin();
    if (moves && at == std::ssize(links)) links.push_back(link);
    its.link_of_plane.push_back(moves ? at : -1);
  }
  axes_.push_back(std::move(its));
}

std::vector<StackLoads> Bending::loads(const JointState& state) const {
  std::vector<StackLoads> all;
  for (const Axis& its : axes_) {
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
  constexpr double little = 0.01;  // of the forces along the other axis: the joint carries no load along this one
  double largest = 0;
  for (const auto& each : all) largest = std::max(largest, each.q.lpNorm<Eigen::Infinity>());
  for (auto& each : all)
    if (each.q.lpNorm<Eigen::Infinity>() <= little * largest) {
      each.q.setZero();
      for (auto& N : each.N) N.setZero();
    }
  return all;
}

Bending::Shapes Bending::bent(const std::vector<StackLoads>& loads, Heads heads) const {
  Shapes shapes;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    shapes.push_back(axes_[i].stack.bend(loads[i], heads == clamped_heads));
  return shapes;
}

VectorXd Bending::shortened(const Axis& its, const Shapes& shapes, Index at, Index plate) const {
  const VectorXd& all = shapes[at].shortened[plate];
  const auto& places = joint_.plates[plate].places;
  const double from = places.support_middle(its.axis, 0), to = places.support_middle(its.axis, 1);
  const VectorXd& x = its.stack.sheets[plate].at;
  if (to - from > row_tolerance(joint_.plates[plate], its.axis))
    return VectorXd::Zero(all.size());  // supports hold both ends, and its shortening is a strain
  Index fixed = 0;
  if (places.support.row(its.axis).squaredNorm() > 0 || from != 0) (x.array() - from).abs().minCoeff(&fixed);
  return (all[fixed] - all.array()).matrix();
}

Index Bending::nearest(const Axis& its, Index plate, Index external) const {
  Index node = 0;
  (its.stack.sheets[plate].at.array() - joint_.plates[plate].places.external.row(external).mean())
      .abs()
      .minCoeff(&node);
  return node;
}

VectorXd Bending::displaced(const Shapes& shapes, const JointEquations& equations) const {
  const Index a = joint_.n_directions(), n = joint_.n_planes() * a;
  const auto places = loads_of(joint_);
  VectorXd all = VectorXd::Zero(n + std::ssize(places));
  for (Index at = 0; at < std::ssize(axes_); ++at) {
    const Axis& its = axes_[at];
    std::vector<VectorXd> moved;
    for (Index i = 0; i < std::ssize(joint_.plates); ++i) moved.push_back(shortened(its, shapes, at, i));
    // The common face of both sheets is half a thickness away from their middles.
    const auto of_row = [&](Index plate, Index row, double sign) {
      const StackSheet& sheet = its.stack.sheets[plate];
      const Index node = sheet.rows[row];
      return sign * moved[plate][node] - sheet.thickness_at(row) / 2 * shapes[at].slope[plate][node];
    };
    for (Index j = 0; j < joint_.n_planes(); ++j) {
      if (its.link_of_plane[j] < 0) continue;
      const StackLink& link = its.stack.links[its.link_of_plane[j]];
      double& offset = all[j * a + its.direction];
      offset = of_row(link.lower, link.lower_row, 1);
      if (link.upper >= 0) offset += of_row(link.upper, link.upper_row, -1);
    }
    for (Index i = 0; i < std::ssize(places); ++i) {
      const auto& [plate, external, is_traction] = places[i];
      if (equations.parameters.held.displaced[i] && joint_.plates[plate].external_axis[external] == its.axis)
        all[n + i] = moved[plate][nearest(its, plate, external)];
    }
  }
  return all;
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

Eigen::Vector2d Bending::solve_back(const JointEquations& equations, const PathStep& step, Heads heads,
                                    JointState& state, Shapes& shapes) const {
  constexpr int most = 30;
  constexpr double negligible = 0.1;  // of the mismatch allowed
  const Index n = joint_.n_planes() * joint_.n_directions();
  const VectorXd in_plane = equations.rigid_forces(step.load_factor);
  const PathOptions options{scene_.initial, scene_.solver};
  Eigen::Vector2d mismatch = Eigen::Vector2d::Constant(infinite);
  FixedPoint search;
  JointEquations now = equations;
  Parameters& its = now.parameters;
  const Parameters& given = equations.parameters;
  VectorXd y = displaced(shapes, equations), c = step.c;
  for (int i = 0; i < most && y.allFinite(); ++i) {
    its.offset = given.offset.size() > 0 ? VectorXd(given.offset + y.head(n)) : y.head(n);
    its.free_given =
        given.free_given.size() > 0 ? VectorXd(given.free_given + y.tail(y.size() - n)) : y.tail(y.size() - n);
    const VectorXd by_bending = now.rigid_forces(step.load_factor) - in_plane;
    if (i == 0 && by_bending.lpNorm<Eigen::Infinity>() <= negligible * scene_.bending.mismatch * state.largest_force)
      return Eigen::Vector2d::Zero();
    Walk walk(now, options);
    if (!walk.jump({step.load_factor, c})) return Eigen::Vector2d::Constant(infinite);
    const PathStep reached = walk.step();
    c = reached.c;
    state = joint_state(joint_, now, reached);
    Shapes next = bent(loads(state), heads);
    mismatch = change(shapes, next);
    shapes = std::move(next);
    if (mismatch.maxCoeff() <= scene_.bending.mismatch) return mismatch;
    y = search.next(y, displaced(shapes, equations));
  }
  return mismatch;
}

void Bending::set(const std::vector<StackLoads>& loads, const Shapes& shapes, const JointState& bent, Heads heads,
                  JointState& state) const {
  for (Index at = 0; at < std::ssize(joint_.plates); ++at) {
    const formats::PlateStresses& a = joint_.plates[at].stresses;
    const PlateState& its = bent.plates[at];
    PlateBending& bending = state.plates[at].bending;
    bending.De.col(heads) += its.De, bending.Pe.col(heads) = its.Pe;
    for (Index k = 0; k < std::ssize(axes_) && scene_.bending.way_back; ++k)
      for (Index i = 0; i < its.De.size(); ++i)
        if (joint_.plates[at].external_axis[i] == axes_[k].axis)
          bending.De(i, heads) += shortened(axes_[k], shapes, k, at)[nearest(axes_[k], at, i)];
    // Stress on the lower face along x and y, before and behind its row, of each hole.
    std::vector<std::array<std::array<double, 2>, 2>> lower(bending.stress.rows());
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const Axis& axis = axes_[k];
      const StackSheet& sheet = axis.stack.sheets[at];
      for (Index row = 0; row < std::ssize(sheet.rows); ++row) {
        const Index of_all = axis.first_row[at] + row, node = sheet.rows[row];
        double gross = 0;  // of the more loaded side
        Eigen::Vector2d stress = Eigen::Vector2d::Zero();
        for (const int side : {0, 1}) {
          const double M = bending.moment(of_all, 2 * side + heads) = shapes[k].moment[at](row, side);
          const Index segment = sheet.beside(row, side);
          if (segment < 0) continue;
          const double t = sheet.thickness[segment], area = sheet.width[segment] * t;
          stress[side] = 6 * M / (area * t);
          const double N = loads[k].N[at][segment] / area;
          if (std::abs(N) > std::abs(gross) * (1 + 1e-9)) {
            gross = N;
            bending.k_b(of_all, heads) = std::abs(stress[side] / N);
          }
        }
        if (gross == 0) bending.k_b(of_all, heads) = 0;
        bending.deflection(of_all, heads) = shapes[k].w[at][node];
        for (Index i = 0; i < std::ssize(lower); ++i) {
          if (std::abs(a.rim_center(i, axis.axis) - sheet.at[node]) > row_tolerance(joint_.plates[at], axis.axis))
            continue;
          // The strip of a hole may carry more than the mean of the sheet.
          const double strip = its.rims[i].gross_stress[axis.axis];
          const double share = std::isfinite(strip) && gross != 0 ? std::abs(strip / gross) : 1;
          for (const int side : {0, 1}) lower[i][axis.axis][side] = share * stress[side];
        }
      }
      for (Index j = 0; heads == free_heads && j < std::ssize(shapes[k].pressed); ++j) {
        const StackLink& link = axis.stack.links[j];
        for (const auto& [plate, row] : {std::pair(link.lower, link.lower_row), std::pair(link.upper, link.upper_row)})
          if (plate == at && shapes[k].pressed[j]) bending.pressed[axis.first_row[at] + row] = 1;
      }
    }
    for (Index i = 0; i < std::ssize(lower); ++i) {
      auto upper = lower[i];
      for (auto& along : upper)
        for (double& each : along) each = -each;
      const auto on_lower = peak_with_bending(its.rims[i].hoop, lower[i], K_[at][i]),
                 on_upper = peak_with_bending(its.rims[i].hoop, upper, K_[at][i]);
      bending.lower(i, heads) = on_lower.value, bending.lower_angle(i, heads) = on_lower.angle;
      bending.upper(i, heads) = on_upper.value, bending.upper_angle(i, heads) = on_upper.angle;
      const auto& face = on_upper.value > on_lower.value ? upper : lower[i];
      double& largest = bending.stress(i, heads) = 0;
      for (const auto& along : face)
        for (const double each : along) largest = std::max(largest, each);
    }
  }
}

void Bending::add(const JointEquations& equations, const PathStep& step, JointState& state) const {
  if (axes_.empty()) return;
  state.bending_mismatch.setConstant(2, 2, std::nan(""));
  for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
    const PlateModel& plate = joint_.plates[i];
    PlateBending& its = state.plates[i].bending;
    its = {std::ssize(disc_rows(plate)), std::ssize(state.plates[i].rims), plate.n_externals()};
    for (const Heads heads : scene_.bending.heads) its.De.col(heads) = equations.parameters.free[i].De;
  }
  state.bent_transferred.setConstant(joint_.n_planes(), 2, std::nan(""));
  for (const Heads heads : scene_.bending.heads) {
    JointState now = state;
    Shapes shapes = bent(loads(now), heads);
    if (scene_.bending.way_back) {
      auto mismatch = state.bending_mismatch.col(heads);
      const Eigen::Vector2d found = solve_back(equations, step, heads, now, shapes);
      for (const Axis& its : axes_) mismatch[its.axis] = found[its.axis];
    }
    set(loads(now), shapes, now, heads, state);
    if (state.bending_mismatch.col(heads).array().isInf().any())
      state.no_bending = "the joint was not solved with the sheets displaced by it, so that it acts one way alone";
    for (const auto& shape : shapes)
      if (shape.buckles)
        state.no_bending = "compression makes the sheets buckle between rows";
      else if (!shape.is_known)
        state.no_bending = "forces act along a sheet on an edge beside its rows, so that its tension is not known";
    state.bent_transferred.col(heads) = now.transferred_first;
  }
}

}  // namespace fastjoint::stage3
