// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/rim_stress.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/count.hpp"
#include "common/pfem/material.hpp"
#include "common/pfem/shape_functions.hpp"
#include "stage2_extract/matrices/holes.hpp"

namespace fastjoint::test {

using stage2::FieldSolver;

namespace {

RimPoint point_at(const std::vector<rim::SideAngles>& sides, double angle) {
  RimPoint point{angle, {}};
  for (const auto& side : sides) {
    const double inside = rim::wrapped(angle, side.low() - rim::same_angle);
    if (inside > side.high() + rim::same_angle) continue;
    const double s = -1 + 2 * (inside - side.start) / side.sweep;
    point.on.push_back({side.side, std::clamp(s, -1.0, 1.0), 2 / side.sweep});
  }
  return point;
}

struct Frame {
  Eigen::Vector2d n, t;  ///< radial and hoop direction
};

Frame frame_at(double angle) { return {{std::cos(angle), std::sin(angle)}, {-std::sin(angle), std::cos(angle)}}; }

}  // namespace

std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim) {
  const auto sides = rim::side_angles(mesh, edges, rim);
  constexpr double step = rim::full_turn / n_points_per_turn;
  std::vector<RimPoint> points;
  if (sides.empty()) return points;
  const auto pieces = rim::open_pieces(sides);
  if (pieces.empty())
    for (int i = 0; i < n_points_per_turn; ++i) points.push_back(point_at(sides, i * step));
  for (const auto& piece : pieces) {
    const int n_steps = std::max(1, static_cast<int>(std::lround((piece.to - piece.from) / step)));
    for (int i = 0; i <= n_steps; ++i)
      points.push_back(point_at(sides, piece.from + i * (piece.to - piece.from) / n_steps));
  }
  return points;
}

RimStress::RimStress(const FieldSolver& solver, int hole, const std::vector<RimPoint>& points) {
  for (const auto& side : solver.plate().hole_rim[hole].sides) add_side(solver, hole, side, points);
  add_tractions(solver, hole, points);
}

void RimStress::add_side(const FieldSolver& solver, int hole, const pfem::Side& side,
                         const std::vector<RimPoint>& points) {
  const int p = solver.numbering().p;
  const double radius = solver.plate().hole_rim[hole].radius;
  const Eigen::Matrix3d compliance = solver.elasticity(side.element).inverse();
  SidePoints part;
  std::vector<const OnSide*> on;
  for (int i = 0; i < count_of(points); ++i)
    for (const auto& at : points[i].on)
      if (at.side == side) {
        part.points.push_back(i);
        on.push_back(&at);
      }
  const std::vector<int> modes = pfem::modes_on_edge(p, side.local_edge);
  const Eigen::Index n = on.size(), n_modes = solver.numbering().function.rows();
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(2 * n_modes, 2 * n);
  part.hoop.resize(3, n);
  part.share.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const RimPoint& point = points[part.points[i]];
    const Frame frame = frame_at(point.angle);
    const auto shape = pfem::integrated_legendre(p, Eigen::VectorXd::Constant(1, on[i]->s));
    for (int k = 0; k < count_of(modes); ++k)
      for (const int component : {0, 1}) {
        const auto row = modes[k] + component * n_modes;
        weights(row, i) = frame.n[component] * shape.N(k, 0);
        weights(row, n + i) = frame.t[component] * shape.dN(k, 0) * on[i]->ds_dtheta / radius;
      }
    part.share[i] = 1.0 / count_of(point.on);
    const Eigen::Matrix3d to_global = pfem::polar_stress(-point.angle);
    const Eigen::Vector3d c = (to_global.transpose() * compliance * to_global).row(1);
    part.hoop.col(i) << -c[0] / c[1], 1 / c[1], -c[2] / c[1];
  }
  part.u_n_and_hoop = solver.factor().condense_functions(side.element, weights);
  sides_.push_back(std::move(part));
}

void RimStress::add_tractions(const FieldSolver& solver, int hole, const std::vector<RimPoint>& points) {
  const auto& plate = solver.plate();
  const std::string& id = plate.hole_id[hole];
  const auto& spring = plate.hole_spring[hole];
  const Eigen::Index n = points.size();
  const auto at_points = [&](auto value) {
    Eigen::RowVectorXd values(n);
    for (Eigen::Index i = 0; i < n; ++i) values[i] = value(frame_at(points[i].angle), i);
    return values;
  };
  modulus_ = at_points(
      [&](const Frame&, Eigen::Index i) { return rim::covers(spring.arcs, points[i].angle) ? spring.modulus : 0; });
  std::vector<Eigen::RowVectorXd> rows;
  const auto add = [&](Eigen::Index unit_case, Eigen::Index component, const Eigen::RowVectorXd& values) {
    loading_.push_back(unit_case);
    rows.emplace_back(Eigen::RowVectorXd::Zero(2 * n)).segment(component * n, n) = values;
  };
  constexpr Eigen::Index rr = 0, rt = 1;
  Eigen::Index unit_case = plate.n_externals();
  for (int i = 0; i < count_of(plate.disc_hole); ++i, ++unit_case) {
    if (plate.disc_hole[i] != id) continue;
    const Eigen::Vector2d e = rim::unit_vector(rim::axis_named(plate.disc_direction[i]));
    add(unit_case, rr, at_points([&](const Frame& at, Eigen::Index k) { return -modulus_[k] * e.dot(at.n); }));
  }
  for (std::size_t i = 0; i < plate.contact.size(); ++i) {
    const rim::Harmonics& waves = plate.waves[i].waves;
    const auto add_wave = [&](Eigen::Index component, const auto& at_angle) {
      if (plate.waves[i].hole == id)
        add(unit_case, component, -at_points([&](const Frame&, Eigen::Index k) { return at_angle(points[k].angle); }));
      ++unit_case;
    };
    for (int k = 0; k < waves.size(); ++k) add_wave(rr, [&](double angle) { return waves.at(angle)[k]; });
    for (int k = 0; k < waves.n_shears(); ++k) add_wave(rt, [&](double angle) { return waves.shears_at(angle)[k]; });
  }
  for (int i = 0; i < count_of(plate.friction_hole); ++i, ++unit_case) {
    if (plate.friction_hole[i] != id) continue;
    const Eigen::Vector2d d = rim::unit_vector(rim::signed_axis_named(plate.friction_bearing[i]));
    add(unit_case, rt, at_points([&](const Frame& at, Eigen::Index) {  // pulls by sigma . (-n)
          const auto bearing = rim::cosine_bearing(at.n, d);
          return -bearing.contact * bearing.tangent.dot(at.t);
        }));
  }
  for (int i = 0; i < count_of(plate.traction_hole); ++i, ++unit_case) {
    if (plate.traction_hole[i] != id) continue;
    // A unit force along the direction is a negative pressure on the side against it.
    const double sign = plate.traction_bearing[i][0] == '-' ? -1 : 1;
    const Eigen::Vector2d d = rim::unit_vector(rim::signed_axis_named(plate.traction_bearing[i]));
    const double unit_force = rim::bearing(plate.mesh, solver.edges(), plate.hole_rim[hole], d).unit_force;
    add(unit_case, rr, at_points([&](const Frame& at, Eigen::Index) {
          return -sign * rim::cosine_bearing(at.n, d).contact / unit_force;
        }));
  }
  tractions_.resize(std::ssize(rows), 2 * n);
  for (Eigen::Index i = 0; i < std::ssize(rows); ++i) tractions_.row(i) = rows[i];
}

RimStresses RimStress::operator()(const stage2::Fields& fields) const {
  const auto k = fields.states.size(), n = modulus_.size();
  const Eigen::MatrixXd amounts = fields.coefficients(loading_, Eigen::all), known = amounts.transpose() * tractions_;
  RimStresses sigma{known.leftCols(n), Eigen::MatrixXd::Zero(k, n), known.rightCols(n)};
  std::vector<Eigen::MatrixXd> values;
  for (const auto& side : sides_) {
    values.push_back(fields.states.values(side.u_n_and_hoop));
    for (int i = 0; i < count_of(side.points); ++i) {
      const int at = side.points[i];
      sigma.rr.col(at) += side.share[i] * modulus_[at] * values.back().col(i);
    }
  }
  for (int s = 0; s < count_of(sides_); ++s)
    for (int i = 0; i < count_of(sides_[s].points); ++i) {
      const int at = sides_[s].points[i];
      const Eigen::Vector3d hoop = sides_[s].share[i] * sides_[s].hoop.col(i);
      sigma.tt.col(at) += hoop[0] * sigma.rr.col(at) + hoop[1] * values[s].col(sides_[s].points.size() + i) +
                          hoop[2] * sigma.rt.col(at);
    }
  return sigma;
}

}  // namespace fastjoint::test
