// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/solved_point.hpp"

namespace fastjoint::stage3 {

/// Passing of a corner by a plane, away from the origin or back.
struct ContactEvent {
  Index
      plane;  ///< a plane, or after the n planes two entries of each rim: n + 2 rim for touching, the next for parting
  CornerKind kind;
  bool back;

  bool operator==(const ContactEvent&) const = default;
};

/// Corners of the n planes of a joint and its g rims of contact, and the events between its states.
class ContactCorners {
 public:
  /// @param equations         Outlives this.
  /// @param interference_alone Only the corners at which rims with interference lose full contact are kept.
  explicit ContactCorners(const JointEquations& equations, bool interference_alone = false);

  /// Corners of a plane, ascending: where its rim begins to bear, and those of a law that is linear between them.
  [[nodiscard]] const std::vector<Corner>& of(Index plane) const { return corners_[plane]; }
  /// Contact coordinate of a plane, with two directions its magnitude; for a rim the largest depth of its disc, or
  /// minus the smallest, times the stiffness of the rim, force.
  ///
  /// @param c Contact coordinates, shape (r), force.
  [[nodiscard]] double position(const VectorXd& c, Index plane) const;
  /// Derivative of position by c, (r).
  [[nodiscard]] VectorXd slope(const VectorXd& c, Index plane) const;
  /// Number of corners that each plane and each entry of a rim has passed, negative on the negative side, (n + 2 g).
  [[nodiscard]] Eigen::VectorXi passed(const VectorXd& c) const;
  /// Events on the way from one vector of passed() to another.
  [[nodiscard]] std::vector<ContactEvent> between(const Eigen::VectorXi& before, const Eigen::VectorXi& after) const;
  /// Events of planes that are on a corner at c, coming from `before`, and of rims up to c.
  /// @param passed_before passed() of `before`.
  [[nodiscard]] std::vector<ContactEvent> at(const VectorXd& before, const Eigen::VectorXi& passed_before,
                                             const VectorXd& c) const;
  /// Removes the slip and yield of planes that remember them: what they do follows from their sliders (Walk::record).
  /// @param onward_too Also where they begin, not where they end alone.
  void leave_to_memory(std::vector<ContactEvent>& events, bool onward_too = true) const;
  /// Distance within which c is on a corner at `at`, force.
  [[nodiscard]] static double nearness(const VectorXd& c, double at);

 private:
  Index n_planes_;
  std::vector<bool> remembers_;                               ///< (n)
  std::vector<std::vector<Corner>> corners_;                  ///< of each entry
  std::vector<std::pair<const PlacedInterface*, Index>> at_;  ///< interface of each entry, and its number there
};

/// "1, 3 close; 2 yields", empty without events.
[[nodiscard]] std::string event_text(const JointModel& joint, const std::vector<ContactEvent>& events);

/// Number of times that a step that does not converge is halved before the path ends.
inline constexpr int max_halvings = 6;

/// A converged increment.
struct PathStep {
  double load_factor;
  VectorXd F, delta;  ///< (n a) force, length
  int iterations;     ///< of all tries
  double residual;    ///< largest, over `scale`
  TangentCheck check;
  VectorXd rim_F = {}, moments = {};       ///< (r - n a) forces and moments of rims of contact, force, length
  VectorXd Lambda = {};                    ///< (t) amplitudes of friction
  std::vector<ContactEvent> events = {};   ///< events of planes exactly here, and of rims since the increment before
  VectorXd c = {};                         ///< (r) contact coordinates, force
  std::vector<PlaneMemory> memories = {};  ///< (n) of each plane; empty if no law remembers
  /// Reference force of residuals: force_scale, or rounding of clearances over the tolerance.
  double scale = 0;

  /// Displacements of all rows of the condensed system, (r).
  [[nodiscard]] VectorXd all_delta() const {
    VectorXd all(delta.size() + moments.size());
    all << delta, moments;
    return all;
  }
};

/// Part of a joint that is out of balance in an increment that converged.
struct Imbalance {
  std::string what;            ///< "a row", "a fastener", "a sheet"
  double by = 0, allowed = 0;  ///< of the largest force
};

/// Place and reason of an early end of a path.
struct PathFailure {
  Index increment;     ///< 0-based
  double load_factor;  ///< the requested one
  double reached;      ///< load factor up to which the path converged
  Index entry;         ///< of the largest residual in the best try: a plane, or after the n planes a rim of contact
  double residual;     ///< there, relative to the requested load; infinite if each try ended past a limit load
  /// Planes at the maximum force of their laws in the best try, if the joint is then a mechanism: a limit load.
  std::vector<Index> level;
  std::optional<double> locking;             ///< TangentCheck::locking, for the sides that bear or would bear
  std::optional<Imbalance> unbalanced = {};  ///< the reason, if the path ended by an imbalance
  std::optional<double> limit = {};          ///< upper bound of the limit load (limit_load), with the sign of the load
  std::string ending = {};                   ///< why the solver ended in the last try (text_of)
};

/// The first load factor whose solution is not on the path from no load.
struct PathLeft {
  double load_factor;
  bool guessed;  ///< found from a first guess; else by a jump from the state before
};

/// Loss of full contact of the rims with interference.
struct Interference {
  /// (g) load factor at which each rim with interference first loses full contact: 0 if it has none at
  /// first_load_factor, infinite if it keeps it up to `followed`, and for other rims.
  VectorXd lost;
  double followed;  ///< largest load factor of the path's increments, or as far as the search went
};

struct LoadPath {
  Index n_increments = 0;  ///< number of requested increments
  std::vector<PathStep> steps;
  std::optional<PathFailure> failure;
  std::optional<PathLeft> left = {};       ///< only if the solution may be one of several
  std::optional<VectorXd> assembled = {};  ///< (r) contact coordinates of a joint with interference at no load, force
  std::optional<Interference> interference = {};
  std::vector<History> history = {};  ///< of each interface, after the last increment
};

struct PathOptions {
  InitialScene initial;
  SolverScene solver;
  std::ostream* log = nullptr;  ///< gets a line for each iteration of each try
  /// Called with each increment and the tangent of its solution; if it returns something, the path ends before that.
  std::function<std::optional<Imbalance>(SolvedPoint, const PathStep&)> each = {};
  std::optional<VectorXd> start = {};  ///< (r) contact coordinates at load factor 0, force; none: those of no load
};

/// Follows the load factors, each increment from the last: the chosen solver in the contact coordinates from the last
/// state, then damped Newton, then both in half steps. If that fails, the load factor is tried from the first guesses
/// by the same solvers, with friction also by damped Newton under the friction of the iterate before, and finally in
/// half steps.
///
/// The first increment starts from the first guesses, or from no load if the solution may be one of several. In the
/// latter case each step must also agree with two half steps; a step that does not, however short, is a jump.
[[nodiscard]] LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors,
                              const PathOptions& options);

/// Smallest load factor of the search for events; events below it count as present at no load.
inline constexpr double first_load_factor = 1e-6;

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// corner of its law (ContactCorners), and one at 1.
///
/// Histories of interfaces change at increments only: all events are searched with those at load factor 0, and laws
/// that remember then follow the increments found. Newton's method solves for the load factor at which the fastener is
/// on its corner, between solved states; the interval is halved if the order of events is in doubt (docs/theory.md,
/// section 8.7).
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

/// Searches for the events at which rims with interference lose full contact, as follow_events does, up to the largest
/// load factor of a path. Empty without interference, and if the state at no load was not solved.
[[nodiscard]] std::optional<Interference> search_interference(const JointEquations& equations,
                                                              const PathOptions& options, const LoadPath& path);

}  // namespace fastjoint::stage3
