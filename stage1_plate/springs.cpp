// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/springs.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

double angle_of(const Eigen::Vector2d& radial) { return std::atan2(radial.y(), radial.x()); }

SideSprings distributed(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p) {
  SideSprings springs{pfem::rim_rule(plate.mesh, plate.edges, side, p, spring.acts), {}};
  springs.weight = spring.modulus * plate.mesh.thickness[side.element] * springs.rule.ds;
  for (Eigen::Index q = 0; q < springs.weight.size(); ++q)
    if (!pfem::covers(spring.acts, angle_of(-springs.rule.normal.col(q)))) springs.weight[q] = 0;
  return springs;
}

/// Each end of the side has half a link, if springs act on the side there.
SideSprings links(const Spring& spring, const PlateMesh& plate, const pfem::Side& side) {
  constexpr double inside = 1e-9;  // of the side: as close as pfem::rim_rule takes an arc's end for the side's
  const pfem::Curve curve = pfem::edge_curve(plate.mesh, plate.edges, side.element, side.local_edge);
  const auto [first, second] = pfem::natural_ends(side.local_edge);
  SideSprings springs{
      {{first, second}, Eigen::Matrix2d::Identity(), Eigen::Matrix2Xd(2, 2), Eigen::Matrix2Xd(2, 2), {}},
      Eigen::Vector2d::Zero()};
  for (const int end : {0, 1}) {
    const double angle = curve.start_angle() + end * curve.sweep();
    springs.rule.x.col(end) = curve.point(end == 0 ? -1 : 1);
    springs.rule.normal.col(end) = -Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const double beside = angle + (end == 0 ? inside : -inside) * curve.sweep();
    if (pfem::covers(spring.acts, beside)) springs.weight[end] = spring.link / 2;
  }
  return springs;
}

/// What the springs of one side add, over the element's coefficients.
class SideTerms {
 public:
  explicit SideTerms(const SideSprings& springs)
      : rule_(springs.rule), weight_(springs.weight), radial_(-springs.rule.normal) {}

  /// Shape (2 n_modes, 2 n_modes), first all of u_x.
  Eigen::MatrixXd plate(Eigen::Index n_modes) const {
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(2 * n_modes, 2 * n_modes);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const Eigen::VectorXd w =
            weight_.array() * radial_.row(a).array().transpose() * radial_.row(b).array().transpose();
        const Eigen::MatrixXd block = rule_.N * w.asDiagonal() * rule_.N.transpose();
        for (std::size_t i = 0; i < rule_.modes.size(); ++i)
          for (std::size_t j = 0; j < rule_.modes.size(); ++j)
            K(a * n_modes + rule_.modes[i], b * n_modes + rule_.modes[j]) =
                block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    return K;
  }

  ElementVector coupling(const Eigen::Vector2d& e) const {
    const Eigen::VectorXd w = weight_.cwiseProduct(radial_.transpose() * e);
    return {rule_.modes, -radial_ * w.asDiagonal() * rule_.N.transpose()};
  }

  double disc(const Eigen::Vector2d& e, const Eigen::Vector2d& f) const {
    return weight_.dot((radial_.transpose() * e).cwiseProduct(radial_.transpose() * f));
  }

 private:
  const pfem::SideRule& rule_;
  const Eigen::VectorXd& weight_;
  Eigen::Matrix2Xd radial_;
};

/// Adds the springs of one hole; returns the sum of their stiffnesses.
double add_hole(const PlateScene& scene, const PlateMesh& plate, std::size_t hole, const pfem::Numbering& numbering,
                int first_disc, Assembler& assembler) {
  double sum = 0;
  for (const auto& side : plate.rims[hole].sides) {
    const SideSprings springs = side_springs(scene.holes[hole].sprung(), plate, side, numbering.p);
    const SideTerms terms(springs);
    sum += springs.weight.sum();
    assembler.add_stiffness(side.element, terms.plate(numbering.function.rows()));
    for (std::size_t a = 0; a < scene.disc_directions.size(); ++a) {
      const auto e = pfem::axis(scene.disc_directions[a]);
      assembler.add_coupling(side.element, terms.coupling(e), first_disc + static_cast<int>(a));
      for (std::size_t b = 0; b < scene.disc_directions.size(); ++b)
        assembler.add_controlled(first_disc + static_cast<int>(a), first_disc + static_cast<int>(b),
                                 terms.disc(e, pfem::axis(scene.disc_directions[b])));
    }
  }
  return sum;
}

}  // namespace

formats::HoleSpring spring_of(const Hole& hole) {
  if (!hole.spring) return {};
  return {hole.spring->modulus, hole.spring->acts};
}

SideSprings side_springs(const Spring& spring, const PlateMesh& plate, const pfem::Side& side, int p) {
  return spring.link > 0 ? links(spring, plate, side) : distributed(spring, plate, side, p);
}

void add_springs(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                 const Unknowns& unknowns, Assembler& assembler) {
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    const auto& spring = scene.holes[hole].spring;
    if (!spring) continue;
    const int first = unknowns.controlled_of_disc(unknowns.disc_of_hole[hole]);
    if (add_hole(scene, plate, hole, numbering, first, assembler) == 0 && spring->has_arc)
      reject(scene, fmt::format("/holes/{}/spring/arc", hole),
             fmt::format("the rim of hole \"{}\" that the model has is nowhere in this arc", scene.holes[hole].id),
             "an arc that covers a part of the rim, in degrees counter-clockwise from x");
  }
}

}  // namespace fastjoint::stage1
