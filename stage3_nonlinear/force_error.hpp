// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "stage3_nonlinear/equilibrium.hpp"
#include "stage3_nonlinear/load_path.hpp"

namespace fastjoint::stage3 {

/// Estimated errors of the n bearing forces (with two directions of their amounts) by those of the plates' matrices,
/// shape (steps, n), force; none if those of a plate are not known.
///
/// To first order dF_j = -sum over plates of w . (dS u + dT f + dR Lambda): u displaces the plate, w is what a unit of
/// load on its unknowns does to F_j (implicit_slopes). In the energy product that is the product of the errors of two
/// fields. Its last change by p is extrapolated as the energy of the first is, u . S u + 2 u . T f - f . C f, which
/// falls with p (pfem::extrapolated_error); a quarter of its bound, the root of the product of what the energies last
/// fell by, is added at right angles, since the change may pass through zero. Rigid motions, which have no error, drop
/// out. Nothing cancels between plates.
///
/// Of matrices of one degree, as from a laboratory, the file's own S_error counts, all entries against us. Infinite
/// are errors of forces at a limit point.
[[nodiscard]] std::optional<Eigen::MatrixXd> force_errors(const JointModel& joint, const JointEquations& equations,
                                                          const LoadPath& path, const std::vector<JointState>& states);

}  // namespace fastjoint::stage3
