// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/output/output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/program/program.hpp"
#include "stage3_nonlinear/equations/stability.hpp"
#include "stage3_nonlinear/interfaces/rim_friction.hpp"

namespace fastjoint::stage3 {
namespace {

/// First step for which a condition is true, or null.
template <class Is>
const PathStep* first_step(const LoadPath& path, Is is) {
  const auto found = std::ranges::find_if(path.steps, is);
  return found == path.steps.end() ? nullptr : &*found;
}

/// Warns of each plane at the first increment at which it is beyond the last point of its law.
void warn_beyond_last_point(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                            WarningList& list) {
  for (Index j = 0; j < std::ssize(joint.planes); ++j) {
    const Contact& contact = equations.contacts[j];
    const double last = contact.law->last_delta(contact.clearance);
    const auto delta = [&](const PathStep& step) { return magnitudes(step.delta, joint.n_directions())[j]; };
    const auto is_beyond = [&](const PathStep& step) {
      return std::abs(delta(step)) > last && !(contact.one_sided && delta(step) < 0);
    };
    if (const PathStep* step = first_step(path, is_beyond))
      list.doubt("beyond-last-point", std::abs(delta(*step)) / last,
                 "{}: delta = {:.6g} at {} is beyond the last point {:.6g} of its law (gap included), which is "
                 "extrapolated there",
                 joint.name(joint.planes[j]), delta(*step), increment_text(path, *step), last);
  }
}

/// Motion of each plate by its discs: "plate \"b\" by 1 along x".
std::string motion_text(const JointModel& joint, const VectorXd& motion) {
  constexpr double moves = 1e-3;  // of the largest displacement of the motion
  std::vector<std::string> parts;
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index d = 0; d < joint.n_directions(); ++d) {
      double largest = 0;
      for (Index disc = d; disc < joint.plates[i].n_disc_unknowns(); disc += joint.n_directions())
        if (const double u = motion[joint.offset(i) + disc]; std::abs(u) > std::abs(largest)) largest = u;
      if (std::abs(largest) > moves)
        parts.push_back(
            fmt::format("plate \"{}\" by {:.3g} along {}", joint.plates[i].name, largest, joint.axis_name(d)));
    }
  return fmt::format("{}", fmt::join(parts, ", "));
}

void warn_of_soft_plates(const JointModel& joint, WarningList& list) {
  constexpr double soft = 1e-8;
  const PlateModel& stiffest = *std::ranges::max_element(joint.plates, {}, &PlateModel::stiffest);
  for (const auto& plate : joint.plates)
    if (const double ratio = plate.stiffest() / stiffest.stiffest(); ratio > 0 && ratio < soft)
      list.add("plate-soft",
               "plate \"{}\" is {:.1e} times as stiff as plate \"{}\": check that both have the same units, and check "
               "its moduli and thickness",
               plate.name, ratio, stiffest.name);
}

/// Warns once for each law.
void warn_of_bearing_twice(const JointModel& joint, const Parameters& parameters, WarningList& list) {
  std::set<std::string> said;
  for (Index j = 0; j < joint.n_planes(); ++j) {
    const ShearPlane& plane = joint.planes[j];
    const auto source = parameters.law[j]->source();
    if (!source || !source->bearing_of_plate) continue;
    for (const HoleModel& hole : joint.holes(plane))
      if (joint.plates[hole.plate].on_springs[hole.disc / joint.n_directions()] && said.insert(plane.law_name).second)
        list.add("bearing-twice",
                 "/laws/{}: mode \"total\" includes the bearing of the sheets, which the springs around hole \"{}\" "
                 "represent already: the joint is too soft; take \"fastener only\"",
                 plane.law_name, joint.name(hole));
  }
}

void warn_of_mechanisms(const JointModel& joint, const LoadPath& path, WarningList& list) {
  const auto first = [&](bool limit) {
    return first_step(
        path, [&](const PathStep& each) { return each.check.mechanism && each.check.at_limit_load() == limit; });
  };
  if (const PathStep* step = first(false))
    list.add("free-within-gaps",
             "at {} the joint is a mechanism within the gaps of {}: the forces are determinate, the displacements are "
             "not; in proportion, it is free to move {}",
             increment_text(path, *step), names(joint, step->check.mechanism->open),
             motion_text(joint, step->check.mechanism->motion));
  if (const PathStep* step = first(true))
    list.add("limit-load",
             "limit load reached at {}: the laws of {} are at their maximum force, and the joint has no other "
             "stiffness; it moves without more load, in proportion {}",
             increment_text(path, *step), names(joint, step->check.mechanism->level),
             motion_text(joint, step->check.mechanism->motion));
}

void warn_of_other_solutions(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                             WarningList& list) {
  if (const auto planes = planes_that_may_snap(equations); !planes.empty() && !path.steps.empty()) {
    const char* found =
        !path.left ? "the one given is followed from no load"
        : path.left->guessed
            ? "at load factor {:.6g} it could not be followed from the load before, where the joint may have reached "
              "its limit load, and the one given was found from a first guess (\"initial\")"
            : "it is followed from no load up to load factor {:.6g}, where it jumps: the one given from there on is "
              "another";
    list.add(
        "several-solutions",
        "the law of {} falls more steeply than the stiffness of the plates: the solution may be one of several; {}",
        names(joint, planes), fmt::format(fmt::runtime(found), path.left ? path.left->load_factor : 0));
  }
  const auto snaps = [](const PathStep& step) { return step.check.unstable > 0 && !step.check.locking; };
  if (const PathStep* step = first_step(path, snaps))
    list.add("unstable-balance",
             "at {} the joint balances, but is unstable in {} (negative eigenvalues of its tangent): in reality it "
             "snaps through before; take a law that does not fall, or prescribe displacements instead of forces",
             increment_text(path, *step),
             step->check.unstable == 1 ? "one way" : fmt::format("{} ways", step->check.unstable));
}

/// Warns of a hole that two externals press along x and y, each on the half of the rim that faces it: no pin does.
void warn_of_oblique_bearing(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                             WarningList& list) {
  if (path.steps.empty()) return;
  constexpr double hardly = 1e-3;
  const VectorXd given = equations.parameters.given_at(path.steps.back().load_factor);
  const auto loads = loads_of(joint);
  for (std::size_t i = 0; i < loads.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const PlateModel& plate = joint.plates[loads[i].plate];
      const auto presses = [&](const Load& load) {
        return load.is_traction && plate.bearing_sign(load.at) != 0 && load.plate == loads[i].plate;
      };
      const double a = std::abs(given[Index(i)]), b = std::abs(given[Index(k)]);
      if (!presses(loads[i]) || !presses(loads[k]) || std::min(a, b) <= hardly * std::max(a, b)) continue;
      if (plate.traction_hole[loads[i].at] != plate.traction_hole[loads[k].at]) continue;
      list.doubt("bearing-oblique", std::min(a, b),
                 "externals \"{0}\" and \"{1}\" press hole \"{2}:{3}\" along x and y at once, each on its own half of "
                 "the rim: a pin presses where the load points, and its peak hoop stress is higher, by a third at 45 "
                 "degrees; let a fastener in contact bring the load, or draw the sheet with the load along an axis",
                 plate.traction_id[loads[k].at], plate.traction_id[loads[i].at], plate.name,
                 plate.traction_hole[loads[i].at]);
    }
}

/// Sentence about self-locking. @param factor Friction reserve, at most 1.
std::string locking_text(double factor) {
  return fmt::format(
      "with friction {:.4g} times as large the joint is self-locking: friction alone carries the load there, and "
      "beyond it a solution may not exist or not be unique",
      factor);
}

void warn_of_locking(const LoadPath& path, WarningList& list) {
  if (const PathStep* step = first_step(path, [](const PathStep& each) { return each.check.locking.has_value(); }))
    list.add("self-locking", "at {}, {}", increment_text(path, *step), locking_text(*step->check.locking));
}

/// Warns of the rims of contact that stick, at the first increment of each.
void warn_of_sticking(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                      WarningList& list) {
  const auto names_of_rims = joint.rims();
  for (Index rim = 0; rim < std::ssize(names_of_rims); ++rim) {
    const RimProblem& problem = *equations.rims[rim];
    const double mu = problem.contact().mu();
    const auto sticks = [&](const PathStep& step) {
      return mu > 0 && !problem.solve(equations.of_rim(step.c, rim)).friction.slips;
    };
    if (const PathStep* step = first_step(path, sticks))
      list.doubt(
          "rim-sticks", mu,
          "at {} the rim of hole \"{}\" sticks: friction {} could carry more than pressure does, and carries as much",
          increment_text(path, *step), names_of_rims[rim], mu);
  }
}

}  // namespace

std::string increment_text(const LoadPath& path, const PathStep& step) {
  return fmt::format("increment {} (load factor {:.6g})", &step - path.steps.data() + 1, step.load_factor);
}

std::string names(const JointModel& joint, const std::vector<Index>& planes) {
  std::vector<std::string> result;
  for (const Index j : planes) result.push_back(joint.name(joint.planes[j]));
  return program::listed(std::move(result));
}

std::vector<program::Warning> warnings(const JointModel& joint, const JointEquations& equations, const LoadPath& path) {
  WarningList list;
  warn_of_soft_plates(joint, list);
  warn_of_bearing_twice(joint, equations.parameters, list);
  warn_of_oblique_bearing(joint, equations, path, list);
  warn_beyond_last_point(joint, equations, path, list);
  warn_of_mechanisms(joint, path, list);
  warn_of_other_solutions(joint, equations, path, list);
  warn_of_locking(path, list);
  warn_of_unloading(joint, equations, path, list);
  warn_of_sticking(joint, equations, path, list);
  auto result = list.all();
  for (auto& each : result) each.text.insert(0, joint.file + ": ");
  return result;
}

std::string failure_message(const JointScene& scene, const CaseScene& its, const JointModel& joint,
                            const LoadPath& path, const std::string& output) {
  const PathFailure& failure = *path.failure;
  const std::string before = program::counted(failure.increment, "increment");
  const std::string kept = fmt::format("{} holds the {} before{} (complete = 0).", output, before,
                                       its.name.empty() ? "" : " of this case, and the other cases");
  const std::string of_case = its.name.empty() ? "" : fmt::format("case \"{}\": ", its.name);
  const std::string increment = fmt::format("{}increment {} of {} (load factor {:.6g})", of_case, failure.increment + 1,
                                            path.n_increments, failure.load_factor);
  if (failure.unbalanced)
    return fmt::format(
        "{}: {} converged, but {} is out of balance by {:.1e} of the largest force, allowed {:.1e}. {} {}", scene.file,
        increment, failure.unbalanced->what, failure.unbalanced->by, failure.unbalanced->allowed, kept,
        failure.unbalanced->what == "the load"
            ? "Rounding of the gaps, clearances and offsets is too large beside the load: check them and the load, and "
              "their units"
            : "Rounding errors act as loads there: check that fasteners or supports fix each plate in the direction of "
              "its load; for matrices made by hand check that R_df and R_ef sum to -friction/resultant, T_d and T_e to "
              "-1, along the other axis to -friction/resultant_across and -traction/resultant_across");
  const std::string locking =
      failure.locking ? fmt::format("On the sides that bear, {}. ", locking_text(*failure.locking)) : "";
  if (!failure.level.empty())
    return fmt::format(
        "{}: {}limit load reached: beyond load factor {:.6g}, the last that converged, the laws of {} are at their "
        "maximum force{}; {} did not "
        "converge. {} {}Take smaller loads or displacements, or more or stronger fasteners; a joint without these "
        "shows "
        "the load of the others after their failure",
        scene.file, of_case, failure.reached, names(joint, failure.level),
        failure.limit ? fmt::format(", and load factor {:.6g} is an upper bound of the limit load", *failure.limit)
                      : "",
        increment, kept, locking);
  const std::string at = std::isfinite(failure.residual)
                             ? fmt::format("worst residual {:.2e} of the load, at", failure.residual)
                             : std::string("every try ended past the limit load of the law, at");
  const Index rim = failure.entry - joint.n_planes();
  const std::string place =
      rim < 0 ? joint.name(joint.planes[failure.entry]) : fmt::format("the rim of hole \"{}\"", joint.rims()[rim]);
  return fmt::format(
      "{}: {} did not converge from the last increment, in half steps ({} times halved), or from any first guess; load "
      "factor {:.6g} was reached; {} {}; the last try ended: {}. {} {}Check the law, the gap and the clearance of the "
      "fastener there, take smaller increments, allow more than {} or, if the residual is close to it, a larger "
      "tolerance than {:.0e}; and see that "
      "each plate is fixed in the direction of its load: one without supports has no stiffness while all its fasteners "
      "are open, and one-sided fasteners cannot pull it",
      scene.file, increment, max_halvings, failure.reached, at, place, failure.ending, kept, locking,
      program::counted(scene.solver.max_iterations, "iteration"), scene.solver.tolerance);
}

}  // namespace fastjoint::stage3
