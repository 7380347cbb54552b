// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of unloaded fasteners: of elastic laws and of friction, which do not depend on the history.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

/// LargestVector vector of a plane so far.
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

/// First hole of a plane among all holes of fasteners.
Index first_hole(const JointModel& joint, const ShearPlane& plane) {
  Index first = plane.first;
  for (Index i = 0; i < plane.fastener; ++i) first += std::ssize(joint.fasteners[i].holes);
  return first;
}

}  // namespace

void warn_of_turning_friction(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                              std::vector<program::Warning>& result) {
  constexpr double rounding = 1e-9;
  const Index a = equations.n_directions();
  std::vector<LargestVector> largest(equations.n_planes(), LargestVector(a));
  for (const PathStep& step : path.steps) {
    std::vector<Index> turned;
    for (Index j = 0; j < std::ssize(largest); ++j) {
      const ShearPlane& plane = joint.planes[j];
      const Index n_holes = std::ssize(joint.holes(plane));
      const bool has_friction = equations.parameters.mu.segment(first_hole(joint, plane), n_holes).maxCoeff() > 0;
      if (has_friction && largest[j].falls_short(step.F.segment(j * a, a), rounding * step.scale)) turned.push_back(j);
    }
    if (turned.empty()) continue;
    result.push_back(
        {"friction-turns",
         fmt::format("{} unloads {}, where friction still acts as if it slipped in the direction of the force: real "
                     "friction first sticks and then turns, so that real forces differ from this increment on",
                     increment_text(path, step), names(joint, turned))});
    return;
  }
}

void warn_of_unloading(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                       std::vector<program::Warning>& result) {
  const ContactCorners corners(equations);
  const Index a = equations.n_directions();
  std::vector<LargestVector> largest(equations.n_planes(), LargestVector(a));
  for (const PathStep& step : path.steps) {
    std::vector<Index> unloaded;
    for (Index j = 0; j < std::ssize(largest); ++j) {
      const double before = largest[j].magnitude();
      const bool falls = largest[j].falls_short(step.c.segment(j * a, a));
      const auto passed = [&](const Corner& each) { return each.kind != CornerKind::contact && each.at < before; };
      const Contact& contact = equations.contacts[j];
      const double k = contact.stiffness, gap = contact.law->gap(contact.clearance);
      if (contact.law->remembers()) continue;
      const bool curved =
          !contact.law->corners(k, contact.clearance) && before > k * gap + corners.nearness(step.c, k * gap);
      if (falls && (curved || std::any_of(corners.of(j).begin(), corners.of(j).end(), passed))) unloaded.push_back(j);
    }
    if (unloaded.empty()) continue;
    result.push_back(
        {"permanent-set",
         fmt::format("{} unloads {} along its loading curve: this law keeps no permanent set, but real fasteners do, "
                     "so that real forces differ from this increment on",
                     increment_text(path, step), names(joint, unloaded))});
    return;
  }
}

}  // namespace fastjoint::stage3
