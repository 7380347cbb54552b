// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>

#include "stage2_extract/field/field_state.hpp"
#include "stage2_extract/stresses/fields.hpp"

namespace fastjoint::stage2 {

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
