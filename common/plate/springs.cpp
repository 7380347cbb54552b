// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/springs.hpp"

#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::plate {
namespace {

double angle_of(const Eigen::Vector2d& radial) { return std::atan2(radial.y(), radial.x()); }

SideSprings distributed(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                        const pfem::Side& side, int p) {
  SideSprings springs{rim::rim_rule(mesh, edges, side, p, spring.arcs), {}};
  springs.weight = spring.modulus * mesh.thickness[side.element] * springs.rule.ds;
  for (Eigen::Index q = 0; q < springs.weight.size(); ++q)
    if (!rim::covers(spring.arcs, angle_of(-springs.rule.normal.col(q)))) springs.weight[q] = 0;
  return springs;
}

/// Places half a link at each end of the side that is on an arc with springs.
SideSprings links(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                  const pfem::Side& side) {
  constexpr double tolerance = 1e-9;  // relative to the side, the same as in rim::rim_rule
  const pfem::Curve curve = pfem::edge_curve(mesh, edges, side.element, side.local_edge);
  const auto [first, second] = pfem::natural_ends(side.local_edge);
  SideSprings springs{
      {{first, second}, Eigen::Matrix2d::Identity(), Eigen::Matrix2Xd(2, 2), Eigen::Matrix2Xd(2, 2), {}},
      Eigen::Vector2d::Zero()};
  for (const int end : {0, 1}) {
    const double angle = curve.start_angle() + end * curve.sweep();
    springs.rule.x.col(end) = curve.point(end == 0 ? -1 : 1);
    springs.rule.normal.col(end) = -Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const double within = angle + (end == 0 ? tolerance : -tolerance) * curve.sweep();
    if (rim::covers(spring.arcs, within)) springs.weight[end] = spring.link / 2;
  }
  return springs;
}

/// Load vector of weighted values at points, (2, n_points): coefficients of u_x, then of u_y.
Eigen::VectorXd load_vector(const pfem::SideRule& rule, const Eigen::Matrix2Xd& values) {
  const Eigen::MatrixXd by_mode = rule.N * values.transpose();
  return by_mode.reshaped();
}

void add_springs(const SideSprings& springs, const Eigen::Matrix2Xd& axes, RimTerms& terms) {
  pfem::SideRule rule = springs.rule;
  const Eigen::Index n = terms.modes.size();
  const auto n_sprung = rule.N.rows();  // links have only the traces of the two vertices, which come first
  rule.N.conservativeResize(n, Eigen::NoChange);
  rule.N.bottomRows(n - n_sprung).setZero();
  const Eigen::Matrix2Xd& normal = rule.normal;  // enters quadratically, so its sign does not matter
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      const Eigen::VectorXd w =
          springs.weight.array() * normal.row(a).array().transpose() * normal.row(b).array().transpose();
      terms.plate.block(a * n, b * n, n, n) = rule.N * w.asDiagonal() * rule.N.transpose();
    }
  const Eigen::MatrixXd along = axes.transpose() * normal;  // e.n, (a, n_points)
  for (Eigen::Index i = 0; i < axes.cols(); ++i) {
    const Eigen::VectorXd w = springs.weight.cwiseProduct(along.row(i).transpose());
    terms.coupling.col(i) = -load_vector(rule, normal * w.asDiagonal());
    terms.disc.row(i) = along * w;
  }
}

/// Tangential traction with the cosine distribution on the half that bears along d.
Eigen::VectorXd friction_load(const pfem::SideRule& rule, double thickness, const Eigen::Vector2d& d) {
  Eigen::Matrix2Xd traction(2, rule.ds.size());
  for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
    const auto bearing = rim::cosine_bearing(-rule.normal.col(q), d);
    traction.col(q) = thickness * rule.ds[q] * bearing.contact * bearing.tangent;
  }
  return load_vector(rule, traction);
}

/// Adds loads of the pressures and shears of the waves, integrated on pieces of a quarter wave length.
void add_waves(const SprungMesh& sprung, int hole, const pfem::Side& side, int p, RimTerms& terms) {
  const rim::Harmonics& shape = sprung.waves[hole].value().shape;
  const auto along = sprung.axes[hole].transpose();
  const double step = rim::full_turn / 4 / shape.highest;
  std::vector<rim::AngleRange> pieces;
  for (int i = 0; i < 4 * shape.highest; ++i) pieces.push_back({i * step, (i + 1) * step});
  const auto rule = rim::rim_rule(sprung.mesh, sprung.edges, side, p, pieces);
  const double thickness = sprung.mesh.thickness[side.element];
  for (Eigen::Index q = 0; q < rule.ds.size(); ++q) {
    const Eigen::Vector2d n = -rule.normal.col(q), t(-n.y(), n.x());
    const double angle = angle_of(n), weight = thickness * rule.ds[q];
    Eigen::Matrix2Xd traction(2, terms.waves.cols());
    traction << weight * n * shape.at(angle).transpose(), weight * t * shape.shears_at(angle).transpose();
    const auto n_modes = rule.N.rows();
    for (const int axis : {0, 1}) terms.waves.middleRows(axis * n_modes, n_modes) += rule.N.col(q) * traction.row(axis);
    terms.reaction += along * traction;
  }
}

}  // namespace

SideSprings side_springs(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                         const pfem::Side& side, int p) {
  return spring.link > 0 ? links(spring, mesh, edges, side) : distributed(spring, mesh, edges, side, p);
}

int SprungMesh::n_friction_cases(int hole) const {
  const bool none = !springs[hole] || (waves[hole] && waves[hole]->loaded);
  return none ? 0 : 2 * static_cast<int>(axes[hole].cols());
}

RimTerms rim_terms(const SprungMesh& sprung, int hole, const pfem::Side& side, int p) {
  const auto& [mesh, edges, rims, all_springs, all_waves, all_axes] = sprung;
  const Eigen::Matrix2Xd& axes = all_axes[hole];
  const auto rule = rim::rim_rule(mesh, edges, side, p);
  const Eigen::Index n = rule.modes.size(), a = axes.cols(), k = all_waves[hole] ? all_waves[hole]->size() : 0;
  const Eigen::Index h = sprung.n_friction_cases(hole);
  RimTerms terms{rule.modes,
                 Eigen::MatrixXd::Zero(2 * n, 2 * n),
                 Eigen::MatrixXd::Zero(2 * n, a),
                 Eigen::MatrixXd::Zero(a, a),
                 Eigen::MatrixXd::Zero(2 * n, k),
                 Eigen::MatrixXd::Zero(a, k),
                 Eigen::MatrixXd(2 * n, h),
                 0};
  if (all_springs[hole]) {
    const auto springs = side_springs(*all_springs[hole], mesh, edges, side, p);
    add_springs(springs, axes, terms);
    terms.stiffness = springs.weight.sum();
  }
  if (k > 0) add_waves(sprung, hole, side, p, terms);
  for (Eigen::Index i = 0; i < h; ++i) {
    const Eigen::Vector2d d = (i % 2 == 0 ? 1 : -1) * axes.col(i / 2);
    terms.friction.col(i) = friction_load(rule, mesh.thickness[side.element], d);
  }
  return terms;
}

}  // namespace fastjoint::plate
