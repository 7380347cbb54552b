// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/rim/rim.hpp"

namespace fastjoint::plate {

/// A mesh with the rims of its holes and the springs on them. The members referred to must outlive this.
struct SprungMesh {
  const pfem::Mesh& mesh;
  const pfem::Edges& edges;
  const std::vector<rim::Rim>& rims;  ///< rim of each hole
  std::vector<std::optional<rim::HoleSpring>>
      springs;                                   ///< springs of each hole; none in an open hole, which has no disc
  std::vector<std::optional<rim::Waves>> waves;  ///< waves of each hole; none where they are not needed
  std::vector<Eigen::Matrix2Xd> axes;            ///< (2, a) directions of each hole's disc

  /// Number of friction cases with the cosine distribution. Open holes have none, nor have holes in contact, whose
  /// friction is part of the waves.
  [[nodiscard]] int n_friction_cases(int hole) const;
};

/// Springs on one side of a rim as a sum over points: quadrature points, or the two nodes of links.
struct SideSprings {
  pfem::SideRule rule;     ///< points with the traces of the shape functions there
  Eigen::VectorXd weight;  ///< (n_points) stiffness of each point, force / length; 0 where there is no spring
};
/// @param p Degree of the plate's space. Arcs are integrated exactly, since pieces of the quadrature end where arcs
/// end.
[[nodiscard]] SideSprings side_springs(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                                       const pfem::Side& side, int p);

/// Stiffness of the springs on one side of a hole's rim, and loads of its k unit waves (pressures, then shears) and h
/// unit friction cases there, over the coefficients of the side's n modes: first all of u_x, then all of u_y, local
/// signs. The disc has a directions.
struct RimTerms {
  std::vector<int> modes;    ///< (n) local modes of the element
  Eigen::MatrixXd plate;     ///< (2n, 2n) int k t (v.n)(u.n) ds, force / length
  Eigen::MatrixXd coupling;  ///< (2n, a) -int k t (v.n)(e.n) ds, force / length
  Eigen::MatrixXd disc;      ///< (a, a) int k t (e.n)(e'.n) ds, force / length
  Eigen::MatrixXd waves;     ///< (2n, k) int phi t (v.n) ds for pressures, int psi t (v.t) ds for shears, length^2
  Eigen::MatrixXd reaction;  ///< (a, k) the same with e for v: reaction of the disc to them, length^2
  Eigen::MatrixXd friction;  ///< (2n, h) loads of unit friction by direction, then bearing side + and -, length^2
  double stiffness;          ///< sum of the springs, force / length; 0 if the side has none
};

/// @param hole Index of a hole with springs or waves. @param p Degree of the plate's space.
[[nodiscard]] RimTerms rim_terms(const SprungMesh& sprung, int hole, const pfem::Side& side, int p);

}  // namespace fastjoint::plate
