// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/congruent_stiffness.hpp"

#include <cmath>

namespace fastjoint::pfem {

CongruentStiffness::CongruentStiffness(const Mesh& mesh, const Edges& edges,
                                       const std::vector<Eigen::Matrix3d>& elasticity, Space space, int p)
    : mesh_(mesh), edges_(edges), elasticity_(elasticity), integrate_(space, p) {}

CongruentStiffness::Shape CongruentStiffness::shape(int element) const {
  constexpr double same = 1e-12;  // of the element's size
  const Eigen::Vector2d origin = mesh_.nodes.col(mesh_.quads(0, element));
  const double size = (mesh_.nodes.col(mesh_.quads(2, element)) - origin).norm();
  const int exponent = std::ilogb(size);  // the grid must not depend on the last digits of the size
  const double step = std::ldexp(same, exponent);
  Shape shape{mesh_.material[element], exponent};
  const auto add = [&](const Eigen::Vector2d& point) {
    for (const double x : point - origin) shape.push_back(std::llround(x / step));
  };
  for (int v = 1; v < 4; ++v) add(mesh_.nodes.col(mesh_.quads(v, element)));
  for (int edge = 0; edge < 4; ++edge) {
    const int arc = edges_.arc[static_cast<std::size_t>(edges_.of_element(edge, element))];
    shape.push_back(arc < 0 ? 0 : 1);
    if (arc >= 0) add(mesh_.arcs[static_cast<std::size_t>(arc)].center);
  }
  return shape;
}

int CongruentStiffness::shape_of(int element) {
  const auto [found, is_new] = index_.try_emplace(shape(element), n_different());
  if (is_new)
    stiffness_.push_back(integrate_(ElementMap(mesh_, edges_, element),
                                    elasticity_[static_cast<std::size_t>(mesh_.material[element])], 1));
  return found->second;
}

}  // namespace fastjoint::pfem
