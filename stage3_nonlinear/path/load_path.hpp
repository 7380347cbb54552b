// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stage3_nonlinear/equations/tangent.hpp"
#include "stage3_nonlinear/path/contact_event.hpp"

namespace fastjoint::stage3 {

/// Number of times that a step that does not converge is halved before the path ends.
inline constexpr int max_halvings = 6;

/// A converged increment.
struct PathStep {
  double load_factor;
  Eigen::VectorXd F, delta;  ///< (n a) force, length
  int iterations;            ///< of all tries; on an exact path its pieces from no load on
  double residual;           ///< largest, relative to the largest |q| at this load factor
  TangentCheck check;
  bool exact = false;                     ///< on an exact path
  std::vector<ContactEvent> events = {};  ///< what happens exactly here
};

/// Place and reason of an early end of a path.
struct PathFailure {
  std::size_t increment;  ///< 0-based
  double load_factor;     ///< that was asked for
  double reached;         ///< largest part of it that converged
  Eigen::Index plane;     ///< with the worst residual in the best try
  double residual;        ///< there, relative to the load asked for; infinite if each try left it spent
  /// Planes that in the best try carry all that their laws allow, if nothing else holds the joint there: a limit load.
  std::vector<Eigen::Index> level;
  std::optional<double> locking;  ///< TangentCheck's, for the sides that bear or would bear
  /// Part that is out of balance in an increment that converged, if that ended the path, and by how much of the largest
  /// force.
  std::string unbalanced = {};
  double out_of_balance = 0, allowed = 0;
};

/// The first load factor whose solution is not on the path from no load.
struct PathLeft {
  double load_factor;
  bool guessed;  ///< found from a first guess; else by a jump from the state before
};

struct LoadPath {
  bool linear = false;           ///< linear solves did it
  std::size_t n_increments = 0;  ///< asked for
  std::vector<PathStep> steps;
  std::optional<PathFailure> failure;
  std::optional<PathLeft> left = {};  ///< the first such place; only where the solution may be one of several
};

struct PathOptions {
  InitialScene initial;
  SolverScene solver;
};

/// Follows the load factors, each increment from the last. If all fasteners are linear springs without gap, linear
/// solves do it; if all are linear between corners, their exact path as far as it goes, unless the options are against
/// it. Else the chosen solver in the contact coordinates from the last state, then damped Newton, then both in half
/// steps. Only what cannot be reached so is tried from the first guesses, by the same, with friction also by turns of
/// damped Newton under the friction of the turn before, at last in half steps.
///
/// The first increment begins with the first guesses, unless the solution may be one of several: then at no load. There
/// each step must also agree with two half steps; one that does not, however short, is a jump.
[[nodiscard]] LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors,
                              const PathOptions& options);

/// The same, by the nonlinear solvers even if linear solves or an exact path would do.
[[nodiscard]] LoadPath follow_nonlinear(const JointEquations& equations, const std::vector<double>& load_factors,
                                        const PathOptions& options);

/// Least load factor that is searched for events: what happens below is there from the start.
inline constexpr double first_load_factor = 1e-6;

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// corner of its law (contact_event.hpp), and one at 1.
///
/// These are the corners of an exact path. On any other path the load factor becomes an unknown of Newton's method
/// while the fastener stays on its corner, between solved states whose interval is halved where the order of events is
/// in doubt (docs/theory.md, section 8.7).
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

}  // namespace fastjoint::stage3
