// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/element.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/linalg/processor.hpp"

namespace fastjoint::pfem {
namespace {

using Shape = std::vector<std::int64_t>;

Shape shape_of(const Mesh& mesh, const Edges& edges, int element) {
  constexpr double same = 1e-12;  // relative to the element's size
  const Eigen::Vector2d origin = mesh.nodes.col(mesh.quads(0, element));
  const double size = (mesh.nodes.col(mesh.quads(2, element)) - origin).norm();
  const int exponent = std::ilogb(size);  // makes the grid independent of rounding of the size
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

ElementMap::ElementMap(const Mesh& mesh, const Edges& edges, int element)
    : origin_(mesh.nodes.col(mesh.quads(0, element))) {
  for (int edge = 0; edge < n_local_edges; ++edge)
    curves_[edge] = edge_curve(mesh, edges, element, edge).moved(-origin_);
  for (int v = 0; v < 4; ++v) vertices_.col(v) = mesh.nodes.col(mesh.quads(v, element)) - origin_;
}

Eigen::Vector2d ElementMap::point(double xi, double eta) const {
  const auto& [bottom, right, top, left] = curves_;
  const Eigen::Vector4d bilinear =
      Eigen::Vector4d((1 - xi) * (1 - eta), (1 + xi) * (1 - eta), (1 + xi) * (1 + eta), (1 - xi) * (1 + eta)) / 4;
  return origin_ + (1 - eta) / 2 * bottom.point(xi) + (1 + eta) / 2 * top.point(xi) + (1 - xi) / 2 * left.point(eta) +
         (1 + xi) / 2 * right.point(eta) - vertices_ * bilinear;
}

Eigen::Matrix2d ElementMap::jacobian(double xi, double eta) const {
  const auto& [bottom, right, top, left] = curves_;
  const Eigen::Vector4d bilinear_xi = Eigen::Vector4d(-(1 - eta), 1 - eta, 1 + eta, -(1 + eta)) / 4;
  const Eigen::Vector4d bilinear_eta = Eigen::Vector4d(-(1 - xi), -(1 + xi), 1 + xi, 1 - xi) / 4;
  Eigen::Matrix2d J;
  J.col(0) = (1 - eta) / 2 * bottom.derivative(xi) + (1 + eta) / 2 * top.derivative(xi) +
             (right.point(eta) - left.point(eta)) / 2 - vertices_ * bilinear_xi;
  J.col(1) = (1 - xi) / 2 * left.derivative(eta) + (1 + xi) / 2 * right.derivative(eta) +
             (top.point(xi) - bottom.point(xi)) / 2 - vertices_ * bilinear_eta;
  return J;
}

bool ElementMap::is_curved() const {
  return std::any_of(curves_.begin(), curves_.end(), [](const Curve& c) { return c.is_arc(); });
}

Eigen::MatrixXd strain_operator(const ElementMap& map, Space space, int p, const Eigen::VectorXd& xi,
                                const Eigen::VectorXd& eta) {
  const ShapeValues shape = shape_values(space, p, xi, eta);
  const auto n = shape.N.rows();
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(3 * xi.size(), 2 * n);
  for (Eigen::Index q = 0; q < xi.size(); ++q) {
    const Eigen::Matrix2d to_physical = map.jacobian(xi[q], eta[q]).inverse();
    const Eigen::RowVectorXd Nx =
        to_physical(0, 0) * shape.dN_dxi.col(q).transpose() + to_physical(1, 0) * shape.dN_deta.col(q).transpose();
    const Eigen::RowVectorXd Ny =
        to_physical(0, 1) * shape.dN_dxi.col(q).transpose() + to_physical(1, 1) * shape.dN_deta.col(q).transpose();
    B.row(3 * q) << Nx, Eigen::RowVectorXd::Zero(n);
    B.row(3 * q + 1) << Eigen::RowVectorXd::Zero(n), Ny;
    B.row(3 * q + 2) << Ny, Nx;
  }
  return B;
}

GeometricDegree geometric_degree(const ElementMap& map, const Box& box) {
  constexpr int n = highest_geometric_degree + 1;
  constexpr double negligible = 1e-11;
  if (!map.is_curved() && (map.point(-1, -1) + map.point(1, 1) - map.point(1, -1) - map.point(-1, 1)).isZero(0))
    return {0, 0};
  static const Rule rule = gauss(n);
  static const Eigen::MatrixXd P = legendre(n - 1, rule.x) * rule.w.asDiagonal();  // coefficients from values
  Eigen::MatrixXd values(n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d at = box.middle + box.half.cwiseProduct(Eigen::Vector2d(rule.x[i], rule.x[j]));
      const Eigen::Matrix2d J = map.jacobian(at.x(), at.y());
      const double det = J.determinant();
      values(i, j) = J.col(0).squaredNorm() / det;
      values(i, n + j) = J.col(1).squaredNorm() / det;
      values(i, 2 * n + j) = J.col(0).dot(J.col(1)) / det;
    }
  Eigen::MatrixX2d largest = Eigen::MatrixX2d::Zero(n, 2);  // largest coefficient of each degree in xi and in eta
  for (int k = 0; k < 3; ++k) {
    const Eigen::MatrixXd C = (P * values.middleCols(Eigen::Index{k} * n, n) * P.transpose()).cwiseAbs();
    largest.col(0) = largest.col(0).cwiseMax(C.rowwise().maxCoeff());
    largest.col(1) = largest.col(1).cwiseMax(C.colwise().maxCoeff().transpose());
  }
  int degree = n - 1;
  while (degree > 0 && largest.row(degree).maxCoeff() <= negligible * largest.maxCoeff()) --degree;
  return {degree, largest(degree, 0) > largest(degree, 1) ? 0 : 1};
}

ElementStiffness::ElementStiffness(Space space, int p, int extra) : space_(space), p_(p), extra_(extra) {}

ElementStiffness::Table ElementStiffness::make_table(int n_points, const Box& box) const {
  Table table;
  const Rule rule = gauss(n_points);
  table.xi = (box.middle.x() + box.half.x() * rule.x.array()).replicate(n_points, 1);
  table.eta = (box.middle.y() + box.half.y() * rule.x.transpose().array()).replicate(n_points, 1).reshaped();
  table.w = box.half.prod() * (rule.w * rule.w.transpose()).reshaped();
  table.shape = shape_values(space_, p_, table.xi, table.eta);
  return table;
}

const ElementStiffness::Table& ElementStiffness::table(int n_points) const {
  const std::lock_guard lock(mutex_);
  const auto [found, is_new] = tables_.try_emplace(n_points);
  if (is_new) found->second = make_table(n_points, {});
  return found->second;
}

Eigen::MatrixXd ElementStiffness::operator()(const ElementMap& map, const Eigen::Matrix3d& D, double thickness,
                                             const Box& box) const {
  // A fold would be halved without end in sight, and give no number.
  const auto positive = [](double det) {
    if (!(det > 0)) throw NumericalError("an element is folded: its Jacobian is not positive everywhere");
    return det;
  };
  positive(map.jacobian(box.middle[0], box.middle[1]).determinant());
  const auto [degree, steeper] = geometric_degree(map, box);
  constexpr double min_half = 1e-4;  // half a side of a part; the stiffness of smaller ones is below rounding
  if (degree == highest_geometric_degree && box.half[steeper] > min_half) {
    Box low = box, high = box;
    low.half[steeper] = high.half[steeper] = box.half[steeper] / 2;
    low.middle[steeper] -= low.half[steeper];
    high.middle[steeper] += high.half[steeper];
    return (*this)(map, D, thickness, low) + (*this)(map, D, thickness, high);
  }
  // The integrand has the degree 2 p + `degree` in each direction; n points are exact up to 2 n - 1.
  const int n_each_way = p_ + 1 + degree / 2 + extra_;
  const bool is_whole = box.half.isOnes(0);
  const Table part = is_whole ? Table{} : make_table(n_each_way, box);
  const Table& table = is_whole ? this->table(n_each_way) : part;
  const auto n_points = table.w.size();
  const auto n = table.shape.N.rows();
  Eigen::MatrixXd Nx(n, n_points), Ny(n, n_points);  // derivatives by x and y, times the root of the weight
  for (Eigen::Index q = 0; q < n_points; ++q) {
    const Eigen::Matrix2d J = map.jacobian(table.xi[q], table.eta[q]);
    const double det = positive(J.determinant());
    const Eigen::Matrix2d to_physical = J.inverse() * std::sqrt(table.w[q] * det * thickness);
    Nx.col(q) = table.shape.dN_dxi.col(q) * to_physical(0, 0) + table.shape.dN_deta.col(q) * to_physical(1, 0);
    Ny.col(q) = table.shape.dN_dxi.col(q) * to_physical(0, 1) + table.shape.dN_deta.col(q) * to_physical(1, 1);
  }
  const Eigen::MatrixXd XX = Nx * Nx.transpose();
  const Eigen::MatrixXd XY = Nx * Ny.transpose();
  const Eigen::MatrixXd YY = Ny * Ny.transpose();
  const Eigen::MatrixXd YX = XY.transpose();
  Eigen::MatrixXd K(2 * n, 2 * n);
  K.topLeftCorner(n, n) = D(0, 0) * XX + D(0, 2) * (XY + YX) + D(2, 2) * YY;
  K.topRightCorner(n, n) = D(0, 1) * XY + D(0, 2) * XX + D(1, 2) * YY + D(2, 2) * YX;
  K.bottomLeftCorner(n, n) = K.topRightCorner(n, n).transpose();
  K.bottomRightCorner(n, n) = D(1, 1) * YY + D(1, 2) * (XY + YX) + D(2, 2) * XX;
  return K;
}

double jacobian_ratio(const ElementMap& map) {
  constexpr int n_samples = 9;  // includes vertices and edges, where a map folds first
  double min = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int i = 0; i < n_samples; ++i)
    for (int j = 0; j < n_samples; ++j) {
      const double det = map.jacobian(-1 + 2.0 * i / (n_samples - 1), -1 + 2.0 * j / (n_samples - 1)).determinant();
      min = std::min(min, det);
      sum += det;
    }
  return min / std::abs(sum / (n_samples * n_samples));
}

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
