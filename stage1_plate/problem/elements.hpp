// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/pfem/congruent_elements.hpp"
#include "common/pfem/numbering.hpp"
#include "stage1_plate/problem/rim_terms.hpp"
#include "stage1_plate/problem/unknowns.hpp"

namespace fastjoint::stage1 {

/// A congruence class: elements of equal shape, material and springs on their rims, which share one condensed stiffness
/// up to the factor of thickness (docs/theory.md, section 2.6).
struct ElementKind {
  struct RimSide {
    int hole;  ///< index into PlateElements::holes of the element
    RimTerms terms;
  };
  int first;               ///< the first element that is of this kind
  int shape;               ///< index into PlateElements::stiffness
  double thickness;        ///< of the first, length
  std::vector<bool> kept;  ///< (n_modes) shared with another element, on the border of the plate, or not free
  std::vector<RimSide> rims;
};

/// The elements of a plate and the few kinds that they are of: each is integrated and condensed once.
struct PlateElements {
  pfem::CongruentElements congruent;
  std::vector<Eigen::MatrixXd> stiffness;  ///< of each shape, of unit thickness
  std::vector<ElementKind> kinds;
  std::vector<int> kind;                ///< (elements)
  Eigen::VectorXd scale;                ///< (elements) thickness over that of the kind: all matrices go with it
  std::vector<std::vector<int>> holes;  ///< (elements) sprung holes with a rim on it
};

/// Finds the kinds and what rims add to each; integrates no element.
[[nodiscard]] PlateElements find_kinds(const PlateScene& scene, const PlateMesh& plate,
                                       const pfem::Numbering& numbering, const Unknowns& unknowns);

}  // namespace fastjoint::stage1
