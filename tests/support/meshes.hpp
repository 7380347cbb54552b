// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "common/pfem/mesh.hpp"

namespace fastjoint::test {

/// Four quadrilaterals around an inner node, none of them a parallelogram, on the square [0, 2]^2.
inline pfem::Mesh distorted_mesh() {
  pfem::Mesh mesh;
  mesh.nodes.resize(2, 9);
  mesh.nodes << 0, 0.9, 2, 0, 1.15, 2, 0, 1.1, 2,  //
      0, 0, 0, 0.8, 1.1, 1.3, 2, 2, 2;
  mesh.quads.resize(4, 4);
  mesh.quads.col(0) << 0, 1, 4, 3;
  mesh.quads.col(1) << 4, 1, 2, 5;  // starts elsewhere, so that shared edges run against each other
  mesh.quads.col(2) << 7, 6, 3, 4;
  mesh.quads.col(3) << 8, 7, 4, 5;
  mesh.thickness = Eigen::Vector4d::Constant(0.3);
  mesh.material = Eigen::Vector4i::Zero();
  return mesh;
}

/// The same with arcs inside (nodes 1-4) and on the border (2-5), hollow.
inline pfem::Mesh curved_mesh() {
  pfem::Mesh mesh = distorted_mesh();
  const auto bulge = [&](int a, int b, double height) {  // the arc over chord ab, to the left of a -> b
    const Eigen::Vector2d chord = mesh.nodes.col(b) - mesh.nodes.col(a);
    const Eigen::Vector2d right(chord.y(), -chord.x());
    const double half = chord.norm() / 2;
    const double radius = (half * half + height * height) / (2 * height);
    const Eigen::Vector2d middle = (mesh.nodes.col(a) + mesh.nodes.col(b)) / 2;
    mesh.arcs.push_back({a, b, middle + right.normalized() * (radius - height)});
  };
  bulge(1, 4, 0.15);
  bulge(2, 5, 0.2);
  return mesh;
}

}  // namespace fastjoint::test
