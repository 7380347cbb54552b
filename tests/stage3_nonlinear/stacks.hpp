// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/results/joint_state.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::test {

/// A plate without externals: holes "1", "2", ..., their discs along each of `directions`, directions inner.
///
/// @param S Shape (m, m), force / length.
[[nodiscard]] formats::PlateMatrices disc_plate(const Eigen::MatrixXd& S,
                                                const std::vector<std::string>& directions = {"x"});

/// A joint of plates "a", "b", ... without fasteners and loads.
[[nodiscard]] HandMade joint_of(const std::vector<formats::PlateMatrices>& plates);

/// Forces on the discs of a plate themselves, in place of those before, shape (m).
void load_discs(HandMade& joint, Eigen::Index plate, const Eigen::VectorXd& forces);

/// Random plates, stiff in every motion, with discs in a directions and fasteners through 2 to all of them: the first
/// through all, in a random order; with `grounded` it and every other one into the ground.
[[nodiscard]] HandMade random_stack(std::mt19937& random, int n_plates, int n_holes, int n_directions,
                                    bool grounded = false);

/// Stiffness and load of the plates of a joint without fasteners, in the joint's list of unknowns.
struct LoosePlates {
  Eigen::MatrixXd S;     ///< (N, N)
  Eigen::VectorXd load;  ///< (N)
};
[[nodiscard]] LoosePlates loose_plates(const HandMade& joint);

/// Stiffness of a law that is linear without gap.
[[nodiscard]] double stiffness_of(const stage3::Law& law);

/// The state at load factor 1, to a residual of 1e-13.
[[nodiscard]] stage3::PathStep solved(const HandMade& joint);
[[nodiscard]] stage3::JointState state_of(const HandMade& joint, const stage3::PathStep& step);

}  // namespace fastjoint::test
