// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Numbers that engineers read off one hole of a plate at one increment; rim_quantities says what each member is.
struct RimValues {
  double bearing_load = 0, bearing_load_y = 0, bearing_stress = 0;
  double bypass_load = 0, bypass_error = 0;
  double peak_hoop = 0, peak_angle = 0, peak_error = 0;
  double against_slip = 0;                                ///< of contact with friction
  double gross_concentration = 0, net_concentration = 0;  ///< by the larger section force; 0 where there is none
};

enum class Dimension { force, stress, angle, ratio };
[[nodiscard]] std::string unit_of(Dimension dimension, const Units& units);

/// A member of RimValues as a dataset of RESULT.h5 and as a column of the CSV.
struct RimQuantity {
  const char* name;
  double RimValues::*value;
  Dimension dimension;
  const char* meaning;
  bool needs_section = false;  ///< not known of a hole without a section across x
  bool is_error = false;       ///< infinite where one degree alone says nothing
};
/// All members, in the order of the columns.
[[nodiscard]] std::span<const RimQuantity> rim_quantities();

/// Stresses of the sheet at points around its holes, one row per increment.
struct RimStresses {
  Eigen::VectorXi start;       ///< (r + 1) first point of each rim, and k; a rim without a closed form has none
  Eigen::VectorXd angle;       ///< (k) counter-clockwise from x, degrees
  Eigen::MatrixXd rr, tt, rt;  ///< (steps, k) stress
};

/// The holes of a plate, open ones included, at every increment.
struct RimHistory {
  std::vector<std::string> hole;               ///< (r); none if the plate's matrices hold no stresses at this degree
  Eigen::VectorXi sections;                    ///< (r) how many sections across x beside the hole the plate has
  std::vector<std::vector<RimValues>> values;  ///< (steps) (r)
  std::optional<RimStresses> stresses{};       ///< if they were asked for
};

/// Forces of fasteners on the m discs of a plate: resultants on its rims along the discs' directions, force.
struct DiscForces {
  Eigen::MatrixXd bearing, friction;  ///< (steps, m)
};

/// Contact at the g rims of a plate whose springs push but do not pull, one row per increment.
struct ContactHistory {
  Eigen::VectorXd gap;  ///< (g) radial; interference is negative, length
  // These three belong to a joint with interference; in others they are 0, 0 and infinite.
  Eigen::VectorXd no_load_peak, no_load_least;  ///< (g) largest and least pressure at no load, stress
  /// (g) load factor at which a rim with interference first loses full contact; infinite if it does not up to 1
  Eigen::VectorXd full_until;
  Eigen::MatrixXd touching;       ///< (steps, g) angle over which disc and rim touch, degrees
  Eigen::MatrixXd from, to;       ///< (steps, g) ends of the widest arc on which they touch, degrees; 0 without one
  Eigen::MatrixXd peak_pressure;  ///< (steps, g) stress
  Eigen::MatrixXd peak_angle;     ///< (steps, g) of that pressure, or of the least gap, degrees
  Eigen::MatrixXd least_gap;      ///< (steps, g) between disc and rim, 0 where they touch, length
};

/// Displacements and forces of one plate of a joint, one row per increment.
struct PlateHistory {
  std::string name;
  std::vector<std::string> disc_hole, disc_direction, external_id, traction_id;
  std::vector<std::string> traction_bearing{};  ///< (q) as UnitCases has it
  std::vector<ContactRim> contact{};            ///< (g)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::MatrixXd D;             ///< (steps, m) disc displacements, length
  Eigen::MatrixXd De;            ///< (steps, e) displacements of the rigid externals, length
  Eigen::MatrixXd Pe;            ///< (steps, e) forces on them, force
  std::vector<WaveRim> waves{};  ///< (g) waves of the rims of contact
  Eigen::MatrixXd amounts{};     ///< (steps, k) amount of each of these waves, stress
  Eigen::MatrixXd w{};  ///< (steps, sum of sizes) of the disc's normal displacement against the sheet each wave, length
  ContactHistory contacts{};
  Eigen::MatrixXd Lambda;    ///< (steps, h) peak stress of each friction case, stress
  Eigen::MatrixXd traction;  ///< (steps, q) force on each traction boundary, force
  RimHistory rims;
  std::optional<DiscForces> disc_forces{};        ///< none in files before version 1.5
  std::string matrices_digest{}, plate_digest{};  ///< of its MATRICES.h5, and of its PLATE.h5; empty if unknown
};

/// Derivatives of the peak hoop stresses of r holes by the numbers of a SensitivityHistory, at one increment, stress
/// per unit of the number.
struct PeakSlopes {
  std::vector<std::string> hole;                                 ///< (r) "plate:hole"
  Eigen::VectorXd load_factor;                                   ///< (r)
  Eigen::MatrixXd clearance, law, mu, force, displacement, gap;  ///< (r, n), (r, l), (r, f), (r, u), (r, v), (r, g)
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
  std::vector<std::string> gap_hole{};                      ///< (g) "plate:hole", each with springs that only push
  std::vector<Eigen::MatrixXd> gap{};                       ///< (steps) (n, g) by its gap, force / length
  PeakSlopes peak{};                                        ///< at the last increment
};

/// The states of a joint under its load increments (schemas/joint-result.md): the converged ones only.
struct JointResult {
  Header header;
  int p = 0;                       ///< degree of the matrices
  bool complete = false;           ///< every increment asked for converged
  Eigen::VectorXd load_factor;     ///< (steps)
  Eigen::VectorXi converged;       ///< (steps) 1
  Eigen::VectorXi iterations;      ///< (steps) of the nonlinear solver, failed tries included
  Eigen::VectorXd residual;        ///< (steps) largest, relative to the largest force
  std::vector<std::string> event;  ///< (steps) what fasteners do exactly there, and rims of contact by then
  // The n shear planes have one entry each: one plane for each neighbouring pair of a fastener's plates, fastener after
  // fastener.
  std::vector<std::string> fastener_id;              ///< (n)
  std::vector<std::string> first_hole, second_hole;  ///< (n) "plate:hole"; "ground" may be second
  std::vector<std::string> direction;                ///< (a) of the joint's discs: "x", "y"
  Eigen::MatrixXd delta;                             ///< (steps, n) relative displacement of the discs, length
  Eigen::MatrixXd F;                                 ///< (steps, n) force of the law at delta
  std::optional<Eigen::MatrixXd> F_error;            ///< (steps, n) estimated, if the plates' errors are known
  Eigen::MatrixXd delta_vector, F_vector;            ///< (steps, n a) their components, directions inner
  Eigen::MatrixXd transferred;  ///< (steps, n 2) F + friction resultant on each plane's first, then second plate
  std::vector<std::string> load_external;  ///< (s) "plate:external" of each load other than zero
  Eigen::MatrixXd load_stiffness;          ///< (steps, s) dP over du as all loads grow together, force / length
  std::vector<PlateHistory> plates;
  std::optional<SensitivityHistory> sensitivity;  ///< if it was asked for
};

/// Throws FileError; what was at `path` before survives.
void write(const std::string& path, const JointResult& result);
[[nodiscard]] JointResult read_joint_result(const std::string& path);

}  // namespace fastjoint::formats
