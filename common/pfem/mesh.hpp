// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <compare>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace fastjoint::pfem {

/// An edge between nodes a and b that is an arc about `center`.
struct Arc {
  int a, b;
  Eigen::Vector2d center;
};

/// Quadrilaterals with straight or circular edges.
struct Mesh {
  Eigen::Matrix2Xd nodes;  ///< (2, n_nodes), length
  Eigen::Matrix4Xi quads;  ///< (4, n_elements) nodes, counter-clockwise
  std::vector<Arc> arcs;
  Eigen::VectorXd thickness;  ///< (n_elements), length
  Eigen::VectorXi material;   ///< (n_elements) index into the caller's list of materials

  [[nodiscard]] int n_nodes() const { return static_cast<int>(nodes.cols()); }
  [[nodiscard]] int n_elements() const { return static_cast<int>(quads.cols()); }
};

/// One side of one element.
struct Side {
  int element, local_edge;
  friend auto operator<=>(const Side&, const Side&) = default;
};

/// The edges of a mesh, each once, in the order in which the elements meet them.
struct Edges {
  Eigen::Matrix2Xi nodes;                ///< (2, n_edges), the lower node first, which sets the edge's global direction
  Eigen::Matrix4Xi of_element;           ///< (4, n_elements), by local edge
  std::vector<std::vector<Side>> sides;  ///< (n_edges) the elements that share it, in their order
  std::vector<int> arc;                  ///< (n_edges) index into Mesh::arcs, or -1
  std::map<std::pair<int, int>, int> index;  ///< of the edge between a lower and a higher node

  [[nodiscard]] int size() const { return static_cast<int>(sides.size()); }
  /// The edge of a side.
  [[nodiscard]] int of(const Side& side) const { return of_element(side.local_edge, side.element); }
  /// The edge between two nodes; -1 if there is none.
  [[nodiscard]] int between(int a, int b) const;
  /// True if one element alone has the edge.
  [[nodiscard]] bool is_border(int edge) const { return sides[edge].size() == 1; }
};

[[nodiscard]] Edges find_edges(const Mesh& mesh);

/// A straight edge or a circular arc from a to b, parametrised on [-1, 1]; an arc by its angle.
class Curve {
 public:
  static Curve line(const Eigen::Vector2d& a, const Eigen::Vector2d& b);
  /// The shorter arc about `center` from a to b.
  static Curve arc(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& center);

  /// The curve translated by a vector.
  [[nodiscard]] Curve moved(const Eigen::Vector2d& by) const;
  [[nodiscard]] Eigen::Vector2d point(double s) const;
  [[nodiscard]] Eigen::Vector2d derivative(double s) const;
  [[nodiscard]] bool is_arc() const { return is_arc_; }
  /// Angle of an arc at s = -1, and its signed increase up to s = 1, in (-pi, pi].
  [[nodiscard]] double start_angle() const { return start_; }
  [[nodiscard]] double sweep() const { return sweep_; }

 private:
  Eigen::Vector2d a_ = Eigen::Vector2d::Zero(), b_ = a_, center_ = a_;
  double radius_ = 0, start_ = 0, sweep_ = 0;
  bool is_arc_ = false;
};

/// Curve of a local edge in its natural direction.
[[nodiscard]] Curve edge_curve(const Mesh& mesh, const Edges& edges, int element, int local_edge);

/// The tip of a crack in a mesh that is graded towards it.
struct CrackTip {
  std::string id;      ///< name of the crack, and of which end of it if both are tips
  Eigen::Vector2d at;  ///< length
  double angle;        ///< direction in which the crack would grow, radians counter-clockwise from x
  double length;       ///< of the crack: from its other end, a rim or an edge, or half of it if both ends are tips
  /// Elements of each layer around the tip, the outermost first; local coordinate xi is -1 on the inner side of a
  /// layer.
  std::vector<std::vector<int>> layers{};
};

/// A straight piece of a mesh's outline.
struct OutlinePiece {
  Eigen::Vector2d from, to;
  int is_free;  ///< 0 where a support or an external is, and the sheet or its mirror image may go on, else 1
};

/// Quadrature along one side of an element, with the traces of the shape functions that do not vanish there.
struct SideRule {
  std::vector<int> modes;   ///< (n) local modes: the two vertices and the edge's own
  Eigen::MatrixXd N;        ///< (n, n_points) their values, local signs
  Eigen::Matrix2Xd x;       ///< (2, n_points) points, length
  Eigen::Matrix2Xd normal;  ///< (2, n_points) unit normals out of the element
  Eigen::VectorXd ds;       ///< (n_points) weights, length
};

/// @param breaks Ascending coordinates in (-1, 1) along the side's natural direction where the integrand or its slope
/// jumps; each piece is integrated separately.
[[nodiscard]] SideRule side_rule(const Mesh& mesh, const Edges& edges, const Side& side, int p,
                                 const std::vector<double>& breaks = {});

}  // namespace fastjoint::pfem
