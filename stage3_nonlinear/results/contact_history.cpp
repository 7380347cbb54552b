// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/contact_history.hpp"

#include <algorithm>
#include <limits>

#include "stage3_nonlinear/results/loaded_rims.hpp"

namespace fastjoint::stage3 {
namespace {

double in_degrees(double angle) { return rim::wrapped(angle) / rim::degree; }

/// Arcs of a rim, with those that meet at the start of a whole rim joined to one.
std::vector<rim::AngleRange> joined_arcs(const RimContact& rim, std::vector<rim::AngleRange> arcs) {
  const auto& [highest, start, sweep] = rim.pressures();
  if (!rim.pressures().is_whole() || arcs.size() < 2 || arcs.front().from > start || arcs.back().to < start + sweep)
    return arcs;
  arcs.back().to = arcs.front().to + sweep;
  arcs.erase(arcs.begin());
  return arcs;
}

/// Writes the contact of a rim at a step.
void describe(const RimProblem& problem, const VectorXd& c, Index step, Index at, formats::ContactHistory& a) {
  const RimContact& rim = problem.contact();
  const RimSolution& solution = problem.solve(c);
  const auto arcs = joined_arcs(rim, solution.touching.arcs);
  const auto width = [](const rim::AngleRange& arc) { return arc.to - arc.from; };
  double touching = 0;
  for (const auto& arc : arcs) touching += width(arc);
  a.touching(step, at) = touching / rim::degree;
  if (!arcs.empty()) {
    const auto& widest = *std::ranges::max_element(arcs, {}, width);
    a.from(step, at) = in_degrees(widest.from);
    a.to(step, at) = a.from(step, at) + width(widest) / rim::degree;
  }
  const double deepest = rim.deepest(solution.w), depth = rim.depth(solution.w, deepest);
  a.peak_pressure(step, at) = problem.modulus() * std::max(depth, 0.0);
  a.peak_angle(step, at) = in_degrees(deepest);
  a.least_gap(step, at) = std::max(-depth, 0.0);
}

}  // namespace

std::vector<formats::ContactHistory> contact_histories(const JointModel& joint, const JointEquations& equations,
                                                       const LoadPath& path) {
  std::vector<formats::ContactHistory> histories;
  const Index steps = std::ssize(path.steps);
  Index rim = 0;
  for (const auto& plate : joint.plates) {
    const Index g = std::ssize(plate.contact);
    formats::ContactHistory& a = histories.emplace_back();
    a.gap.resize(g);
    a.no_load_peak = a.no_load_least = VectorXd::Zero(g);
    a.full_until = VectorXd::Constant(g, std::numeric_limits<double>::infinity());
    for (auto* table : {&a.touching, &a.from, &a.to, &a.peak_pressure, &a.peak_angle, &a.least_gap})
      *table = MatrixXd::Zero(steps, g);
    for (Index at = 0; at < g; ++at, ++rim) {
      const RimProblem& problem = *equations.rims[rim];
      const RimContact& contact = problem.contact();
      a.gap[at] = contact.gap();
      if (path.interference) {
        const VectorXd w = problem.solve(equations.of_rim(*path.assembled, rim)).w;
        const auto pressure = [&](double sign) {
          return problem.modulus() * std::max(contact.depth(w, contact.deepest(w, sign)), 0.0);
        };
        a.no_load_peak[at] = pressure(1);
        a.no_load_least[at] = pressure(-1);
        a.full_until[at] = path.interference->lost[rim];
      }
      for (Index step = 0; step < steps; ++step)
        describe(problem, equations.of_rim(path.steps[step].c, rim), step, at, a);
    }
  }
  return histories;
}

}  // namespace fastjoint::stage3
