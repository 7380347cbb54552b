// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/springs.hpp"

namespace fastjoint::stage1 {
namespace {

/// Springs of one side of a rim, over the element's coefficients.
class SideSprings {
 public:
  SideSprings(const pfem::SideRule& rule, double modulus, double thickness)
      : rule_(rule), weight_(modulus * thickness * rule.ds), radial_(-rule.normal) {}

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
  Eigen::VectorXd weight_;
  Eigen::Matrix2Xd radial_;
};

}  // namespace

formats::HoleSpring spring_of(const Hole& hole) {
  if (!hole.spring_modulus) return {};
  return {*hole.spring_modulus, {{-pfem::full_turn / 2, pfem::full_turn / 2}}};
}

void add_springs(const PlateScene& scene, const PlateMesh& plate, const pfem::Numbering& numbering,
                 const Unknowns& unknowns, Assembler& assembler) {
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    const auto& modulus = scene.holes[hole].spring_modulus;
    if (!modulus) continue;
    const int first = unknowns.n_externals() + unknowns.disc_of_hole[hole];
    for (const auto& side : plate.rims[hole].sides) {
      const auto rule = pfem::side_rule(plate.mesh, plate.edges, side, numbering.p);
      const SideSprings springs(rule, *modulus, plate.mesh.thickness[side.element]);
      assembler.add_stiffness(side.element, springs.plate(numbering.function.rows()));
      for (std::size_t a = 0; a < scene.disc_directions.size(); ++a) {
        const auto e = pfem::axis(scene.disc_directions[a]);
        assembler.add_coupling(side.element, springs.coupling(e), first + static_cast<int>(a));
        for (std::size_t b = 0; b < scene.disc_directions.size(); ++b)
          assembler.add_controlled(first + static_cast<int>(a), first + static_cast<int>(b),
                                   springs.disc(e, pfem::axis(scene.disc_directions[b])));
      }
    }
  }
}

}  // namespace fastjoint::stage1
