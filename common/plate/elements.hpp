// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/element.hpp"
#include "common/plate/springs.hpp"
#include "common/plate/unknowns.hpp"

namespace fastjoint::plate {

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
  std::vector<std::vector<int>> holes;  ///< (elements) sprung holes with a rim on it
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
