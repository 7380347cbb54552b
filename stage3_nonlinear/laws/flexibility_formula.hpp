// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

namespace fastjoint::stage3 {

/// Numbers that only a formula with correlations for the row of fasteners asks for.
struct FastenerRows {
  std::array<double, 2> E_z;  ///< Young's modulus of the sheets through the thickness, force / length^2
  double d_head;              ///< diameter of the head, length
  double pitch, row_pitch;    ///< between fasteners of a row, between rows, length
  double rows;                ///< how many
  double c_f;                 ///< factor of the kind of fastener
};

/// Numbers of one fastener and the sheets that it joins, for published formulas, in any consistent units.
///
/// In double shear sheet 1 is the one in the middle and sheet 2 one of the two equal straps around it.
struct FastenerGeometry {
  std::array<double, 2> t;  ///< thickness, length
  std::array<double, 2> E;  ///< Young's modulus of the sheets along the load, force / length^2
  double d;                 ///< diameter of the shank, length
  double E_f;               ///< Young's modulus of the fastener, force / length^2
  double nu_f = 0;          ///< its Poisson's ratio, where the formula uses it
  int n_shear = 1;          ///< shear planes: 1, or 2 where the formula knows them
  FastenerRows rows{};      ///< where the formula uses them
};

/// One term of a formula: the bearing of a sheet, which the springs around a modelled hole have already, or what
/// the fastener itself gives.
struct FlexibilityTerm {
  bool of_the_fastener;
  double value;  ///< length / force
};

/// A published formula for the flexibility of a fastener: relative displacement of the sheets, beyond their own
/// stretch, per force of the whole fastener (in double shear: of both its planes together).
struct FlexibilityFormula {
  const char* name;
  std::vector<FlexibilityTerm> (*terms)(const FastenerGeometry&);
  bool knows_double_shear;
  bool uses_nu_f;
  const char* provenance;  ///< who, where, when
  bool uses_rows = false;
};

/// All formulas that the program knows; a new one is one function and one line in the table of formula_law.cpp.
[[nodiscard]] std::span<const FlexibilityFormula> flexibility_formulas();

/// Sum of all terms, length / force.
[[nodiscard]] double total_flexibility(const std::vector<FlexibilityTerm>& terms);
/// Sum of the terms of the fastener, length / force.
[[nodiscard]] double fastener_flexibility(const std::vector<FlexibilityTerm>& terms);

}  // namespace fastjoint::stage3
