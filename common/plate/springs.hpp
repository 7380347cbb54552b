// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/rim/rim.hpp"

namespace fastjoint::plate {

/// A mesh with the rims of its holes and the springs on them. All must outlive this.
struct SprungMesh {
  const pfem::Mesh& mesh;
  const pfem::Edges& edges;
  const std::vector<rim::Rim>& rims;                    ///< of each hole
  std::vector<std::optional<rim::HoleSpring>> springs;  ///< of each hole, none in an open one, which has no disc
  std::vector<std::optional<rim::Waves>> waves;         ///< of each hole, none where nothing asks for them
  std::vector<Eigen::Matrix2Xd> axes;                   ///< (2, a) directions of each hole's disc

  /// Number of friction cases with the cosine distribution: none in an open hole, and none in contact, whose friction
  /// is in the waves.
  [[nodiscard]] int n_friction_cases(int hole) const;
};

/// Springs on one side of a rim, summed over points: quadrature points, or the two nodes of links.
struct SideSprings {
  pfem::SideRule rule;     ///< points with the traces of the shape functions there
  Eigen::VectorXd weight;  ///< (n_points) stiffness of each point, force / length; 0 where no spring acts
};
/// @param p Degree of the plate's space. Arcs are integrated exactly: pieces end where they do.
[[nodiscard]] SideSprings side_springs(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                                       const pfem::Side& side, int p);

/// Stiffness of the springs on one side of a hole's rim, and loads of its k unit waves, pressures then shears, and of
/// its h unit friction cases there, over the coefficients of the side's modes: first all of u_x, then all of u_y, local
/// signs. a disc directions, n modes.
struct RimTerms {
  std::vector<int> modes;    ///< (n) local modes of the element
  Eigen::MatrixXd plate;     ///< (2n, 2n) int k t (v.n)(u.n) ds, force / length
  Eigen::MatrixXd coupling;  ///< (2n, a) -int k t (v.n)(e.n) ds, force / length
  Eigen::MatrixXd disc;      ///< (a, a) int k t (e.n)(e'.n) ds, force / length
  Eigen::MatrixXd waves;     ///< (2n, k) int phi t (v.n) ds of pressures, int psi t (v.t) ds of shears, length^2
  Eigen::MatrixXd reaction;  ///< (a, k) the same of e, which holds the disc against them, length^2
  Eigen::MatrixXd friction;  ///< (2n, h) loads of unit friction, direction outer, bearing side + then -, length^2
  double stiffness;          ///< sum of the springs, force / length; 0 if none acts on the side
};

/// @param hole Index of a hole with springs or waves. @param p Degree of the plate's space.
[[nodiscard]] RimTerms rim_terms(const SprungMesh& sprung, int hole, const pfem::Side& side, int p);

}  // namespace fastjoint::plate
