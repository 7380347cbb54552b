// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage3_nonlinear/path/path_result.hpp"

namespace fastjoint::stage3 {

/// Forces of rigid fasteners under each load alone: q of the condensed system is the sum of these, each times its load.
struct UnitLoads {
  std::vector<std::string> force;         ///< (u) "plate:external" without a given displacement, loaded or not
  Eigen::MatrixXd q_force;                ///< (n a, u) per unit force, dimensionless
  std::vector<std::string> displacement;  ///< (v) "plate:external" with a given one
  Eigen::MatrixXd q_displacement;         ///< (n a, v) per unit displacement, force / length
};

/// Work of each load on the displacements D_delta, which by reciprocity is its q, without another solve
/// (docs/theory.md, section 7.1).
[[nodiscard]] UnitLoads unit_loads(const JointModel& joint, const CondensedSystem& system);

/// A hole with friction and what its coefficient does to the rows of its fastener.
struct FrictionHole {
  struct Row {
    Eigen::Index at;              ///< among CondensedSystem::friction
    Eigen::VectorXd plus, minus;  ///< (n a) dH+ / dmu, dH- / dmu, dimensionless
  };
  std::string name;            ///< "plate:hole"
  std::size_t fastener, hole;  ///< hole of the fastener
  std::vector<Row> rows;
};

/// A number of a law, which all planes with that law share.
struct LawNumber {
  std::string law;
  Parameter parameter;
};

/// Numbers of the input that bearing forces are differentiated by, besides the load factor and every plane's clearance.
struct JointNumbers {
  std::vector<FrictionHole> friction;      ///< (f)
  std::vector<LawNumber> law;              ///< (l) laws in the order of the planes
  std::vector<Eigen::Index> first_of_law;  ///< (n) where the numbers of each plane's law begin
  UnitLoads loads;
};

[[nodiscard]] JointNumbers joint_numbers(const JointModel& joint, const CondensedSystem& system);

/// Derivatives of the n bearing forces by each number: with one direction of the signed forces, with two of their
/// amounts.
struct Sensitivity {
  Eigen::VectorXd load_factor;   ///< (n) force
  Eigen::MatrixXd clearance;     ///< (n, n) column: by the clearance of that plane, force / length
  Eigen::MatrixXd law;           ///< (n, l) force per unit of the number
  Eigen::MatrixXd mu;            ///< (n, f) force
  Eigen::MatrixXd force;         ///< (n, u) by UnitLoads::force at load factor 1, dimensionless
  Eigen::MatrixXd displacement;  ///< (n, v) by UnitLoads::displacement at load factor 1, force / length
};

/// Derivatives at one step, by the implicit function theorem with one factorisation of the tangent for all numbers
/// (docs/theory.md, section 10). They are one-sided where F has a corner.
///
/// Forces on a plate that gaps leave free (TangentCheck::mechanism) are differentiable by all numbers that leave it in
/// balance; derivatives by a load that would set it moving, and those of forces at a limit load, are infinite.
[[nodiscard]] Sensitivity sensitivity(const JointEquations& equations, const JointNumbers& numbers,
                                      const PathStep& step);

}  // namespace fastjoint::stage3
