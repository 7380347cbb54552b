// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// What engineers read off the holes of a plate, open ones included, one row per increment; all of shape (steps, r).
struct RimHistory {
  std::vector<std::string> hole;   ///< (r); none if the plate's matrices hold no stresses at this degree
  Eigen::MatrixXd bearing_load;    ///< along x on the plate, 0 of an open hole, force
  Eigen::MatrixXd bearing_load_y;  ///< along y
  Eigen::MatrixXd bearing_stress;  ///< |bearing load| / (d t), stress
  Eigen::MatrixXd peak_hoop;       ///< largest hoop stress, tension positive, stress
  Eigen::MatrixXd peak_angle;      ///< where, degrees counter-clockwise from x
  Eigen::MatrixXd peak_error;  ///< estimated error of the peak; infinite where one degree alone says nothing, stress
  Eigen::VectorXi sections;    ///< (r) how many of the two sections beside the hole across x the plate has
  // 0 where it has none of them:
  Eigen::MatrixXd bypass_load;          ///< force that passes the fastener by, tension positive
  Eigen::MatrixXd bypass_error;         ///< estimated; infinite where one degree alone says nothing
  Eigen::MatrixXd gross_concentration;  ///< peak over the larger section force per gross area; 0 if that is 0
  Eigen::MatrixXd net_concentration;    ///< the same per net area
};

/// Displacements and forces of one plate of a joint, one row per increment.
struct PlateHistory {
  std::string name;
  std::vector<std::string> disc_hole, disc_direction, external_id, traction_id;
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::MatrixXd D;         ///< (steps, m) disc displacements, length
  Eigen::MatrixXd De;        ///< (steps, e) displacements of the rigid externals, length
  Eigen::MatrixXd Pe;        ///< (steps, e) forces on them, force
  Eigen::MatrixXd Lambda;    ///< (steps, h) peak stress of each friction case, stress
  Eigen::MatrixXd traction;  ///< (steps, q) force on each traction boundary, force
  RimHistory rims;
  std::string matrices_digest{}, plate_digest{};  ///< of its MATRICES.h5, and of its PLATE.h5; empty if unknown
};

/// Derivatives of the bearing forces F by what the input gives, one matrix of n rows per increment; infinite where the
/// joint has none.
struct SensitivityHistory {
  Eigen::MatrixXd load_factor;                              ///< (steps, n) force
  std::vector<Eigen::MatrixXd> clearance;                   ///< (steps) (n, n) by that of each plane, force / length
  std::vector<std::string> mu_hole;                         ///< (f) "plate:hole", each with friction
  std::vector<Eigen::MatrixXd> mu;                          ///< (steps) (n, f) force
  std::vector<std::string> law_name, law_number, law_unit;  ///< (l) numbers of the laws; units of the derivatives
  std::vector<Eigen::MatrixXd> law;                         ///< (steps) (n, l) law_unit
  std::vector<std::string> force_external;                  ///< (u) "plate:external", loaded by a force or by none
  std::vector<Eigen::MatrixXd> force;                       ///< (steps) (n, u) by the force at load factor 1
  std::vector<std::string> displacement_external;           ///< (v) "plate:external" whose displacement is given
  std::vector<Eigen::MatrixXd> displacement;                ///< (steps) (n, v) by it at load factor 1, force / length
};

/// What a joint did under its load increments (schemas/joint-result.md): the converged ones only.
struct JointResult {
  Header header;
  int p = 0;                    ///< degree of the matrices
  bool complete = false;        ///< every increment asked for converged
  Eigen::VectorXd load_factor;  ///< (steps)
  Eigen::VectorXi converged;    ///< (steps) 1
  Eigen::VectorXi iterations;   ///< (steps) of the nonlinear solver, failed tries included; of an exact path its pieces
  Eigen::VectorXd residual;     ///< (steps) largest, relative to the largest force
  std::vector<std::string> event;  ///< (steps) fasteners that begin or cease to bear exactly there, or pass a corner
  // The n shear planes have one entry each: one plane for each neighbouring pair of a fastener's plates, fastener after
  // fastener.
  std::vector<std::string> fastener_id;                   ///< (n)
  std::vector<std::string> first_hole, second_hole;       ///< (n) "plate:hole"
  std::vector<std::string> direction;                     ///< (a) of the joint's discs: "x", "y"
  Eigen::MatrixXd delta;                                  ///< (steps, n) relative displacement of the discs, length
  Eigen::MatrixXd F;                                      ///< (steps, n) bearing force, argument of the law
  std::optional<Eigen::MatrixXd> F_error;                 ///< (steps, n) estimated, if the plates' errors are known
  Eigen::MatrixXd delta_vector, F_vector;                 ///< (steps, n a) their components, directions inner
  Eigen::MatrixXd transferred_first, transferred_second;  ///< (steps, n) F + friction resultant on each plate
  std::vector<PlateHistory> plates;
  std::optional<SensitivityHistory> sensitivity;  ///< if it was asked for
};

/// Throws FileError; what was at `path` before survives.
void write(const std::string& path, const JointResult& result);
[[nodiscard]] JointResult read_joint_result(const std::string& path);

}  // namespace fastjoint::formats
