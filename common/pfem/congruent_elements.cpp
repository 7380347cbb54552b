// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/congruent_elements.hpp"

#include <cmath>
#include <cstdint>
#include <map>

#include "common/count.hpp"
#include "common/linalg/threads.hpp"
#include "common/pfem/element_stiffness.hpp"

namespace fastjoint::pfem {
namespace {

using Shape = std::vector<std::int64_t>;

Shape shape_of(const Mesh& mesh, const Edges& edges, int element) {
  constexpr double same = 1e-12;  // of the element's size
  const Eigen::Vector2d origin = mesh.nodes.col(mesh.quads(0, element));
  const double size = (mesh.nodes.col(mesh.quads(2, element)) - origin).norm();
  const int exponent = std::ilogb(size);  // the grid must not depend on the last digits of the size
  const double step = std::ldexp(same, exponent);
  Shape shape{mesh.material[element], exponent};
  const auto add = [&](const Eigen::Vector2d& point) {
    for (const double x : point - origin) shape.push_back(std::llround(x / step));
  };
  for (int v = 1; v < 4; ++v) add(mesh.nodes.col(mesh.quads(v, element)));
  for (int edge = 0; edge < 4; ++edge) {
    const int arc = edges.arc[edges.of_element(edge, element)];
    shape.push_back(arc < 0 ? 0 : 1);
    if (arc >= 0) add(mesh.arcs[arc].center);
  }
  return shape;
}

}  // namespace

CongruentElements find_congruent(const Mesh& mesh, const Edges& edges) {
  CongruentElements congruent;
  std::map<Shape, int> index;
  for (int element = 0; element < mesh.n_elements(); ++element) {
    const auto [found, is_new] = index.try_emplace(shape_of(mesh, edges, element), count_of(congruent.first));
    if (is_new) congruent.first.push_back(element);
    congruent.class_of.push_back(found->second);
  }
  return congruent;
}

std::vector<Eigen::MatrixXd> integrate(const CongruentElements& congruent, const Mesh& mesh, const Edges& edges,
                                       const std::vector<Eigen::Matrix3d>& elasticity, Space space, int p) {
  const ElementStiffness stiffness(space, p);
  std::vector<Eigen::MatrixXd> K(congruent.first.size());
  linalg::for_each_index(K.size(), [&](std::size_t i) {
    const int element = congruent.first[i];
    K[i] = stiffness(ElementMap(mesh, edges, element), elasticity[mesh.material[element]], 1);
  });
  return K;
}

}  // namespace fastjoint::pfem
