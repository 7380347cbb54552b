// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/plate/elements.hpp"

namespace fastjoint::plate {

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
