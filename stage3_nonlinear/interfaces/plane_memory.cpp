// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/interfaces/plane_memory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace fastjoint::stage3 {
namespace {

constexpr int max_plane_iterations = 1000;  // a few, but for curves with sharp bends along x and y
constexpr double small_residual = 8 * std::numeric_limits<double>::epsilon();

PlaneMatrix identity(Eigen::Index n) { return PlaneMatrix::Identity(n, n); }

/// A radial function of a vector with its derivative.
struct Along {
  PlaneVector value;
  PlaneMatrix slope;
};

Along radial(const RadialFunction& function, const PlaneVector& v) {
  const double length = v.norm();
  const auto [value, slope] = function(length);
  if (length == 0) return {PlaneVector::Zero(v.size()), slope * identity(v.size())};
  const PlaneVector e = v / length;
  const double across = value / length;
  return {value * e, (slope - across) * e * e.transpose() + across * identity(v.size())};
}

/// Root of the gradient of a convex function by Newton's method with an exact search along each step.
/// @param at x -> gradient and a positive semi-definite matrix near its derivative. @param size Of terms of the
/// gradient.
template <class Function>
PlaneVector minimum(Function at, PlaneVector x, double size) {
  for (int i = 0; i < max_plane_iterations; ++i) {
    const Along here = at(x);
    if (here.value.norm() <= small_residual * size) break;
    PlaneMatrix H = here.slope;
    H.diagonal().array() += 1e-14 * H.trace();
    const PlaneVector d = -H.inverse() * here.value;
    const auto rate = [&](double t) { return d.dot(at(x + t * d).value); };
    double t = 1;
    if (rate(1) > -0.1 * d.dot(here.value)) {  // has passed the minimum by far
      double low = 0, high = 1;
      for (int k = 0; k < 50 && high - low > 1e-3 * high; ++k) (rate(t = 0.5 * (low + high)) > 0 ? high : low) = t;
      t = low > 0 ? low : high;
    }
    const PlaneVector next = x + t * d;
    if (next == x) break;
    x = next;
  }
  return x;
}

/// A branch under a displacement.
struct BranchState {
  PlaneVector F;
  PlaneMatrix dF;  ///< by the displacement
  PlaneVector set;
};

BranchState under(const MemoryBranch& branch, bool one_sided, const PlaneVector& before, const PlaneVector& delta) {
  const Eigen::Index n = delta.size();
  const auto force = [&](const PlaneVector& stretch) -> Along {
    if (one_sided && stretch[0] < 0) return {PlaneVector::Zero(1), PlaneMatrix::Zero(1, 1)};
    return radial(branch.elastic, stretch);
  };
  const Along elastic = force(delta - before), back = radial(branch.backstress, before);
  const PlaneVector excess = elastic.value - back.value;
  const double over = excess.norm() - branch.limit;
  const double size = elastic.value.norm() + back.value.norm() + branch.limit;
  if (over <= small_residual * size) return {elastic.value, elastic.slope, before};
  // Gradient by the set; beyond its place before, where the norm of its motion has a kink.
  const auto at = [&](const PlaneVector& s) -> Along {
    const Along F = force(delta - s), X = radial(branch.backstress, s);
    const PlaneVector moved = s - before;
    const double length = moved.norm();
    const PlaneVector way = length > 0 ? PlaneVector(moved / length) : PlaneVector(excess.normalized());
    PlaneMatrix H = F.slope + X.slope;
    if (n > 1 && length > 0) H += branch.limit / length * (identity(n) - way * way.transpose());
    return {X.value - F.value + branch.limit * way, H};
  };
  const PlaneVector way = excess.normalized();
  // The backstress alone moves the slider of a branch that has opened.
  const double stiffness = std::max(way.dot((elastic.slope + back.slope) * way), std::numeric_limits<double>::min());
  const PlaneVector s = minimum(at, before + over / stiffness * way, size);
  const Along F = force(delta - s);
  PlaneMatrix H = at(s).slope;
  H.diagonal().array() += std::numeric_limits<double>::min();
  return {F.value, F.slope - F.slope * H.inverse() * F.slope, s};
}

}  // namespace

RememberedState remembered(const std::vector<MemoryBranch>& branches, const std::vector<Slider>& before,
                           const PlaneVector& c, double k, const PlaneVector& start, bool one_sided) {
  const Eigen::Index n = c.size();
  const auto force = [&](const PlaneVector& delta) -> Along {
    Along sum{PlaneVector::Zero(n), PlaneMatrix::Zero(n, n)};
    for (std::size_t b = 0; b < branches.size(); ++b) {
      const BranchState state = under(branches[b], one_sided, before[b].set, delta);
      sum.value += state.F;
      sum.slope += state.dF;
    }
    return sum;
  };
  const auto at = [&](const PlaneVector& delta) -> Along {
    const Along sum = force(delta);
    return {sum.value + k * delta - c, sum.slope + k * identity(n)};
  };
  double size = c.norm() + k * start.norm();
  for (const Slider& slider : before) size += k * slider.set.norm();
  const PlaneVector delta = minimum(at, start, size);
  const Along there = force(delta);
  const PlaneMatrix inverse = (there.slope + k * identity(n)).inverse();
  RememberedState result{there.value, (c - there.value) / k, identity(n) - k * inverse, inverse, {}};
  for (std::size_t b = 0; b < branches.size(); ++b) {
    constexpr double rounding = 1e-9;
    const PlaneVector set = under(branches[b], one_sided, before[b].set, delta).set;
    PlaneVector motion = set - before[b].set;
    const double moved = motion.norm();
    if (!(moved > rounding * (delta.norm() + set.norm()))) motion.setZero();
    result.sliders.push_back({set, motion, before[b].dissipated + (moved > 0 ? branches[b].limit * moved : 0)});
  }
  return result;
}

}  // namespace fastjoint::stage3
