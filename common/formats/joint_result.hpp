// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/formats/header.hpp"

namespace fastjoint::formats {

/// Engineering quantities of one hole of a plate at one increment; rim_quantities describes each member.
struct RimValues {
  double bearing_load = 0, bearing_load_y = 0, bearing_stress = 0;
  double bypass_load = 0, bypass_error = 0;
  double peak_hoop = 0, peak_angle = 0, peak_error = 0;   ///< NaN, NaN and infinite where it is not known
  double against_slip = 0;                                ///< in contact with friction
  double gross_concentration = 0, net_concentration = 0;  ///< for the larger section force; 0 without one
  double net_stress = 0;                                  ///< largest tension over the net sections, in any direction
  double bypass_stress = 0;                               ///< bypass load over the gross section, tension positive
  double bypass_across = 0;                               ///< the other principal stress of what passes by
  double bypass_direction = 0, net_direction = 0;         ///< of these two, degrees
};

enum class Dimension { force, stress, angle, ratio };
[[nodiscard]] std::string unit_of(Dimension dimension, const Units& units);

/// A member of RimValues as a dataset of RESULT.h5 and as a column of the CSV.
struct RimQuantity {
  const char* name;
  double RimValues::*value;
  Dimension dimension;
  const char* meaning;
  bool needs_section = false;   ///< unknown for a hole without sections
  bool is_error = false;        ///< infinite for a single degree, which gives no estimate
  bool may_be_unknown = false;  ///< infinite where it is not known
  bool may_be_nan = false;      ///< NaN where it is not known
};
/// All members, in the order of the columns.
[[nodiscard]] std::span<const RimQuantity> rim_quantities();

/// Stresses of the sheet at points around its holes, one row per increment.
struct RimStresses {
  Eigen::VectorXi start;       ///< (r + 1) first point of each rim, and k; rims without a closed form have no points
  Eigen::VectorXd angle;       ///< (k) counter-clockwise from x, degrees
  Eigen::MatrixXd rr, tt, rt;  ///< (steps, k) stress
};

/// Stresses on circles around the holes of a plate at one distance from their rims, one row per increment.
struct NearStresses {
  double distance = 0;                 ///< from the rims, length
  Eigen::MatrixXd peak, angle, error;  ///< (steps, r) largest hoop stress, its place in degrees, and its error, stress
  Eigen::MatrixXd rr{}, tt{}, rt{};    ///< (steps, k) at the angles of RimStresses; none without those
};

/// The holes of a plate, including open ones, at every increment.
struct RimHistory {
  std::vector<std::string> hole;             ///< (r); empty if the plate's matrices have no stresses at this degree
  Eigen::VectorXi sections;                  ///< (r) number of sections next to the hole
  Eigen::MatrixXd center{};                  ///< (r, 2) length
  Eigen::VectorXd radius{}, thickness{};     ///< (r) length; 0 if not known
  Eigen::VectorXd gross_area{}, net_area{};  ///< (r) of the smaller section across x next to the hole; 0 without one
  Eigen::VectorXd gross_area_y{}, net_area_y{};  ///< (r) the same across y
  std::vector<std::vector<RimValues>> values;    ///< (steps) (r)
  std::optional<RimStresses> stresses{};         ///< if requested
  std::optional<NearStresses> near{};            ///< if requested
};

/// Forces of fasteners on the m discs of a plate: resultants on its rims along the discs' directions, force.
struct DiscForces {
  Eigen::MatrixXd bearing, friction;  ///< (steps, m)
};

/// Contact at the g rims of a plate with compression-only springs, one row per increment.
struct ContactHistory {
  Eigen::VectorXd gap;  ///< (g) radial gap, negative for interference, length
  // The next three are for a joint with interference; in others they are 0, 0 and infinite.
  Eigen::VectorXd no_load_peak, no_load_least;  ///< (g) maximum and minimum pressure at no load, stress
  /// (g) load factor at which a rim with interference first loses full contact; infinite if it does not up to 1
  Eigen::VectorXd full_until;
  Eigen::MatrixXd touching;       ///< (steps, g) angle of contact between disc and rim, degrees
  Eigen::MatrixXd from, to;       ///< (steps, g) ends of the widest arc in contact, degrees; 0 without one
  Eigen::MatrixXd peak_pressure;  ///< (steps, g) stress
  Eigen::MatrixXd peak_angle;     ///< (steps, g) angle of that pressure, or of the minimum gap, degrees
  Eigen::MatrixXd least_gap;      ///< (steps, g) minimum gap between disc and rim, 0 in contact, length
};

/// Stress intensity factors of the t crack tips of a plate, stress length^1/2.
struct CrackHistory {
  std::vector<std::string> tip;                      ///< (t)
  Eigen::MatrixXd at;                                ///< (t, 2) x and y, length
  Eigen::VectorXd length;                            ///< (t) of the crack up to the tip, length
  Eigen::MatrixXd K_I, K_II, K_I_error, K_II_error;  ///< (steps, t)
};

/// Forces along one axis on the rows of a plate's holes, whose discs move along it.
struct RowHistory {
  std::vector<std::string> direction;  ///< (w) "x" or "y"
  Eigen::VectorXd at;                  ///< (w) coordinate along it, length
  Eigen::VectorXi holes;               ///< (w) number of holes
  Eigen::MatrixXd force;               ///< (steps, w) of the fasteners on the plate
  Eigen::MatrixXd before, after;       ///< (steps, w) of the plate over the sections next to the row; infinite: unknown
};

/// Displacements and forces of one plate of a joint, one row per increment.
struct PlateHistory {
  std::string name;
  std::vector<std::string> disc_hole, disc_direction, external_id, traction_id;
  std::vector<std::string> traction_bearing{};  ///< (q) as in UnitCases
  std::vector<ContactRim> contact{};            ///< (g)
  std::vector<std::string> friction_hole, friction_bearing;
  Eigen::MatrixXd D;   ///< (steps, m) disc displacements, length
  Eigen::MatrixXd De;  ///< (steps, e) displacements of the rigid externals, length
  /// Parts of D and De that deform nothing: the free shape of the sheet by temperature and holes off their place
  Eigen::MatrixXd free_D{}, free_De{};
  Eigen::MatrixXd Pe;            ///< (steps, e) forces on them, force
  std::vector<WaveRim> waves{};  ///< (g) waves of the rims in contact
  Eigen::MatrixXd amounts{};     ///< (steps, k) amplitude of each of these waves, stress
  Eigen::MatrixXd w{};  ///< (steps, sum of sizes) waves of the disc's normal displacement relative to the sheet, length
  ContactHistory contacts{};
  Eigen::MatrixXd Lambda;                                    ///< (steps, h) peak stress of each friction case, stress
  Eigen::MatrixXd traction;                                  ///< (steps, q) force on each traction boundary, force
  std::vector<double> traction_arm{};                        ///< (q) as in UnitCases
  Eigen::MatrixXd traction_displacement{};                   ///< (steps, q) their mean, length; infinite: unknown
  Eigen::MatrixXd applied{}, by_fasteners{}, by_supports{};  ///< (steps, 2) resultants along x and y, force
  RowHistory rows{};
  RimHistory rims;
  CrackHistory cracks{};
  Border border{};
  std::optional<DiscForces> disc_forces{};        ///< missing in files before version 1.5
  std::string materials{};                        ///< JSON text of "materials" in its PLATE.json; empty if unknown
  std::string matrices_digest{}, plate_digest{};  ///< digests of its MATRICES.h5 and PLATE.h5; empty if unknown
};

/// Derivatives of the peak hoop stresses of r holes with respect to the parameters of a SensitivityHistory, at one
/// increment, stress per unit of the parameter.
struct PeakSlopes {
  std::vector<std::string> hole;                                 ///< (r) "plate:hole"
  Eigen::VectorXd load_factor;                                   ///< (r)
  Eigen::MatrixXd clearance, law, mu, force, displacement, gap;  ///< (r, n), (r, l), (r, f), (r, u), (r, v), (r, g)
};

/// Derivatives of the bearing forces F with respect to parameters of the input, one matrix of n rows per increment;
/// infinite where they do not exist.
struct SensitivityHistory {
  Eigen::MatrixXd load_factor;             ///< (steps, n) force
  std::vector<Eigen::MatrixXd> clearance;  ///< (steps) (n, n) by the clearance of each plane, force / length
  std::vector<std::string> mu_hole;        ///< (f) "plate:hole", each with friction
  std::vector<Eigen::MatrixXd> mu;         ///< (steps) (n, f) force
  std::vector<std::string> law_name, law_number, law_unit;  ///< (l) parameters of the laws; units of the derivatives
  std::vector<Eigen::MatrixXd> law;                         ///< (steps) (n, l) law_unit
  std::vector<std::string> force_external;                  ///< (u) "plate:external" under a force or without load
  std::vector<Eigen::MatrixXd> force;                       ///< (steps) (n, u) by the force at load factor 1
  std::vector<std::string> displacement_external;           ///< (v) "plate:external" with prescribed displacement
  std::vector<Eigen::MatrixXd> displacement;                ///< (steps) (n, v) by it at load factor 1, force / length
  std::vector<std::string> gap_hole{};                      ///< (g) "plate:hole", each with compression-only springs
  std::vector<Eigen::MatrixXd> gap{};                       ///< (steps) (n, g) by its gap, force / length
  PeakSlopes peak{};                                        ///< at the last increment
};

/// Largest and smallest values of one quantity over all increments of all load cases.
struct EnvelopeTable {
  std::string quantity, unit;
  std::vector<std::string> of{};                ///< (k) shear planes, or "plate:hole", "plate:external", "plate:tip"
  Eigen::VectorXd largest{}, smallest{};        ///< (k)
  Eigen::VectorXi largest_at{}, smallest_at{};  ///< (k) increments where they are, among all, from 0
};

/// Margins of the checks of a joint, the smallest first.
struct MarginTable {
  std::vector<std::string> check{}, of{}, formula{}, inputs{}, unit{};  ///< (m)
  Eigen::VectorXd margin{}, allowable{}, applied{};                     ///< (m)
  Eigen::VectorXd edge_ratio{};                                         ///< (m) e/D; infinite if it plays no part
  Eigen::VectorXd direction{};  ///< (m) of the applied load or stress, degrees; infinite if it plays no part
  Eigen::VectorXi at{};         ///< (m) increment that governs, among all
};

/// The states of a joint under its load increments (schemas/joint-result.md): the converged ones only.
struct JointResult {
  Header header;
  int p = 0;                           ///< degree of the matrices
  bool complete = false;               ///< true if every requested increment converged
  std::vector<std::string> case_name;  ///< (cases) load cases; one without a name of a joint without "cases"
  Eigen::VectorXi case_of;             ///< (steps) case of each increment, whose load factors count in that case
  Eigen::VectorXd load_factor;         ///< (steps)
  Eigen::VectorXi converged;           ///< (steps) 1
  Eigen::VectorXi iterations;          ///< (steps) of the nonlinear solver, including failed attempts
  Eigen::VectorXd residual;            ///< (steps) maximum, relative to the maximum force
  std::vector<std::string> event;      ///< (steps) events of fasteners at this increment, of rims in contact up to it
  // Each of the n shear planes has one entry. A fastener has one plane for each pair of adjacent plates.
  std::vector<std::string> fastener_id;              ///< (n)
  std::vector<std::string> first_hole, second_hole;  ///< (n) "plate:hole"; "ground" may be second
  std::vector<std::string> direction;                ///< (a) directions of the joint's discs: "x", "y"
  Eigen::MatrixXd delta;                             ///< (steps, n) relative displacement of the discs, length
  Eigen::MatrixXd F;                                 ///< (steps, n) force of the law at delta
  std::optional<Eigen::MatrixXd> F_error;            ///< (steps, n) estimated error, if the plates' errors are known
  Eigen::MatrixXd delta_vector, F_vector;            ///< (steps, n a) their components, direction varying fastest
  Eigen::MatrixXd transferred;  ///< (steps, n 2) F + friction resultant on each plane's first, then second plate
  /// (steps, n a) permanent set of the bearing of each plane, (steps, n) energy dissipated by slip and yield so far;
  /// empty if no law remembers
  Eigen::MatrixXd set{}, dissipated{};
  std::vector<std::string> load_external;  ///< (s) "plate:external" of each load other than zero
  Eigen::MatrixXd load_stiffness;          ///< (steps, s) tangent dP/du as all loads grow together, force / length
  std::vector<PlateHistory> plates;
  std::vector<EnvelopeTable> envelope{};          ///< of a joint with "cases"
  MarginTable margins{};                          ///< of a joint with "margins"
  int governing = 0;                              ///< increment that governs, among all; 0: the file does not know
  std::string governing_reason{};                 ///< why it does
  std::vector<std::string> warning_code{};        ///< (a) of each warning that stage3_nonlinear printed
  std::vector<std::string> warning{};             ///< (a) its text
  std::optional<SensitivityHistory> sensitivity;  ///< if requested
};

/// Throws FileError; an existing file at `path` is then kept.
void write(const std::string& path, const JointResult& result);
[[nodiscard]] JointResult read_joint_result(const std::string& path);

}  // namespace fastjoint::formats
