// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Displacements and forces of one plate of a joint, one row per increment.
struct PlateHistory {
  std::string name;
  std::vector<std::string> disc_hole, disc_direction, external_id;
  Eigen::MatrixXd D;   ///< (steps, m) disc displacements, length
  Eigen::MatrixXd De;  ///< (steps, e) displacements of the rigid externals, length
  Eigen::MatrixXd Pe;  ///< (steps, e) forces on them, force
};

/// What a joint did under its load increments (schemas/joint-result.md): the converged ones only.
struct JointResult {
  Header header;
  bool complete = false;                                  ///< every increment asked for converged
  Eigen::VectorXd load_factor;                            ///< (steps)
  Eigen::VectorXi converged;                              ///< (steps) 1
  Eigen::VectorXi iterations;                             ///< (steps) of the nonlinear solver, failed tries included
  Eigen::VectorXd residual;                               ///< (steps) largest, relative to the largest force
  std::vector<std::string> fastener_id;                   ///< (n)
  Eigen::MatrixXd delta;                                  ///< (steps, n) relative displacement of the discs, length
  Eigen::MatrixXd F;                                      ///< (steps, n) bearing force, argument of the law
  Eigen::MatrixXd transferred_first, transferred_second;  ///< (steps, n) F + friction resultant on each plate
  std::vector<PlateHistory> plates;
};

/// Throws FileError; what was at `path` before survives.
void write(const std::string& path, const JointResult& result);
[[nodiscard]] JointResult read_joint_result(const std::string& path);

}  // namespace fastjoint::formats
