// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of unloaded fasteners: of elastic laws and of friction, which do not depend on the history.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

/// The largest vector of a plane so far.
class LargestVector {
 public:
  explicit LargestVector(Index n_directions) : largest_(VectorXd::Zero(n_directions)) {}

  [[nodiscard]] double magnitude() const { return largest_.norm(); }
  /// Tells whether the next vector is smaller or turns away, and keeps it if it is larger.
  /// @param negligible Magnitudes up to this do not count.
  [[nodiscard]] bool falls_short(const VectorXd& next, double negligible = 0) {
    constexpr double min_ratio = 1 - 1e-6, min_cosine = 0.5;  // to the largest; of the angle between both
    const double before = largest_.norm(), now = next.norm();
    const bool falls =
        before > negligible && (now < min_ratio * before || largest_.dot(next) < min_cosine * now * before);
    if (now > before) largest_ = next;
    return falls;
  }

 private:
  VectorXd largest_;
};

/// Warns of the first increment at which planes unload.
/// @param unloads Of a plane at an increment; called for all planes of the increments up to that.
template <class Unloads>
void warn_of_first(const char* code, const char* text, const JointModel& joint, const LoadPath& path, Unloads unloads,
                   WarningList& list) {
  for (const PathStep& step : path.steps) {
    std::vector<Index> planes;
    for (Index j = 0; j < joint.n_planes(); ++j)
      if (unloads(step, j)) planes.push_back(j);
    if (planes.empty()) continue;
    list.add(code, "{} unloads {}{}", increment_text(path, step), names(joint, planes), text);
    return;
  }
}

}  // namespace

void warn_of_unloading(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                       WarningList& list) {
  const ContactCorners corners(equations);
  const Index a = equations.n_directions();
  std::vector<LargestVector> deflections(equations.n_planes(), LargestVector(a)), forces = deflections;
  const auto unloads = [&](const PathStep& step, Index j) {
    const double before = deflections[j].magnitude();
    const bool falls = deflections[j].falls_short(step.c.segment(j * a, a));
    const Contact& contact = equations.contacts[j];
    if (!falls || contact.law->remembers()) return false;
    const double k = contact.stiffness, gap = contact.law->gap(contact.clearance);
    const auto passed = [&](const Corner& each) { return each.kind != CornerKind::contact && each.at < before; };
    const bool curved =
        !contact.law->corners(k, contact.clearance) && before > k * gap + corners.nearness(step.c, k * gap);
    return curved || std::ranges::any_of(corners.of(j), passed);
  };
  const auto turns = [&](const PathStep& step, Index j) {
    constexpr double rounding = 1e-9;
    const ShearPlane& plane = joint.planes[j];
    const auto mu = equations.parameters.mu.segment(joint.number_of_first_hole(plane), std::ssize(joint.holes(plane)));
    return mu.maxCoeff() > 0 && forces[j].falls_short(step.F.segment(j * a, a), rounding * step.scale);
  };
  warn_of_first("permanent-set",
                " along its loading curve: this law keeps no permanent set, but real fasteners do, so "
                "that real forces differ from this increment on",
                joint, path, unloads, list);
  warn_of_first("friction-turns",
                ", where friction still acts as if it slipped in the direction of the force: real "
                "friction first sticks and then turns, so that real forces differ from this increment on",
                joint, path, turns, list);
}

}  // namespace fastjoint::stage3
