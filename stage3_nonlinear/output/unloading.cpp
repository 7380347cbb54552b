// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings of fasteners that are unloaded, of which neither laws nor friction keep a memory.
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "stage3_nonlinear/output/output.hpp"

namespace fastjoint::stage3 {
namespace {

/// Largest of the vectors of a plane so far, and whether the next falls short of it or turns from it.
class Largest {
 public:
  explicit Largest(Index n_directions) : most_(VectorXd::Zero(n_directions)) {}

  [[nodiscard]] double amount() const { return most_.norm(); }
  /// @param little Amounts that do not count.
  [[nodiscard]] bool falls_short(const VectorXd& next, double little = 0) {
    constexpr double less = 1 - 1e-6, turned = 0.5;  // of the largest; the cosine of how far a force may turn
    const double before = most_.norm(), now = next.norm();
    const bool falls = before > little && (now < less * before || most_.dot(next) < turned * now * before);
    if (now > before) most_ = next;
    return falls;
  }

 private:
  VectorXd most_;
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
  std::vector<Largest> most(equations.n_planes(), Largest(a));
  for (const PathStep& step : path.steps) {
    std::vector<Index> turned;
    for (Index j = 0; j < std::ssize(most); ++j) {
      const ShearPlane& plane = joint.planes[j];
      const Index n_holes = std::ssize(joint.holes(plane));
      const bool rubs = equations.parameters.mu.segment(first_hole(joint, plane), n_holes).maxCoeff() > 0;
      if (rubs && most[j].falls_short(step.F.segment(j * a, a), rounding * step.scale)) turned.push_back(j);
    }
    if (turned.empty()) continue;
    result.push_back(
        {"friction-turns",
         fmt::format("{} unloads {}, where friction goes on as if it slipped in the sense of the force: real friction "
                     "first sticks and then turns, so that forces from this increment on differ from theirs",
                     increment_text(path, step), names(joint, turned))});
    return;
  }
}

void warn_of_unloading(const JointModel& joint, const JointEquations& equations, const LoadPath& path,
                       std::vector<program::Warning>& result) {
  const ContactCorners corners(equations);
  const Index a = equations.n_directions();
  std::vector<Largest> most(equations.n_planes(), Largest(a));
  for (const PathStep& step : path.steps) {
    std::vector<Index> unloaded;
    for (Index j = 0; j < std::ssize(most); ++j) {
      const double before = most[j].amount();
      const bool falls = most[j].falls_short(step.c.segment(j * a, a));
      const auto passed = [&](const Corner& each) { return each.kind != CornerKind::contact && each.at < before; };
      const Contact& contact = equations.contacts[j];
      const double k = contact.stiffness, gap = contact.law->gap(contact.clearance);
      const bool curved =
          !contact.law->corners(k, contact.clearance) && before > k * gap + corners.nearness(step.c, k * gap);
      if (falls && (curved || std::any_of(corners.of(j).begin(), corners.of(j).end(), passed))) unloaded.push_back(j);
    }
    if (unloaded.empty()) continue;
    result.push_back(
        {"permanent-set",
         fmt::format("{} unloads {} along its loading curve: laws have no memory, but real fasteners keep a permanent "
                     "set, so that forces from this increment on differ from theirs",
                     increment_text(path, step), names(joint, unloaded))});
    return;
  }
}

}  // namespace fastjoint::stage3
