// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/columns/column.hpp"
#include "common/formats/header.hpp"

namespace fastjoint::formats {

// What a field of one sheet is made of: stage 3 computes these quantities, stage 2 reads them.
extern const columns::Quantity D, De, free_D, free_De, wave_amount, Lambda, traction_force;

/// The r holes of a plate, open ones included; none if the plate's matrices have no stresses at the joint's degree.
struct HoleList {
  std::vector<std::string> hole;             ///< (r)
  Eigen::VectorXi sections;                  ///< (r) number of sections next to the hole
  Eigen::MatrixXd center{};                  ///< (r, 2) length
  Eigen::VectorXd radius{}, thickness{};     ///< (r) length; 0 if not known
  Eigen::VectorXd gross_area{}, net_area{};  ///< (r) of the smaller section across x next to the hole; 0 without one
  Eigen::VectorXd gross_area_y{}, net_area_y{};  ///< (r) the same across y
  /// (r + 1) first point of each rim, and k; rims without a closed form have no points. None if not requested.
  Eigen::VectorXi start{};
  Eigen::VectorXd angle{};                ///< (k) place of each point, counter-clockwise from x, degrees
  std::optional<double> near_distance{};  ///< of the circles on which there are stresses, from the rims, length
};

/// The g rims of a plate with compression-only springs at no load.
struct RimsAtNoLoad {
  Eigen::VectorXd gap{};  ///< (g) radial gap, negative for interference, length
  // The next three are for a joint with interference; in others they are 0, 0 and infinite.
  Eigen::VectorXd peak{}, least{};  ///< (g) maximum and minimum pressure, stress
  /// (g) load factor at which a rim with interference first loses full contact; infinite if it does not up to 1
  Eigen::VectorXd full_until{};
};

/// The w rows of a plate's holes whose discs move along one axis.
struct RowList {
  std::vector<std::string> direction{};  ///< (w) "x" or "y"
  Eigen::VectorXd at{};                  ///< (w) coordinate along it, length
  Eigen::VectorXi holes{};               ///< (w) number of holes
};

/// One plate of a joint: its things, and their quantities at every increment. Of the unit cases it has the names, the
/// arms of moments, the border, and the rims in contact with their waves (g).
struct PlateHistory : UnitCases {
  std::string name;
  RimsAtNoLoad at_no_load{};
  HoleList holes{};
  std::vector<pfem::CrackTip> tips{};  ///< (t) without their elements
  RowList rows{};
  std::string materials{};                        ///< JSON text of "materials" in its PLATE.json; empty if unknown
  std::string matrices_digest{}, plate_digest{};  ///< digests of its MATRICES.h5 and PLATE.h5; empty if unknown
  columns::Columns columns{};

  /// Names of its things of one kind: holes, externals, tips or rims of contact, which alone may stand in envelopes and
  /// studies.
  [[nodiscard]] std::vector<std::string> names(columns::Of of) const;
};

/// Largest and smallest value of a number over all increments of all load cases.
struct Extremes {
  std::string of{};  ///< shear plane, "plate:hole", "plate:external" or "plate:tip"
  double largest = 0, smallest = 0;
  int largest_at = 0, smallest_at = 0;  ///< increments where they are, among all, from 0
};

/// Extremes of one quantity, a row for each thing that has it.
struct EnvelopeTable {
  std::string quantity, unit;
  std::vector<Extremes> rows{};
};

/// The spot of a hole's rim whose hoop stress varies most.
struct StressRange : Extremes {
  double angle = 0;             ///< of the spot, counter-clockwise from x, degrees
  double range = 0, error = 0;  ///< largest - smallest, and its estimated error, stress
};

/// A margin of a check: the worst of all increments of the check's cases.
struct Margin {
  std::string check{}, of{}, formula{}, inputs{}, unit{};
  double margin = 0, allowable = 0, applied = 0;
  double edge_ratio = 0;  ///< e/D; infinite if it plays no part
  double direction = 0;   ///< of the applied load or stress, degrees; infinite if it plays no part
  int at = 0;             ///< increment that governs, among all
};

/// A kind of input numbers by which results are differentiated.
struct NumberColumns {
  const char* by;                ///< name of the dataset
  const char* meaning;           ///< of the number
  columns::Dimension dimension;  ///< of the number; without one the unit of each is in law_unit
  Eigen::Index n, first = 0;     ///< how many, and the first of their columns among all derivatives
};

/// Derivatives by numbers of the input; infinite where they do not exist.
struct SensitivityHistory {
  std::vector<NumberColumns> kinds{};
  std::vector<std::string> mu_hole{};                             ///< "plate:hole", each with friction
  std::vector<std::string> law_name{}, law_number{}, law_unit{};  ///< numbers of the laws; units of the derivatives
  std::vector<std::string> force_external{};                      ///< "plate:external" under a force or without load
  std::vector<std::string> displacement_external{};               ///< "plate:external" with prescribed displacement
  std::vector<std::string> gap_hole{};                            ///< "plate:hole", each with compression-only springs
  std::vector<Eigen::MatrixXd> F{};                               ///< (steps) (n, all) of the bearing forces
  std::vector<std::string> peak_hole{};                           ///< (r) "plate:hole" with a peak
  Eigen::MatrixXd peak{};  ///< (r, all) of the peak hoop stresses at the last increment
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
  std::vector<std::string> load_external;            ///< (s) "plate:external" of each load other than zero
  columns::Columns columns{};                        ///< of its shear planes and loads
  std::vector<PlateHistory> plates;
  std::vector<EnvelopeTable> envelope{};          ///< of a joint with "cases"
  std::vector<Margin> margins{};                  ///< of a joint with "margins", the smallest first
  std::vector<StressRange> stress_ranges{};       ///< of two or more increments, the largest range first
  int governing = 0;                              ///< increment that governs, among all; 0: the file does not know
  std::string governing_reason{};                 ///< why it does
  std::vector<std::string> warning_code{};        ///< (a) of each warning that stage3_nonlinear printed
  std::vector<std::string> warning{};             ///< (a) its text
  std::optional<SensitivityHistory> sensitivity;  ///< if requested
};

/// Throws FileError; an existing file at `path` is then kept.
void write(const std::string& path, const JointResult& result);
/// Reads what a field of a sheet is made of: degree, cases, increments, and of plates their unit cases and the
/// quantities above. The rest is left empty.
[[nodiscard]] JointResult read_joint_result(const std::string& path);

}  // namespace fastjoint::formats
