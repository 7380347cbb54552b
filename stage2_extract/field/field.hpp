// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/formats/plate_solution.hpp"
#include "stage2_extract/field/fields.hpp"

namespace fastjoint::stage2 {

/// A state of a plate as amounts of its unit cases.
struct FieldState {
  Eigen::VectorXd amounts;  ///< (nc + h + q) length of externals and discs, stress of frictions, force of tractions
  std::string words;        ///< what it is, for people
  int p = 0;                ///< degree at which the amounts were found, 0 if they belong to none
  std::string joint_plate = {};  ///< name of the plate in the joint, if the state is a joint's
  int increment = 0;             ///< of the joint, from 1 on
};

/// The user's options of a field as given: "" and 0 where the choice is the program's.
struct FieldRequest {
  std::string spec = {};
  std::string plate = {};
  int increment = 0;
  int p = 0;
};

/// Throws InputError if options are given that need others, or if an output would replace the joint's result.
/// @param wanted  True if a field is asked for at all.
/// @param timings Path of --timings, or empty.
void check_field_options(const FieldRequest& request, bool wanted, const std::string& output,
                         const std::string& timings);

/// The state that the request describes: a sum of cases, or that of a RESULT.h5, whose name ends in ".h5" or is no case
/// and a file has it.
///
///
/// A sum has cases with commas between them, each with "=AMOUNT" or of amount 1: "external:P=0.01,disc:1:x". Ids may
/// hold commas, colons and equals signs: where one case's name begins another's, the longer one is meant. Of a
/// RESULT.h5 the plate is that which the request names, else the only one whose cases have the plate's names; the
/// increment that of the request, else the last.
/// @param file Name of the plate's file, for messages.
/// Throws InputError if the request fits neither plate nor joint, FileError for a bad RESULT.h5.
[[nodiscard]] FieldState field_state(const formats::PlateSolution& plate, const std::string& file,
                                     const FieldRequest& request);

/// Degree to look at: the request's, else the state's, else the plate's highest. Throws InputError if it is above that.
[[nodiscard]] int field_degree(const formats::PlateSolution& plate, const std::string& file,
                               const FieldRequest& request, const FieldState& state);

/// One state of a plate at points of every element: (p + 1)^2 points each, in the order of lagrange_nodes, element
/// after element, none shared, so that what jumps between elements is seen.
struct Field {
  int p;                          ///< degree of the nodes
  Eigen::Matrix2Xd points;        ///< (2, n_points) length
  Eigen::Matrix2Xd displacement;  ///< (2, n_points) length
  Eigen::Matrix3Xd stress;        ///< (3, n_points) sigma_x, sigma_y, tau_xy as the elements have it
};

/// Coordinates (xi, eta) of the nodes of VTK's Lagrange quadrilateral of degree p, shape (2, (p + 1)^2): corners, edges
/// bottom, right, top, left each along growing xi or eta, then the inside with xi running fastest.
/// VTK, vtkHigherOrderQuadrilateral::PointIndexFromIJK.
[[nodiscard]] Eigen::Matrix2Xd lagrange_nodes(int p);

/// A solved state at the nodes of degree p.
/// @param fields Fields of one state.
[[nodiscard]] Field at_nodes(const Fields& fields, int p);

/// The field of a state at the degree that field_degree chooses.
/// @param file Name of the plate's file, for messages.
/// Throws InputError and FileError if there is none, NumericalError if amounts are too large.
[[nodiscard]] Field make_field(FieldSolver& solver, const std::string& file, const FieldRequest& request,
                               const FieldState& state);

/// Von Mises stress at points, taken as if sigma_z = 0, shape (n_points). In plane strain the elasticity alone does not
/// tell sigma_z.
/// @param stress sigma_x, sigma_y, tau_xy, shape (3, n_points).
[[nodiscard]] Eigen::VectorXd von_mises(const Eigen::Matrix3Xd& stress);

/// Principal stresses in the plane at points, shape (2, n_points), the larger one first.
[[nodiscard]] Eigen::Matrix2Xd principal(const Eigen::Matrix3Xd& stress);

/// The field as an unstructured grid of VTK (XML, ASCII) of Lagrange quadrilaterals.
///
/// Points: displacement, stress_xx, stress_yy, stress_xy, von_mises, principal_1, principal_2. Cells: thickness. Of the
/// whole: names of plate, state and units, the holes, and of a joint's state its plate there and increment.
/// VTK File Formats, Kitware, section "XML File Formats", UnstructuredGrid.
[[nodiscard]] std::string vtu(const formats::PlateSolution& plate, const FieldState& state, const Field& field);

}  // namespace fastjoint::stage2
