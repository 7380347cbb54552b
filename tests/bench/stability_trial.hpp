// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/bench/stability_joints.hpp"

namespace fastjoint::bench {

/// What a solver made of a joint.
struct Trial {
  bool solved = false;
  int iterations = 0;
  long residuals = 0, jacobians = 0;  ///< evaluations
  double seconds = 0;
  Eigen::VectorXd F;  ///< (n a) where solved
};

enum class Coordinate { contact, displacement };
inline constexpr std::array coordinate_names{"contact", "displacement"};

/// The equations with the displacements delta as unknowns, over `unit` (length), residuals over the force scale:
/// F(delta) + S_ud delta + friction = q. Slopes are at most 1e12 times the plates' stiffness.
[[nodiscard]] stage3::RootProblem displacement_problem(const RandomJoint& joint, double unit);

/// Results from each of the program's first guesses.
[[nodiscard]] std::vector<Trial> try_guesses(const RandomJoint& joint, stage3::SolveFunction solver,
                                             Coordinate coordinate, const stage3::RootOptions& options);

/// What the program does with one increment, by follow(); evaluations are not counted.
[[nodiscard]] Trial try_as_shipped(const RandomJoint& joint, const stage3::RootOptions& options);

}  // namespace fastjoint::bench
