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
  Index plane;  ///< behind the n planes stand two entries of each rim of contact: n + 2 rim touches, the next parts
  CornerKind kind;
  bool back;

  bool operator==(const ContactEvent&) const = default;
};

/// Corners of the n planes of a joint and its g rims of contact, and the events between its states.
class ContactCorners {
 public:
  /// @param equations         Outlives this.
  /// @param interference_alone Only the corners at which rims with interference lose full contact.
  explicit ContactCorners(const JointEquations& equations, bool interference_alone = false);

  /// Corners of a plane, ascending: where its rim begins to bear, and those of a law that is linear between them.
  [[nodiscard]] const std::vector<Corner>& of(Index plane) const { return corners_[plane]; }
  /// Contact coordinate of a plane, or with two directions its amount; of a rim the depth of its disc where it is
  /// largest, or minus that where it is least, times the rim's stiffness, force.
  ///
  /// @param c Contact coordinates, shape (r), force.
  [[nodiscard]] double position(const VectorXd& c, Index plane) const;
  /// Derivative of position by c, (r).
  [[nodiscard]] VectorXd slope(const VectorXd& c, Index plane) const;
  /// Number of corners that each plane and each entry of a rim has passed, negative on the negative side, (n + 2 g).
  [[nodiscard]] Eigen::VectorXi passed(const VectorXd& c) const;
  /// Events on the way from one vector of passed() to another.
  [[nodiscard]] std::vector<ContactEvent> between(const Eigen::VectorXi& before, const Eigen::VectorXi& after) const;
  /// Events of planes at c, on the corners themselves, coming from `before`, and of rims by then.
  /// @param passed_before passed() of `before`.
  [[nodiscard]] std::vector<ContactEvent> at(const VectorXd& before, const Eigen::VectorXi& passed_before,
                                             const VectorXd& c) const;
  /// Distance within which c is on a corner at `at`, force.
  [[nodiscard]] static double nearness(const VectorXd& c, double at);

 private:
  Index n_planes_;
  std::vector<std::vector<Corner>> corners_;                  ///< of each entry
  std::vector<std::pair<const PlacedInterface*, Index>> at_;  ///< interface of each entry, and its number there
};

/// "1, 3 close; 2 yields", empty if nothing happens.
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
  VectorXd rim_F = {}, moments = {};      ///< (r - n a) forces and moments of rims of contact, force, length
  VectorXd Lambda = {};                   ///< (t) amounts of friction
  std::vector<ContactEvent> events = {};  ///< what happens exactly here, or to rims since the increment before
  VectorXd c = {};                        ///< (r) contact coordinates, force
  /// Against which residuals count: force_scale, or rounding of clearances over the tolerance, force.
  double scale = 0;

  /// Forces and displacements of all rows of the condensed system, (r).
  [[nodiscard]] VectorXd all_F() const { return behind(F, rim_F); }
  [[nodiscard]] VectorXd all_delta() const { return behind(delta, moments); }

 private:
  static VectorXd behind(const VectorXd& planes, const VectorXd& rims) {
    VectorXd all(planes.size() + rims.size());
    all << planes, rims;
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
  double load_factor;  ///< that was asked for
  double reached;      ///< largest part of it that converged
  Index entry;         ///< with the worst residual in the best try: a plane, or behind the n planes a rim of contact
  double residual;     ///< there, relative to the load asked for; infinite if each try left it spent
  /// Planes that in the best try carry all that their laws allow, if nothing else holds the joint there: a limit load.
  std::vector<Index> level;
  std::optional<double> locking;             ///< TangentCheck's, for the sides that bear or would bear
  std::optional<Imbalance> unbalanced = {};  ///< if that ended the path
  std::optional<double> limit = {};  ///< load factor beyond which surely nothing balances (limit_load), with its sign
};

/// The first load factor whose solution is not on the path from no load.
struct PathLeft {
  double load_factor;
  bool guessed;  ///< found from a first guess; else by a jump from the state before
};

/// Rims of contact of a joint in which some have interference.
struct Interference {
  /// Load factor at which each rim with interference first loses full contact, 0 of one that has none below
  /// first_load_factor, infinite if it is not lost up to `followed`, and of other rims, (g).
  VectorXd lost;
  double followed;  ///< largest load factor of the path's increments, or as far as the search went
};

struct LoadPath {
  Index n_increments = 0;  ///< asked for
  std::vector<PathStep> steps;
  std::optional<PathFailure> failure;
  std::optional<PathLeft> left = {};       ///< the first such place; only where the solution may be one of several
  std::optional<VectorXd> assembled = {};  ///< (r) contact coordinates of a joint with interference at no load, force
  std::optional<Interference> interference = {};
  std::vector<History> history = {};  ///< of each interface, behind the last increment
};

struct PathOptions {
  InitialScene initial;
  SolverScene solver;
  std::ostream* log = nullptr;  ///< gets a line for each iteration of each try
  /// Takes each increment with the tangent of its solution; the path ends before one of which it returns something.
  std::function<std::optional<Imbalance>(SolvedPoint, const PathStep&)> each = {};
  std::optional<VectorXd> start = {};  ///< (r) contact coordinates at load factor 0, force; none: those of no load
};

/// Follows the load factors, each increment from the last: the chosen solver in the contact coordinates from the last
/// state, then damped Newton, then both in half steps. A load factor that cannot be reached so is tried from
/// the first guesses: by the same solvers, with friction also by damped Newton in turns, each under the friction of the
/// turn before, and at last in half steps.
///
/// The first increment begins with the first guesses, unless the solution may be one of several: then at no load. There
/// each step must also agree with two half steps; one that does not, however short, is a jump.
[[nodiscard]] LoadPath follow(const JointEquations& equations, const std::vector<double>& load_factors,
                              const PathOptions& options);

/// Least load factor that is searched for events: from no load on what happens below is there from the start.
inline constexpr double first_load_factor = 1e-6;

/// Follows the joint to load factor 1 with an increment at every load factor in (0, 1] at which a fastener passes a
/// corner of its law (ContactCorners), and one at 1.
///
/// Interfaces remember at increments alone: all events are sought with what they remember at load factor 0.
/// The load factor becomes an unknown of Newton's method while the fastener stays on its corner, between solved states
/// whose interval is halved where the order of events is in doubt (docs/theory.md, section 8.7).
[[nodiscard]] LoadPath follow_events(const JointEquations& equations, const PathOptions& options);

/// Searches between the increments of a path of a joint with interference for the events at which full contact is lost,
/// as follow_events does, up to the largest load factor. Empty without interference, and if no load was not solved.
[[nodiscard]] std::optional<Interference> search_interference(const JointEquations& equations,
                                                              const PathOptions& options, const LoadPath& path);

/// A straight part of a path through the loads of a joint.
struct Segment {
  VectorXd load;                     ///< (l) at its end, as Parameters has them; at its begin those of the one before
  std::vector<double> load_factors;  ///< of its increments, from 0 at its begin to 1 at its end; none: at every event
};

/// Follows a joint from no load through segments, each from where the one before has ended; the last is the first that
/// fails.
/// @param parameters Of all segments, but for the loads.
[[nodiscard]] std::vector<LoadPath> follow_segments(const JointModel& joint,
                                                    const std::shared_ptr<const CondensedSystem>& system,
                                                    const Parameters& parameters, const std::vector<Segment>& segments,
                                                    PathOptions options);

}  // namespace fastjoint::stage3
