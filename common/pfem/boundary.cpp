// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/boundary.hpp"

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::pfem {
namespace {

/// Gauss points on every piece between the breaks. An arc brings sines and cosines of up to 90 degrees into products
/// of two polynomials of degree p; p + 8 points integrate them to rounding.
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

SideRule side_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p, const std::vector<double>& breaks) {
  const Rule rule = piecewise(p, breaks);
  const Curve curve = edge_curve(mesh, edges, side.element, side.local_edge);
  SideRule result{modes_on_edge(p, side.local_edge), integrated_legendre(p, rule.x).N, {}, {}, rule.w};
  result.x.resize(2, rule.x.size());
  result.normal.resize(2, rule.x.size());
  // Counter-clockwise, the outside is to the right; top and left run clockwise in their natural direction.
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
