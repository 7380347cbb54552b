// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/joint_state.hpp"

namespace fastjoint::stage3 {

/// A hole with friction and what its coefficient does to the rows of its fastener.
struct FrictionHole {
  struct Row {
    Index at;              ///< among CondensedSystem::friction
    VectorXd plus, minus;  ///< (n a) dH+ / dmu, dH- / dmu, dimensionless
  };
  std::string name;      ///< "plate:hole"
  Index fastener, hole;  ///< hole of the fastener
  std::vector<Row> rows;
};

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
  /// Number of derivatives of each force, those by the load factor and by the clearances of all planes included.
  [[nodiscard]] Index n_derivatives() const {
    return 1 + std::ssize(first_of_law) + std::ssize(law) + std::ssize(friction) + std::ssize(shears) +
           std::ssize(force) + std::ssize(displacement) + std::ssize(gap);
  }
};

/// The numbers by name, without what they do to the joint: no FrictionHole::rows, no q.
[[nodiscard]] JointNumbers names_of_numbers(const JointModel& joint);
[[nodiscard]] JointNumbers joint_numbers(const JointModel& joint, const CondensedSystem& system);

/// Derivatives of the n bearing forces by each number: with one direction of the signed forces, with two of their
/// amounts.
struct Sensitivity {
  VectorXd load_factor;   ///< (n) force
  MatrixXd clearance;     ///< (n, n) column: by the clearance of that plane, force / length
  MatrixXd law;           ///< (n, l) force per unit of the number
  MatrixXd mu;            ///< (n, f) force
  MatrixXd force;         ///< (n, u) by JointNumbers::force at load factor 1, dimensionless
  MatrixXd displacement;  ///< (n, v) by JointNumbers::displacement at load factor 1, force / length
  MatrixXd gap;           ///< (n, g) by the gap of each rim of contact, force / length
};

/// Derivatives at one step, by the implicit function theorem with one factorisation of the tangent for all numbers
/// (docs/theory.md, section 10). They are one-sided where F has a corner.
///
/// Forces on a plate that gaps leave free (TangentCheck::mechanism) are differentiable by all numbers that leave it in
/// balance; derivatives by a load that would set it moving, and those of forces at a limit load, are infinite.
[[nodiscard]] Sensitivity sensitivity(const JointEquations& equations, const JointNumbers& numbers,
                                      const PathStep& step);

/// Estimated errors of the n bearing forces (with two directions of their amounts) by those of the plates' matrices,
/// shape (steps, n), force; none if those of a plate are not known.
///
/// An error of a plate's matrices acts, to first order, as a load on its unknowns; implicit_slopes gives what that load
/// does to each force. The last change with p is extrapolated as the plate's energy is, and errors of several plates
/// are added without sign (docs/theory.md, section 5.3).
///
/// The file's own S_error counts for matrices of one degree, as from a laboratory, with the worst sign of every entry.
/// Errors of forces at a limit load are infinite.
[[nodiscard]] std::optional<MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations,
                                                   const LoadPath& path, const std::vector<JointState>& states);

}  // namespace fastjoint::stage3
