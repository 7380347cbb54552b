// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/rim_terms.hpp"

#include "common/rim/bearing.hpp"

namespace fastjoint::stage1 {
namespace {

/// Values at points, (2, n_points), weighted and tested by the modes: coefficients of u_x, then of u_y.
Eigen::VectorXd tested(const pfem::SideRule& rule, const Eigen::Matrix2Xd& values) {
  const Eigen::MatrixXd by_mode = rule.N * values.transpose();
  return by_mode.reshaped();
}

void add_springs(const SideSprings& springs, const Eigen::Matrix2Xd& axes, RimTerms& terms) {
  pfem::SideRule rule = springs.rule;
  const Eigen::Index n = terms.modes.size();
  const auto n_sprung = rule.N.rows();  // links have but the traces of the two vertices, which come first
  rule.N.conservativeResize(n, Eigen::NoChange);
  rule.N.bottomRows(n - n_sprung).setZero();
  const Eigen::Matrix2Xd& normal = rule.normal;  // its sign does not matter: it comes twice
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b) {
      const Eigen::VectorXd w =
          springs.weight.array() * normal.row(a).array().transpose() * normal.row(b).array().transpose();
      terms.plate.block(a * n, b * n, n, n) = rule.N * w.asDiagonal() * rule.N.transpose();
    }
  const Eigen::MatrixXd along = axes.transpose() * normal;  // e.n, (a, n_points)
  for (Eigen::Index i = 0; i < axes.cols(); ++i) {
    const Eigen::VectorXd w = springs.weight.cwiseProduct(along.row(i).transpose());
    terms.coupling.col(i) = -tested(rule, normal * w.asDiagonal());
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
  return tested(rule, traction);
}

}  // namespace

RimTerms rim_terms(const PlateScene& scene, const PlateMesh& plate, std::size_t hole, const pfem::Side& side, int p) {
  const auto rule = rim::rim_rule(plate.mesh, plate.edges, side, p);
  const auto springs = side_springs(scene.holes[hole].sprung(), plate, side, p);
  const Eigen::Index n = rule.modes.size();
  const Eigen::Index a = scene.disc_directions.size();
  Eigen::Matrix2Xd axes(2, a);
  for (Eigen::Index i = 0; i < a; ++i) axes.col(i) = rim::axis(scene.disc_directions[i]);
  RimTerms terms{rule.modes,
                 Eigen::MatrixXd::Zero(2 * n, 2 * n),
                 Eigen::MatrixXd(2 * n, a),
                 Eigen::MatrixXd(a, a),
                 Eigen::MatrixXd(2 * n, 2 * a),
                 springs.weight.sum()};
  add_springs(springs, axes, terms);
  for (Eigen::Index i = 0; i < a; ++i) {
    terms.friction.col(2 * i) = friction_load(rule, plate.mesh.thickness[side.element], axes.col(i));
    terms.friction.col(2 * i + 1) = friction_load(rule, plate.mesh.thickness[side.element], -axes.col(i));
  }
  return terms;
}

}  // namespace fastjoint::stage1
