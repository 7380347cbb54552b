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
  std::vector<Eigen::Matrix2Xd> axes;                   ///< (2, a) directions of each hole's disc
};

/// Springs on one side of a rim, summed over points: quadrature points, or the two nodes of links.
struct SideSprings {
  pfem::SideRule rule;     ///< points with the traces of the shape functions there
  Eigen::VectorXd weight;  ///< (n_points) stiffness of each point, force / length; 0 where no spring acts
};
/// @param p Degree of the plate's space. Arcs are integrated exactly: pieces end where they do.
[[nodiscard]] SideSprings side_springs(const rim::HoleSpring& spring, const pfem::Mesh& mesh, const pfem::Edges& edges,
                                       const pfem::Side& side, int p);

/// Stiffness of the springs on one side of a sprung hole's rim, and loads of the unit pressures of contact (k, none of
/// springs that also pull) and of the h unit friction cases there, over the coefficients of the side's modes: first all
/// of u_x, then all of u_y, local signs. a disc directions, n modes.
struct RimTerms {
  std::vector<int> modes;    ///< (n) local modes of the element
  Eigen::MatrixXd plate;     ///< (2n, 2n) int k t (v.n)(u.n) ds, force / length
  Eigen::MatrixXd coupling;  ///< (2n, a) -int k t (v.n)(e.n) ds, force / length
  Eigen::MatrixXd disc;      ///< (a, a) int k t (e.n)(e'.n) ds, force / length
  Eigen::MatrixXd pressure;  ///< (2n, k) int phi t (v.n) ds, length^2
  Eigen::MatrixXd reaction;  ///< (a, k) int phi t (e.n) ds, which holds the disc against them, length^2
  /// (2n, h) loads of unit friction, length^2: of springs that also pull 2 a, direction outer, bearing side + then -;
  /// of contact the shears of its distributions, whose reaction the disc takes too.
  Eigen::MatrixXd friction;
  Eigen::MatrixXd drag;  ///< (a, h) int psi t (e.t) ds, which holds the disc against them, length^2
  double stiffness;      ///< sum of the springs, force / length; 0 if none acts on the side
};

/// Number of friction cases of a hole whose disc moves in so many directions.
[[nodiscard]] Eigen::Index n_friction_cases(const rim::HoleSpring& spring, Eigen::Index n_directions);

/// @param hole Index of a sprung hole. @param p Degree of the plate's space.
[[nodiscard]] RimTerms rim_terms(const SprungMesh& sprung, int hole, const pfem::Side& side, int p);

}  // namespace fastjoint::plate
