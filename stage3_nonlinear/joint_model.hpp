// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "stage3_nonlinear/joint_scene.hpp"
#include "stage3_nonlinear/plate_model.hpp"

namespace fastjoint::stage3 {

/// Friction at one end of a fastener for one sign of its force, per unit |F|; empty without friction.
struct FrictionLoad {
  Eigen::VectorXd load;         ///< (m+e) R mu / c: force that must act on the plate's unknowns, dimensionless
  double resultant = 0;         ///< |resultant| mu / c: share of |F| that friction adds to what is transferred
  Eigen::Index case_index = 0;  ///< among the plate's friction cases
  double peak = 0;              ///< mu / c: peak stress Lambda of the case, 1 / length^2
};

enum Sign : std::size_t { positive_force, negative_force };
enum End : std::size_t { first_plate, second_plate };

/// Where a fastener holds a plate.
struct FastenerEnd {
  std::size_t plate = 0;
  Eigen::Index disc = 0;
  std::array<FrictionLoad, 2> friction;  ///< by Sign
};

/// A fastener, ready for the equations: delta = D(first) - D(second); it pushes the second disc with +F.
struct FastenerModel {
  std::string id;
  std::array<FastenerEnd, 2> ends;  ///< by End
  std::shared_ptr<const Law> law;
  double gap = 0;  ///< delta0 of the law + clearance, length
  bool one_sided = false;
};

/// Plates with their loads and fasteners; indices instead of names.
struct JointModel {
  std::string file;  ///< of the joint, for messages
  formats::Units units;
  int p = 0;
  std::vector<PlateModel> plates;
  std::vector<FastenerModel> fasteners;

  [[nodiscard]] Eigen::Index n_fasteners() const { return static_cast<Eigen::Index>(fasteners.size()); }
  /// First unknown of a plate in the joint's list, plate after plate.
  [[nodiscard]] Eigen::Index offset(std::size_t plate) const;
  [[nodiscard]] Eigen::Index n_unknowns() const { return offset(plates.size()); }
};

/// Reads the matrices of all plates and resolves every name.
///
/// @param p Degree, or 0 for the highest that all plates have.
/// Throws FileError, or InputError with the place in the joint's file or the dataset of a plate's.
[[nodiscard]] JointModel load_joint(const JointScene& scene, int p);

}  // namespace fastjoint::stage3
