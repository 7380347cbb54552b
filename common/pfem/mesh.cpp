// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {

Edges find_edges(const Mesh& mesh) {
  Edges edges;
  edges.of_element.resize(n_local_edges, mesh.n_elements());
  std::map<std::pair<int, int>, int> index;
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const auto [a, b] = natural_ends(edge);
      const std::pair<int, int> ends = std::minmax(mesh.quads(a, element), mesh.quads(b, element));
      const auto [found, is_new] = index.try_emplace(ends, count_of(index));
      if (is_new) edges.n_elements.push_back(0);
      ++edges.n_elements[found->second];
      edges.of_element(edge, element) = found->second;
    }
  edges.nodes.resize(2, index.size());
  for (const auto& [ends, edge] : index) edges.nodes.col(edge) << ends.first, ends.second;
  edges.arc.assign(index.size(), -1);
  for (int i = 0; i < count_of(mesh.arcs); ++i) {
    const auto found = index.find(std::minmax(mesh.arcs[i].a, mesh.arcs[i].b));
    if (found == index.end())
      edges.arc_without_edge.push_back(i);
    else
      edges.arc[found->second] = i;
  }
  return edges;
}

Curve Curve::line(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  Curve c;
  c.a_ = a;
  c.b_ = b;
  return c;
}

Curve Curve::arc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& center) {
  Curve c = line(a, b);
  const Eigen::Vector2d from = a - center;
  const Eigen::Vector2d to = b - center;
  c.is_arc_ = true;
  c.center_ = center;
  c.radius_ = from.norm();
  c.start_ = std::atan2(from.y(), from.x());
  c.sweep_ = std::remainder(std::atan2(to.y(), to.x()) - c.start_, 2 * std::numbers::pi);
  return c;
}

Eigen::Vector2d Curve::point(double s) const {
  if (!is_arc_) return (1 - s) / 2 * a_ + (1 + s) / 2 * b_;
  const double angle = start_ + (1 + s) / 2 * sweep_;
  return center_ + radius_ * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d Curve::derivative(double s) const {
  if (!is_arc_) return (b_ - a_) / 2;
  const double angle = start_ + (1 + s) / 2 * sweep_;
  return radius_ * sweep_ / 2 * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
}

Curve edge_curve(const Mesh& mesh, const Edges& edges, int element, int local_edge) {
  const auto [first, second] = natural_ends(local_edge);
  const Eigen::Vector2d a = mesh.nodes.col(mesh.quads(first, element));
  const Eigen::Vector2d b = mesh.nodes.col(mesh.quads(second, element));
  const int arc = edges.arc[edges.of_element(local_edge, element)];
  return arc < 0 ? Curve::line(a, b) : Curve::arc(a, b, mesh.arcs[arc].center);
}

}  // namespace fastjoint::pfem
