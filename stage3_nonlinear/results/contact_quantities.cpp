// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/contact_quantities.hpp"

#include <algorithm>
#include "common/infinite.hpp"

#include "stage3_nonlinear/results/loaded_rims.hpp"

namespace fastjoint::stage3 {
namespace {

double in_degrees(double angle) { return rim::wrapped(angle) / rim::degree; }

/// Arcs of a rim, with those that meet at the start of a whole rim joined to one.
std::vector<rim::AngleRange> joined_arcs(const CompressionOnlyRim& rim, std::vector<rim::AngleRange> arcs) {
  const auto& [highest, start, sweep] = rim.pressures();
  if (!rim.pressures().is_whole() || arcs.size() < 2 || arcs.front().from > start || arcs.back().to < start + sweep)
    return arcs;
  arcs.back().to = arcs.front().to + sweep;
  arcs.erase(arcs.begin());
  return arcs;
}

/// Contact of a rim, in the order of the quantities.
Eigen::RowVectorXd describe(const RimProblem& problem, const RimSolution& solution) {
  const CompressionOnlyRim& rim = problem.contact();
  const auto arcs = joined_arcs(rim, solution.touching.arcs);
  const auto width = [](const rim::AngleRange& arc) { return arc.to - arc.from; };
  double touching = 0, from = 0, to = 0;
  for (const auto& arc : arcs) touching += width(arc);
  if (!arcs.empty()) {
    const auto& widest = *std::ranges::max_element(arcs, {}, width);
    from = in_degrees(widest.from);
    to = from + width(widest) / rim::degree;
  }
  const double deepest = rim.deepest(solution.w), depth = rim.depth(solution.w, deepest);
  Eigen::RowVectorXd all(7);
  all << touching / rim::degree, from, to, problem.modulus() * std::max(depth, 0.0), in_degrees(deepest),
      std::max(-depth, 0.0), rim.pressures().highest;
  return all;
}

/// Index of the first rim of a plate among all.
Index first_rim(const JointModel& joint, Index plate) {
  Index first = 0;
  for (Index i = 0; i < plate; ++i) first += std::ssize(joint.plates[i].contact);
  return first;
}

}  // namespace

PlateGroup contact_quantities(const PlateModel& plate) {
  const Index g = std::ssize(plate.contact);
  return {columns::Of::contact,
          g,
          {{"contact/touching", columns::angle, "angle over which disc and rim touch"},
           {"contact/from", columns::angle, "start of the widest arc on which they touch"},
           {"contact/to", columns::angle, "end of this arc, counter-clockwise from x"},
           {"contact/peak_pressure", columns::stress, "largest pressure on the rim", "contact_pressure"},
           {"contact/peak_angle", columns::angle, "place of this pressure, or of the smallest gap"},
           {"contact/least_gap", columns::length, "smallest gap between disc and rim, 0 where they touch"},
           {"contact/harmonics", columns::ratio, "highest order of the waves of pressure that were taken"}},
          [g](const PlateAt& at) {
            const JointEquations& equations = at.of.equations;
            const Index first = first_rim(at.of.joint, at.plate);
            MatrixXd all(g, 7);
            for (Index i = 0; i < g; ++i) {
              const RimProblem& rim = *equations.rims[first + i];
              const VectorXd c = equations.of_rim(at.of.step.c, first + i);
              all.row(i) = describe(rim.finest_at(c), rim.solve_finest(c));
            }
            return all;
          }};
}

formats::RimsAtNoLoad rims_at_no_load(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                                      Index plate) {
  const Index g = std::ssize(joint.plates[plate].contact), first = first_rim(joint, plate);
  formats::RimsAtNoLoad a{VectorXd(g), VectorXd::Zero(g), VectorXd::Zero(g), VectorXd::Constant(g, infinite)};
  for (Index i = 0; i < g; ++i) {
    const RimProblem& problem = *equations.rims[first + i];
    const CompressionOnlyRim& contact = problem.contact();
    a.gap[i] = contact.gap();
    if (!path.interference) continue;
    const VectorXd w = problem.solve(equations.of_rim(*path.assembled, first + i)).w;
    const auto pressure = [&](double sign) {
      return problem.modulus() * std::max(contact.depth(w, contact.deepest(w, sign)), 0.0);
    };
    a.peak[i] = pressure(1);
    a.least[i] = pressure(-1);
    a.full_until[i] = path.interference->lost[first + i];
  }
  return a;
}

}  // namespace fastjoint::stage3
