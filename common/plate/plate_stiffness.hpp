// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/numbering.hpp"
#include "common/plate/springs.hpp"

namespace fastjoint::plate {

/// The degrees of freedom of a plate (pfem/numbering.hpp says how one is written), and who moves those that are
/// controlled.
///
/// The nc = e + m controlled displacements are the rigid externals, then the discs: those of sprung holes, then those
/// of point springs, each in the order of the input, directions inner. The free unknowns keep the order of the
/// functions, so those of degree <= k come first.
struct Unknowns {
  Eigen::Matrix2Xi dofs;    ///< (2, n_functions) what becomes of u_x and u_y of each global function
  std::vector<int> n_free;  ///< (p + 1) free unknowns of degree <= k
  int n_externals = 0;
  std::vector<std::string> disc_hole, disc_direction;  ///< (m)
  std::vector<int> first_disc{};                       ///< (holes + 1) first disc of each hole, none of an open one
  // Columns of the border behind the controlled displacements: waves that are loaded, friction cases, other waves.
  int n_loaded = 0, n_friction = 0, n_other = 0;
  std::vector<int> first_wave{}, first_friction{};  ///< (holes) first column of each hole's waves and friction cases
  std::vector<int> n_waves{}, n_cases{};            ///< (holes) and their numbers

  [[nodiscard]] int controlled_of_disc(int disc) const { return n_externals + disc; }
  [[nodiscard]] int n_discs() const { return count_of(disc_hole); }
  [[nodiscard]] int n_controlled() const { return n_externals + n_discs(); }
  /// Number of columns of the border that have an amount in some state: all but waves that nothing loads.
  [[nodiscard]] int n_amounts() const { return n_controlled() + n_loaded + n_friction; }
  [[nodiscard]] int n_border() const { return n_amounts() + n_other; }
  /// Columns of the border that act on an element with rims of these holes: of each hole the discs, the waves, the
  /// friction cases.
  [[nodiscard]] std::vector<int> border_of(const std::vector<int>& holes) const;
};

/// Numbers the columns of the border that belong to rims.
void count_rim_cases(const SprungMesh& sprung, Unknowns& unknowns);

/// Free unknowns of the functions of degree <= k, for every k up to the numbering's p.
[[nodiscard]] std::vector<int> count_free(const pfem::Numbering& numbering, const Eigen::Matrix2Xi& dofs);

/// Congruent elements that have equal springs on their rims too: they share one condensed stiffness up to the factor of
/// thickness (docs/theory.md, section 2.6).
struct ElementClass {
  struct RimSide {
    int hole;  ///< index into PlateElements::holes of the element
    RimTerms terms;
  };
  int first;               ///< the first element of this class
  int congruent;           ///< index of its congruence class, into PlateElements::stiffness
  double thickness;        ///< thickness of the first element, length
  std::vector<bool> kept;  ///< (n_modes) shared with another element, on the border of the plate, or not free
  std::vector<RimSide> rims;
};

/// The elements of a plate and their few classes: each class is integrated and condensed once.
struct PlateElements {
  pfem::CongruentElements congruent;
  std::vector<Eigen::MatrixXd> stiffness;  ///< stiffness of each congruence class at unit thickness
  std::vector<ElementClass> classes;
  std::vector<int> class_of;            ///< (elements)
  Eigen::VectorXd scale;                ///< (elements) thickness over that of the class: all matrices go with it
  std::vector<std::vector<int>> holes;  ///< (elements) holes with springs or waves and a rim on it
};

/// Finds the classes and what rims add to each; integrates no element.
[[nodiscard]] PlateElements classify_elements(const SprungMesh& sprung, const pfem::Numbering& numbering,
                                              const Unknowns& unknowns);

/// A spring between a degree of freedom of a vertex and a controlled displacement.
struct PointTie {
  int vertex, dof, controlled;
  double stiffness;  ///< force / length
};

/// The stiffness of a plate at the highest p. It is never assembled: it is there element by element (PlateFactor).
struct PlateStiffness {
  pfem::Numbering numbering;
  Unknowns unknowns;
  PlateElements elements;
  /// Springs between vertices of the mesh and discs of their own, section 3.1 of the paper: the displacement of the
  /// vertex, and with it the springs' load, does not converge.
  std::vector<PointTie> ties;
};

}  // namespace fastjoint::plate
