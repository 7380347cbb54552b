// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/condensed_system.hpp"

namespace fastjoint::stage3 {

/// A hole with friction and what its coefficient does to the rows of its fastener.
struct FrictionHole {
  struct Row {
    Index at;                         ///< among CondensedSystem::friction
    Index plate;                      ///< of the row's hole
    std::array<Index, 2> case_index;  ///< of the plate, by side
    VectorXd plus, minus;             ///< (r) dH+ / dmu, dH- / dmu, dimensionless
    // The next two have an entry for each side: dG / dmu, force on the plate's unknowns, dimensionless, and the
    // derivative of FrictionLoad::peak by mu, 1 / length^2.
    std::array<VectorXd, 2> load;
    std::array<double, 2> peak;
  };
  std::string name;      ///< "plate:hole"
  Index fastener, hole;  ///< hole of the fastener
  std::vector<Row> rows;
};

/// What a unit of a load is to a plate.
struct UnitLoad {
  Index plate;
  VectorXd load;  ///< on the plate's unknowns; of a displacement what it asks of them, less what they give
  std::optional<Index> traction;   ///< that carries it
  std::optional<Index> displaced;  ///< unknown that it moves
};
/// The unit loads of all forces that externals may carry, whether they do or not, in the order of the plates, at
/// positive or negative load factors.
[[nodiscard]] std::vector<UnitLoad> unit_forces(const JointModel& joint, double load_factor);
/// The unit loads of all given displacements.
[[nodiscard]] std::vector<UnitLoad> unit_displacements(const JointModel& joint);

/// Numbers of the input that bearing forces are differentiated by, besides the load factor and every plane's clearance.
struct JointNumbers {
  std::vector<FrictionHole> friction;  ///< (f)
  /// (l) names and numbers of the laws in the order of the planes; planes with one law share its numbers.
  std::vector<std::pair<std::string, Parameter>> law;
  std::vector<Index> first_of_law;  ///< (n) where the numbers of each plane's law begin
  // Forces of rigid fasteners under each load alone: q of the condensed system is their sum, each times its load.
  std::vector<std::string> force;         ///< (u) "plate:external" without a given displacement, loaded or not
  MatrixXd q_force{};                     ///< (n a, u) per unit force, dimensionless
  std::vector<std::string> displacement;  ///< (v) "plate:external" with a given one
  MatrixXd q_displacement{};              ///< (n a, v) per unit displacement, force / length
  std::vector<std::string> shears{};      ///< (s) "plate:hole" of each rim of contact with friction, in their order
  std::vector<std::string> gap{};         ///< (g) "plate:hole" of each rim of contact, in their order
  MatrixXd q_force_reversed{};  ///< q_force at negative load factors, where loads in holes bear on other sides

  /// q_force at a load factor.
  [[nodiscard]] const MatrixXd& q_force_at(double load_factor) const {
    return load_factor < 0 ? q_force_reversed : q_force;
  }
  /// Number of derivatives of each force: by the load factor, the clearances of all planes, the numbers of laws, the
  /// coefficients of friction (first `friction`, then `shears`), forces, displacements, gaps, in this order.
  [[nodiscard]] Index n_derivatives() const {
    return 1 + std::ssize(first_of_law) + std::ssize(law) + std::ssize(friction) + std::ssize(shears) +
           std::ssize(force) + std::ssize(displacement) + std::ssize(gap);
  }
};

/// The numbers by name, without what they do to the joint: no FrictionHole::rows, no q.
[[nodiscard]] JointNumbers names_of_numbers(const JointModel& joint);
[[nodiscard]] JointNumbers joint_numbers(const JointModel& joint, const CondensedSystem& system);

}  // namespace fastjoint::stage3
