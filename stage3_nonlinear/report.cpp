// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "stage3_nonlinear/rim_history.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

constexpr std::size_t least_name = 12;

/// Width of the column of names: fasteners and plates share it.
std::size_t name_width(const JointModel& joint) {
  std::size_t width = least_name;
  for (const auto& fastener : joint.fasteners) width = std::max(width, fastener.id.size());
  for (const auto& plate : joint.plates) width = std::max(width, plate.name.size());
  return width;
}

/// A column head with its unit, "delta [in]".
std::string head(const std::string& name, const std::string& unit) { return fmt::format("{} [{}]", name, unit); }

/// Zero instead of rounding.
double rounded(double force, double largest) {
  constexpr double rounding = 1e-10;
  return std::abs(force) <= rounding * largest ? 0 : force;
}

std::string title(const JointScene& scene, const JointModel& joint, const LoadPath& path) {
  std::string text = fmt::format("joint{}: {} plates, {} fasteners, p = {}, {}\n",
                                 scene.name.empty() ? "" : fmt::format(" \"{}\"", scene.name), joint.plates.size(),
                                 joint.fasteners.size(), joint.p, path.linear ? "linear" : "hybrid method");
  for (const auto& plate : joint.plates)
    if (plate.relative_error)
      text += fmt::format("stiffness of {} known to {:.1e} of its largest entry\n", plate.name, *plate.relative_error);
  return text;
}

std::string fastener_table(const JointModel& joint, const PathStep& step, const JointState& state, std::size_t width) {
  const bool differ = !state.transferred_first.isApprox(state.transferred_second, 1e-9);  // beyond rounding
  const std::string length = formats::unit(joint.units, 1, 0);
  const std::string force = formats::unit(joint.units, 0, 1);
  std::string text = fmt::format("  {:<{}} {:>16} {:>16} {:>20}", "fastener", width, head("delta", length),
                                 head("F", force), head(differ ? "to 1st" : "transferred", force));
  if (differ) text += fmt::format(" {:>20}", head("to 2nd", force));
  text += fmt::format(" {:>9}\n", "share [%]");
  const Eigen::VectorXd share = shares(state.transferred_first);
  for (Index j = 0; j < step.F.size(); ++j) {
    text += fmt::format("  {:<{}} {:>16.8g} {:>16.8g} {:>20.8g}", joint.fasteners[static_cast<std::size_t>(j)].id,
                        width, step.delta[j], step.F[j], state.transferred_first[j]);
    if (differ) text += fmt::format(" {:>20.8g}", state.transferred_second[j]);
    text += std::isfinite(share[j]) ? fmt::format(" {:>9.3f}\n", share[j]) : fmt::format(" {:>9}\n", "-");
  }
  return text;
}

std::string plate_table(const JointModel& joint, const JointState& state, std::size_t width) {
  const std::string force = formats::unit(joint.units, 0, 1);
  std::string text = fmt::format("  {:<{}} {:>16} {:>16} {:>20}\n", "on plate", width, head("applied", force),
                                 head("fasteners", force), head("supports", force));
  for (std::size_t i = 0; i < joint.plates.size(); ++i) {
    const PlateState& plate = state.plates[i];
    text += fmt::format("  {:<{}} {:>16.8g} {:>16.8g} {:>20.8g}\n", joint.plates[i].name, width,
                        rounded(plate.applied, state.largest_force), rounded(plate.by_fasteners, state.largest_force),
                        rounded(plate.by_supports, state.largest_force));
  }
  return text +
         fmt::format("  equilibrium: worst row out of balance by {:.1e} of the largest force\n", state.out_of_balance);
}

std::string stress_table(const JointModel& joint, const JointState& state) {
  std::string text;
  for (const auto& plate : joint.plates)
    if (!plate.stress_level && plate.stresses.p.size() > 0)
      text += fmt::format("no stresses of {}: {} holds them at p = {} only\n", plate.name, plate.file,
                          fmt::join(plate.stresses.p, ", "));
  const std::string table = rim_table(joint, state);
  return table.empty() ? text : fmt::format("{}stresses at the last increment\n{}", text, table);
}

/// Named with the first increment at which it happens, once per fastener.
void warn_beyond_last_point(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                            std::vector<std::string>& result) {
  for (std::size_t j = 0; j < joint.fasteners.size(); ++j) {
    const Contact& contact = equations.contacts[j];
    for (const auto& step : path.steps) {
      const double delta = step.delta[static_cast<Index>(j)];
      const bool open = contact.one_sided && delta < 0;
      if (open || std::abs(delta) - contact.gap <= contact.law->last_stretch()) continue;
      result.push_back(fmt::format(
          "{}: fastener \"{}\": delta = {:.6g} at load factor {:.6g} is beyond the last point "
          "{:.6g} of its law (gap included), which is extrapolated there",
          joint.file, joint.fasteners[j].id, delta, step.load_factor, contact.gap + contact.law->last_stretch()));
      break;
    }
  }
}

void warn_undetermined(const JointModel& joint, const LoadPath& path, std::vector<std::string>& result) {
  for (const auto& step : path.steps) {
    if (step.undetermined.empty()) continue;
    std::vector<std::string> open;
    open.reserve(step.undetermined.size());
    for (const Index j : step.undetermined)
      open.push_back(fmt::format("\"{}\"", joint.fasteners[static_cast<std::size_t>(j)].id));
    result.push_back(
        fmt::format("{}: at load factor {:.6g} a plate that only fasteners hold is free within the gaps of {}: the "
                    "forces are right, its displacement is one of many",
                    joint.file, step.load_factor, fmt::join(open, ", ")));
    return;
  }
}

}  // namespace

std::string summary(const JointScene& scene, const JointModel& joint, const LoadPath& path,
                    const std::vector<JointState>& states) {
  const std::size_t width = name_width(joint);
  std::string text = title(scene, joint, path);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const PathStep& step = path.steps[i];
    text += fmt::format("increment {} of {}: load factor {:.6g}, {} {}, residual {:.1e} of the largest force\n", i + 1,
                        scene.load_factors.size(), step.load_factor, step.iterations,
                        path.linear ? "linear solves" : "iterations", step.residual);
    text += fastener_table(joint, step, states[i], width) + plate_table(joint, states[i], width);
  }
  if (!states.empty()) text += stress_table(joint, states.back());
  return text;
}

std::vector<std::string> warnings(const JointModel& joint, const JointEquations& equations, const LoadPath& path) {
  std::vector<std::string> result;
  warn_beyond_last_point(joint, equations, path, result);
  warn_undetermined(joint, path, result);
  return result;
}

std::string failure_message(const JointScene& scene, const PathFailure& failure, const std::string& output) {
  const std::string at = std::isfinite(failure.residual)
                             ? fmt::format("worst residual {:.2e} of the largest force, at", failure.residual)
                             : std::string("every try ended past all that the law carries, at");
  const std::string what = fmt::format(
      "increment {} of {} (load factor {:.6g}) did not converge from the last increment, from any first "
      "guess, or after {} halvings of the step; load factor {:.6g} was reached; {} fastener \"{}\"",
      failure.increment + 1, scene.load_factors.size(), failure.load_factor, max_halvings, failure.reached, at,
      scene.fasteners[static_cast<std::size_t>(failure.fastener)].id);
  const std::string advice = fmt::format(
      "Check the law and the clearance of that fastener (a cubic that turns down carries no more than its "
      "peak), take smaller increments, allow more than {} iterations or, if the residual is close to it, a "
      "larger tolerance than {:.0e}; and see that each plate is held in the sense of its load: one that "
      "only fasteners hold has no stiffness while all of them are open, and one-sided fasteners cannot "
      "pull it",
      scene.solver.max_iterations, scene.solver.tolerance);
  return fmt::format("{}: {}. {} holds the {} increments before (complete = 0). {}", scene.file, what, output,
                     failure.increment, advice);
}

}  // namespace fastjoint::stage3
