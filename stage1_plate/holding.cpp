// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/holding.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/errors.hpp"
#include "stage1_plate/springs.hpp"

namespace fastjoint::stage1 {
namespace {

/// Rigid motions of one connected part: along x, along y, turning about its middle (scaled to displacements of order
/// 1).
struct Part {
  Eigen::Vector2d middle;
  double size;
  Eigen::Matrix3d held = Eigen::Matrix3d::Zero();  ///< sum of a a^T over all that resists a motion with amplitudes a

  [[nodiscard]] Eigen::Matrix<double, 2, 3> motion(const Eigen::Vector2d& at) const {
    const Eigen::Vector2d arm = (at - middle) / size;
    Eigen::Matrix<double, 2, 3> u;
    u << 1, 0, -arm.y(),  //
        0, 1, arm.x();
    return u;
  }
};

/// Part of every node, numbered from 0.
std::vector<int> connected_parts(const pfem::Mesh& mesh) {
  std::vector<int> root(static_cast<std::size_t>(mesh.n_nodes()));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[static_cast<std::size_t>(node)] != node) {
      auto& up = root[static_cast<std::size_t>(node)];
      up = root[static_cast<std::size_t>(up)];
      node = up;
    }
    return node;
  };
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int v = 1; v < 4; ++v)
      root[static_cast<std::size_t>(find(mesh.quads(v, element)))] = find(mesh.quads(0, element));
  std::vector<int> part(root.size(), -1);
  int n_parts = 0;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (find(node) == node) part[static_cast<std::size_t>(node)] = n_parts++;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    part[static_cast<std::size_t>(node)] = part[static_cast<std::size_t>(find(node))];
  return part;
}

std::vector<Part> make_parts(const pfem::Mesh& mesh, const std::vector<int>& part_of_node) {
  const auto n_parts = static_cast<std::size_t>(*std::max_element(part_of_node.begin(), part_of_node.end())) + 1;
  std::vector<Eigen::AlignedBox2d> box(n_parts);
  for (int node = 0; node < mesh.n_nodes(); ++node)
    box[static_cast<std::size_t>(part_of_node[static_cast<std::size_t>(node)])].extend(mesh.nodes.col(node));
  std::vector<Part> parts;
  for (const auto& b : box) parts.push_back({b.center(), b.diagonal().norm() / 2});
  return parts;
}

void add_supports(const PlateMesh& plate, const Unknowns& unknowns, const std::vector<int>& part_of_node,
                  std::vector<Part>& parts) {
  for (int node = 0; node < plate.mesh.n_nodes(); ++node) {
    Part& part = parts[static_cast<std::size_t>(part_of_node[static_cast<std::size_t>(node)])];
    const auto u = part.motion(plate.mesh.nodes.col(node));
    for (int component = 0; component < 2; ++component)
      if (!Unknowns::is_free(unknowns.target[static_cast<std::size_t>(2 * node + component)]))
        part.held += u.row(component).transpose() * u.row(component);
  }
}

void add_springs(const PlateScene& scene, const PlateMesh& plate, const std::vector<int>& part_of_node,
                 std::vector<Part>& parts) {
  for (std::size_t hole = 0; hole < scene.holes.size(); ++hole) {
    if (!scene.holes[hole].spring) continue;
    for (const auto& side : plate.rims[hole].sides) {
      const int node = plate.mesh.quads(0, side.element);
      Part& part = parts[static_cast<std::size_t>(part_of_node[static_cast<std::size_t>(node)])];
      const auto [rule, weight] = side_springs(*scene.holes[hole].spring, plate, side, 1);
      for (Eigen::Index q = 0; q < weight.size(); ++q) {
        if (weight[q] == 0) continue;
        const Eigen::RowVector3d along = rule.normal.col(q).transpose() * part.motion(rule.x.col(q));
        part.held += weight[q] / weight.sum() * along.transpose() * along;
      }
    }
  }
}

void add_line_springs(const PlateScene& scene, const PlateMesh& plate, const std::vector<int>& part_of_node,
                      std::vector<Part>& parts) {
  for (const int node : plate.point_nodes) {
    Part& part = parts[static_cast<std::size_t>(part_of_node[static_cast<std::size_t>(node)])];
    const auto u = part.motion(plate.mesh.nodes.col(node));
    for (const auto& direction : scene.disc_directions) {
      const Eigen::RowVector3d along = pfem::axis(direction).transpose() * u;
      part.held += along.transpose() * along;
    }
  }
}

std::string words(const Part& part, const Eigen::Vector3d& a) {
  constexpr double pure = 1e-6;
  if (std::abs(a[2]) < pure) {
    if (std::abs(a[1]) < pure) return "along x";
    if (std::abs(a[0]) < pure) return "along y";
    return fmt::format("along ({:.3g}, {:.3g})", a[0], a[1]);
  }
  const Eigen::Vector2d pole = part.middle + part.size * Eigen::Vector2d(-a[1], a[0]) / a[2];
  return fmt::format("by turning about ({:.4g}, {:.4g})", pole.x(), pole.y());
}

}  // namespace

void check_held(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  constexpr double free_to_move = 1e-10;  // share of the best held motion; rounding leaves about 1e-16
  const auto part_of_node = connected_parts(plate.mesh);
  auto parts = make_parts(plate.mesh, part_of_node);
  add_supports(plate, unknowns, part_of_node, parts);
  add_springs(scene, plate, part_of_node, parts);
  add_line_springs(scene, plate, part_of_node, parts);
  for (const auto& part : parts) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(part.held);
    if (eigen.eigenvalues()[0] > free_to_move * std::max(1.0, eigen.eigenvalues()[2])) continue;
    throw NumericalError(fmt::format(
        "{}: /supports: nothing keeps the {} from moving {} while all externals and discs are held; allowed: a plate "
        "that supports, externals, sprung holes and points hold against every rigid motion",
        scene.file,
        parts.size() == 1 ? std::string("plate")
                          : fmt::format("part of the plate around ({:g}, {:g})", part.middle.x(), part.middle.y()),
        words(part, eigen.eigenvectors().col(0))));
  }
}

}  // namespace fastjoint::stage1
