// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/errors.hpp"
#include "common/plate/springs.hpp"

namespace fastjoint::stage1 {
namespace {

/// Rigid motions of one connected part: along x, along y, rotation about its centre (scaled to displacements of order
/// 1).
struct Part {
  Eigen::Vector2d middle;
  double size;

  [[nodiscard]] Eigen::Matrix<double, 2, 3> motion(const Eigen::Vector2d& at) const {
    const Eigen::Vector2d arm = (at - middle) / size;
    Eigen::Matrix<double, 2, 3> u;
    u << 1, 0, -arm.y(),  //
        0, 1, arm.x();
    return u;
  }
};

/// Index of the connected part of every node.
std::vector<int> connected_parts(const pfem::Mesh& mesh) {
  std::vector<int> root(mesh.n_nodes());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[node] != node) {
      auto& up = root[node];
      up = root[up];
      node = up;
    }
    return node;
  };
  for (int element = 0; element < mesh.n_elements(); ++element)
    for (int v = 1; v < 4; ++v) root[find(mesh.quads(v, element))] = find(mesh.quads(0, element));
  std::vector<int> part(root.size(), -1);
  int n_parts = 0;
  for (int node = 0; node < mesh.n_nodes(); ++node)
    if (find(node) == node) part[node] = n_parts++;
  for (int node = 0; node < mesh.n_nodes(); ++node) part[node] = part[find(node)];
  return part;
}

std::vector<Part> make_parts(const pfem::Mesh& mesh, const std::vector<int>& part_of_node) {
  const int n_parts = *std::max_element(part_of_node.begin(), part_of_node.end()) + 1;
  std::vector<Eigen::AlignedBox2d> box(n_parts);
  for (int node = 0; node < mesh.n_nodes(); ++node) box[part_of_node[node]].extend(mesh.nodes.col(node));
  std::vector<Part> parts;
  for (const auto& b : box) parts.push_back({b.center(), b.diagonal().norm() / 2});
  return parts;
}

/// Stiffness of supports, springs and points against the rigid motions of every part, with all externals and discs
/// fixed.
struct RigidStiffness {
  RigidStiffness(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns)
      : part_of(connected_parts(plate.mesh)),
        parts(make_parts(plate.mesh, part_of)),
        stiffness(parts.size(), Eigen::Matrix3d::Zero()) {
    add_supports(plate, unknowns);
    add_springs(scene, plate);
    add_line_springs(scene, plate);
  }

  std::vector<int> part_of;  ///< index into parts of each node
  std::vector<Part> parts;
  std::vector<Eigen::Matrix3d> stiffness;  ///< of each part for the amplitudes of its motions, dimensionless

 private:
  /// Adds a constraint with the energy (a . amplitudes)^2.
  void add(int part, const Eigen::RowVector3d& a) { stiffness[part] += a.transpose() * a; }

  void add_supports(const PlateMesh& plate, const Unknowns& unknowns) {
    for (int node = 0; node < plate.mesh.n_nodes(); ++node) {
      const int part = part_of[node];
      const auto u = parts[part].motion(plate.mesh.nodes.col(node));
      for (int component = 0; component < 2; ++component)
        if (!pfem::is_free(unknowns.dofs(component, node))) add(part, u.row(component));
    }
  }

  void add_springs(const PlateScene& scene, const PlateMesh& plate) {
    for (int hole = 0; hole < count_of(scene.holes); ++hole) {
      if (!scene.holes[hole].spring) continue;
      for (const auto& side : plate.rims[hole].sides) {
        const int part = part_of[plate.mesh.quads(0, side.element)];
        const auto [rule, weight] = plate::side_springs(scene.holes[hole].sprung(), plate.mesh, plate.edges, side, 1);
        for (int q = 0; q < weight.size(); ++q) {
          if (weight[q] == 0) continue;
          const Eigen::RowVector2d along = std::sqrt(weight[q] / weight.sum()) * rule.normal.col(q).transpose();
          add(part, along * parts[part].motion(rule.x.col(q)));
        }
      }
    }
  }

  void add_line_springs(const PlateScene& scene, const PlateMesh& plate) {
    for (const int node : plate.point_nodes) {
      const auto u = parts[part_of[node]].motion(plate.mesh.nodes.col(node));
      for (const rim::Axis direction : scene.disc_directions)
        add(part_of[node], rim::unit_vector(direction).transpose() * u);
    }
  }
};

constexpr double min_stiffness = 1e-13;  // relative to the stiffest motion; rounding is about 1e-16

std::string words(const Part& part, const Eigen::Vector3d& a) {
  constexpr double pure = 1e-6;
  if (std::abs(a[2]) < pure) {
    if (std::abs(a[1]) < pure) return "along x";
    if (std::abs(a[0]) < pure) return "along y";
    return fmt::format("along ({:.3g}, {:.3g})", a[0], a[1]);
  }
  const Eigen::Vector2d pole = part.middle + part.size * Eigen::Vector2d(-a[1], a[0]) / a[2];
  return fmt::format("by rotation about ({:.4g}, {:.4g})", pole.x(), pole.y());
}

}  // namespace

void check_rigid_motions(const PlateScene& scene, const PlateMesh& plate, const Unknowns& unknowns) {
  const RigidStiffness all(scene, plate, unknowns);
  for (int i = 0; i < count_of(all.parts); ++i) {
    const Part& part = all.parts[i];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(all.stiffness[i]);
    if (eigen.eigenvalues()[0] > min_stiffness * std::max(1.0, eigen.eigenvalues()[2])) continue;
    std::string missing;
    for (const auto& each : missing_symmetry(scene, plate, unknowns)) missing += ". " + each;
    throw NumericalError(fmt::format(
        "{}: /supports: the {} is free to move {} while all externals and discs are fixed; allowed: a plate "
        "whose supports, externals, holes with springs and points prevent every rigid motion{}",
        scene.file,
        all.parts.size() == 1 ? std::string("plate")
                              : fmt::format("part of the plate around ({:g}, {:g})", part.middle.x(), part.middle.y()),
        words(part, eigen.eigenvectors().col(0)), missing));
  }
}

}  // namespace fastjoint::stage1
