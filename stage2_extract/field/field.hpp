// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "common/formats/plate_solution.hpp"
#include "stage2_extract/field/fields.hpp"

namespace fastjoint::stage2 {

/// A state of a plate, given by coefficients of its unit cases.
struct FieldState {
  Eigen::VectorXd coefficients;  ///< (n_cases) displacements, wave and friction stresses, traction forces
  std::string words;             ///< description for the user
  int p = 0;                     ///< degree of the joint's matrices; 0 for a sum of cases
  std::string joint_plate = {};  ///< name of the plate in the joint, if the state is a joint's
  int increment = 0;             ///< increment of the joint, from 1 on; 0 for a sum of cases
};

/// The user's options of a field; "" and 0 stand for the default.
struct FieldRequest {
  std::string spec = {};
  std::string plate = {};
  int increment = 0;
  int p = 0;
  std::string of_case = {};  ///< the last increment of this case
};

/// Throws InputError if an option requires another that is missing, or if an output would replace the joint's result.
/// @param wanted  True if a field is requested.
/// @param timings Path of --timings, or empty.
void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings);

/// Finds the state that the request describes: a sum of cases, or a state of a RESULT.h5. The specification is a file
/// if it ends in ".h5", or if it does not start as a case and such a file exists.
///
///
/// A sum has cases separated by commas, each with "=COEFFICIENT" or the coefficient 1: "external:P=0.01,disc:1:x". Ids
/// may contain commas, colons and equals signs; if several names of cases match, the longest is taken. For a RESULT.h5,
/// the plate is the one named in the request, else the only one with the same names of cases; the increment is that of
/// the request or the last of its case, else the one that governs.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if the request fits neither plate nor joint, FileError for a bad RESULT.h5.
[[nodiscard]] FieldState field_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

/// Degree of the field: the request's, else the state's, else the plate's highest. Throws InputError if it is above the
/// highest.
[[nodiscard]] int field_degree(const formats::PlateSolution& plate, const std::string& file,
                               const FieldRequest& request, const FieldState& state);

/// One state of a plate at (p + 1)^2 points of every element, in the order of lagrange_nodes, element by element.
/// Points are not shared between elements, so jumps stay visible.
struct Field {
  int p;                          ///< degree of the nodes
  Eigen::Matrix2Xd points;        ///< (2, n_points) length
  Eigen::Matrix2Xd displacement;  ///< (2, n_points) length
  Eigen::Matrix3Xd stress;        ///< (3, n_points) sigma_x, sigma_y, tau_xy of the element
};

/// Coordinates (xi, eta) of the nodes of VTK's Lagrange quadrilateral of degree p, shape (2, (p + 1)^2): corners, edges
/// bottom, right, top, left each along growing xi or eta, then interior nodes with xi varying fastest.
/// VTK, vtkHigherOrderQuadrilateral::PointIndexFromIJK.
[[nodiscard]] Eigen::Matrix2Xd lagrange_nodes(int p);

/// Evaluates a solved state at the nodes of degree p.
/// @param fields Fields of one state.
[[nodiscard]] Field at_nodes(const Fields& fields, int p);

/// Computes the field of a state at the degree of field_degree.
/// @param file Name of the plate's file, for messages.
/// Throws InputError and FileError as field_degree and FieldSolver do, NumericalError if coefficients are too large.
[[nodiscard]] Field make_field(FieldSolver& solver, const std::string& file, const FieldRequest& request,
                               const FieldState& state);

/// Von Mises stress at points for sigma_z = 0, shape (n_points). In plane strain sigma_z is unknown, since it does not
/// follow from the elasticity matrix.
/// @param stress sigma_x, sigma_y, tau_xy, shape (3, n_points).
[[nodiscard]] Eigen::VectorXd von_mises(const Eigen::Matrix3Xd& stress);

/// Principal stresses in the plane at points, shape (2, n_points), the larger one first.
[[nodiscard]] Eigen::Matrix2Xd principal(const Eigen::Matrix3Xd& stress);

/// The field as an unstructured grid of VTK (XML, ASCII) of Lagrange quadrilaterals.
///
/// Point data: displacement, stress_xx, stress_yy, stress_xy, von_mises, principal_1, principal_2. Cell data:
/// thickness. Field data: names of plate, state and units, the holes, and for a joint's state the name of the plate in
/// the joint and the increment.
/// VTK File Formats, Kitware, section "XML File Formats", UnstructuredGrid.
[[nodiscard]] std::string vtu(const formats::PlateSolution& plate, const FieldState& state, const Field& field);

}  // namespace fastjoint::stage2
