// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/count.hpp"
#include "common/pfem/element.hpp"
#include "common/pfem/numbering.hpp"
#include "common/plate/springs.hpp"

namespace fastjoint::plate {

/// Classification of the degrees of freedom of a plate (encoded as in pfem/numbering.hpp), and the columns of the
/// border.
///
/// The nc = e + m controlled displacements are the rigid externals, then the discs: those of sprung holes, then those
/// of point springs, each in the order of the input, the direction varying fastest. The free unknowns keep the order of
/// the functions, so those of degree <= k come first.
struct Unknowns {
  Eigen::Matrix2Xi dofs;    ///< (2, n_functions) class of u_x and u_y of each global function: free, fixed, controlled
  std::vector<int> n_free;  ///< (p + 1) free unknowns of degree <= k
  int n_externals = 0;
  std::vector<std::string> disc_hole;     ///< (m)
  std::vector<rim::Axis> disc_direction;  ///< (m)
  std::vector<int> first_disc{};          ///< (holes + 1) first disc of each hole; an open hole has none
  // Columns of the border after the controlled displacements: loaded waves, friction cases, other waves.
  int n_loaded = 0, n_friction = 0, n_other = 0;
  std::vector<int> first_wave{}, first_friction{};  ///< (holes) first column of each hole's waves and friction cases
  std::vector<int> n_waves{}, n_cases{};            ///< (holes) and their numbers
  std::optional<Eigen::Vector2d> held_at{};  ///< vertex that is held in place of supports, none of which there are

  [[nodiscard]] int controlled_of_disc(int disc) const { return n_externals + disc; }
  /// Degree of freedom that a point spring acts on.
  [[nodiscard]] int dof_of(const rim::PointSpring& spring) const {
    return dofs(rim::coordinate(disc_direction[spring.disc]), spring.vertex);
  }
  [[nodiscard]] int n_discs() const { return count_of(disc_hole); }
  [[nodiscard]] int n_controlled() const { return n_externals + n_discs(); }
  /// Number of columns of the border with a prescribed value or amplitude: all but the other waves.
  [[nodiscard]] int n_prescribed() const { return n_controlled() + n_loaded + n_friction; }
  [[nodiscard]] int n_border() const { return n_prescribed() + n_other; }
  /// Columns of the border that are coupled to an element with rims of these holes: discs, waves and friction cases of
  /// each hole.
  [[nodiscard]] std::vector<int> border_of(const std::vector<int>& holes) const;
};

/// Numbers the columns of the border that belong to rims.
void count_rim_cases(const SprungMesh& sprung, Unknowns& unknowns);

/// Number of free unknowns of the functions of degree <= k, for every k up to the numbering's p.
[[nodiscard]] std::vector<int> count_free(const pfem::Numbering& numbering, const Eigen::Matrix2Xi& dofs);

/// Congruent elements with equal springs on their rims. Their condensed stiffness is the same up to the factor of
/// thickness (docs/theory.md, section 2.6).
struct ElementClass {
  struct RimSide {
    int hole;  ///< index into PlateElements::holes of the element
    RimTerms terms;
  };
  int first;               ///< the first element of this class
  int congruent;           ///< index of its congruence class, into PlateElements::stiffness
  double thickness;        ///< thickness of the first element, length
  std::vector<bool> kept;  ///< (n_modes) boundary modes: shared with another element, on the plate's edge, or not free
  std::vector<RimSide> rims;
};

/// The elements of a plate and their classes; each class is integrated and condensed once.
struct PlateElements {
  pfem::CongruentElements congruent;
  std::vector<Eigen::MatrixXd> stiffness;  ///< stiffness of each congruence class at unit thickness
  std::vector<ElementClass> classes;
  std::vector<int> class_of;            ///< (elements)
  Eigen::VectorXd scale;                ///< (elements) thickness over that of the class; factor of all matrices
  std::vector<std::vector<int>> holes;  ///< (elements) holes with springs or waves whose rim is on the element
};

/// Finds the classes and the terms of their rims, without integrating elements.
[[nodiscard]] PlateElements classify_elements(const SprungMesh& sprung, const pfem::Numbering& numbering,
                                              const Unknowns& unknowns);

/// The stiffness of a plate at the highest p, stored by class of elements and never assembled as a whole.
struct PlateStiffness {
  pfem::Numbering numbering;
  Unknowns unknowns;
  PlateElements elements;
  /// Springs between vertices of the mesh and separate discs, section 3.1 of the paper. The displacement of the vertex,
  /// and so the spring's load, does not converge.
  std::vector<rim::PointSpring> ties;
};

/// Stiffness of the springs of all points and of each side of a rim, force / length.
[[nodiscard]] std::vector<double> spring_stiffnesses(const PlateStiffness& plate);

}  // namespace fastjoint::plate
