// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "stage3_nonlinear/laws/law.hpp"

namespace fastjoint::stage3 {

using LawPointer = std::shared_ptr<const Law>;

/// Spring of stiffness k > 0, force / length.
[[nodiscard]] LawPointer linear_law(double k, std::optional<Source> source = std::nullopt);

/// F = A (delta - delta0)^n past delta0, zero before: Bortman & Szabo, equation (7).
///
/// @param A      force / length^n, A > 0
/// @param n      exponent, 0 < n <= 1
/// @param delta0 gap of the law, length, delta0 >= 0
[[nodiscard]] LawPointer power_law(double A, double n, double delta0);

/// Cubic through (0, 0) and three measured points: Bortman & Szabo, equation (8).
///
/// It may lose monotonicity. The fastener is spent where the cubic is negative, as none pushes on in the direction of
/// its stretch, and from where the cubic, fallen beyond its last point, rises again: no test showed the fastener do so.
///
/// @param delta Three different stretches > 0, length.
/// @param F     Forces there, force.
[[nodiscard]] LawPointer cubic_law(const std::array<double, 3>& delta, const std::array<double, 3>& F);

/// Points (delta, F) of a fastener's test; length and force, neither negative.
using TestPoints = std::vector<std::array<double, 2>>;

/// Measured curve that never falls: piecewise cubic through (0, 0) and its points with continuous slope, monotone
/// between points that are (Steffen, Astronomy & Astrophysics 239, 1990); beyond the last point straight on.
///
/// @param points At least two: delta > 0 rises, F does not fall.
[[nodiscard]] LawPointer table_law(const TestPoints& points);

/// Reads points in the order of the file.
///
/// A text file of two columns, parted by commas, semicolons or tabs, with decimal points; a first line of two names is
/// passed over, and so are empty lines and what follows a '#'. Throws InputError with file, line, what was found and
/// what is allowed; FileError if the file cannot be read.
[[nodiscard]] TestPoints read_points(const std::string& path);

/// Corner of a piecewise linear curve.
struct Vertex {
  double delta, F;  ///< length, force
};

/// Piecewise linear curve: from (0, 0) through its vertices, then on with a last slope.
struct Polyline {
  std::vector<Vertex> vertices;  ///< neither delta nor F falls
  double last_slope;             ///< force / length, >= 0
};

/// Number of the input and what it does to the curve.
struct PolylineParameter {
  Parameter parameter;
  Polyline derivative;  ///< of every vertex and of the last slope
};

/// Law that is linear between corners.
///
/// @param first_moved The clearance moves the vertices from this one on along delta.
[[nodiscard]] LawPointer piecewise_linear_law(Polyline curve, std::size_t first_moved,
                                              std::vector<PolylineParameter> parameters,
                                              std::optional<Source> source = std::nullopt);

/// Readers, one for each "type" of a law, each beside the law that it reads; "one_sided" is left to the caller.
using LawReader = LawPointer(const input::Value& law);
LawReader read_linear_law, read_power_law, read_cubic_law, read_bilinear_law, read_four_stage_law, read_table_law,
    read_formula_law;

}  // namespace fastjoint::stage3
