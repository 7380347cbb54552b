// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/count.hpp"
#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {
namespace {

/// Gauss points on every piece between the breaks. The integrand on an arc is a product of two polynomials of degree p
/// with sines and cosines of up to 90 degrees; p + 8 points integrate it to rounding.
Rule piecewise(int p, const std::vector<double>& breaks) {
  const Rule rule = gauss(p + 8);
  std::vector<double> ends = {-1};
  ends.insert(ends.end(), breaks.begin(), breaks.end());
  ends.push_back(1);
  const auto n = rule.x.size();
  const Eigen::Index n_pieces = std::ssize(ends) - 1;
  Rule all{Eigen::VectorXd(n * n_pieces), Eigen::VectorXd(n * n_pieces)};
  for (Eigen::Index i = 0; i < n_pieces; ++i) {
    const double low = ends[i];
    const double half = (ends[i + 1] - low) / 2;
    all.x.segment(i * n, n) = (low + half) + half * rule.x.array();
    all.w.segment(i * n, n) = half * rule.w;
  }
  return all;
}

}  // namespace

int Edges::between(int a, int b) const {
  const auto found = index.find(std::minmax(a, b));
  return found == index.end() ? -1 : found->second;
}

Edges find_edges(const Mesh& mesh) {
  Edges edges;
  edges.of_element.resize(n_local_edges, mesh.n_elements());
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int edge = 0; edge < n_local_edges; ++edge) {
      const auto [a, b] = natural_ends(edge);
      const std::pair<int, int> ends = std::minmax(mesh.quads(a, element), mesh.quads(b, element));
      const auto [found, is_new] = edges.index.try_emplace(ends, edges.size());
      if (is_new) edges.sides.emplace_back();
      edges.sides[found->second].push_back({element, edge});
      edges.of_element(edge, element) = found->second;
    }
  edges.nodes.resize(2, edges.size());
  for (const auto& [ends, edge] : edges.index) edges.nodes.col(edge) << ends.first, ends.second;
  edges.arc.assign(edges.size(), -1);
  for (int i = 0; i < count_of(mesh.arcs); ++i)
    if (const int edge = edges.between(mesh.arcs[i].a, mesh.arcs[i].b); edge >= 0) edges.arc[edge] = i;
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

Curve Curve::moved(const Eigen::Vector2d& by) const {
  Curve c = *this;
  c.a_ += by;
  c.b_ += by;
  c.center_ += by;
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

SideRule side_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p, const std::vector<double>& breaks) {
  const Rule rule = piecewise(p, breaks);
  const Curve curve = edge_curve(mesh, edges, side.element, side.local_edge);
  SideRule result{modes_on_edge(p, side.local_edge), integrated_legendre(p, rule.x).N, {}, {}, rule.w};
  result.x.resize(2, rule.x.size());
  result.normal.resize(2, rule.x.size());
  // The outward normal is to the right of a counter-clockwise edge; top and left run clockwise in their natural
  // direction.
  const double out = side.local_edge < 2 ? 1 : -1;
  for (Eigen::Index q = 0; q < rule.x.size(); ++q) {
    const Eigen::Vector2d tangent = curve.derivative(rule.x[q]);
    result.x.col(q) = curve.point(rule.x[q]);
    result.normal.col(q) = out * Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
    result.ds[q] *= tangent.norm();
  }
  return result;
}

}  // namespace fastjoint::pfem
