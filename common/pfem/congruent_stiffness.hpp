// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "common/pfem/element_stiffness.hpp"

namespace fastjoint::pfem {

/// Stiffness matrices of a mesh's elements, integrated once for all that are congruent: of the same shape up to
/// translation (to 1e-12 of the element's size, far above the rounding of coordinates and far below what a stiffness
/// shows) and of the same material. A panel of riveted cells has eight different elements, not thousands.
class CongruentStiffness {
 public:
  /// @param elasticity Of each material of the mesh, (3, 3), stress.
  CongruentStiffness(const Mesh& mesh, const Edges& edges, const std::vector<Eigen::Matrix3d>& elasticity, Space space,
                     int p);

  /// Index of the element's shape and material among the different ones, in the order in which they are asked for.
  [[nodiscard]] int shape_of(int element);
  /// Of unit thickness, shape (2 n_modes, 2 n_modes) as ElementStiffness has it, force / length^2.
  [[nodiscard]] const Eigen::MatrixXd& of_shape(int shape) const { return stiffness_[static_cast<std::size_t>(shape)]; }
  [[nodiscard]] const Eigen::MatrixXd& operator()(int element) { return of_shape(shape_of(element)); }
  [[nodiscard]] std::vector<Eigen::MatrixXd> matrices() && { return std::move(stiffness_); }
  [[nodiscard]] int n_different() const { return static_cast<int>(stiffness_.size()); }

 private:
  using Shape = std::vector<std::int64_t>;
  [[nodiscard]] Shape shape(int element) const;

  const Mesh& mesh_;
  const Edges& edges_;
  const std::vector<Eigen::Matrix3d>& elasticity_;
  ElementStiffness integrate_;
  std::map<Shape, int> index_;
  std::vector<Eigen::MatrixXd> stiffness_;
};

}  // namespace fastjoint::pfem
