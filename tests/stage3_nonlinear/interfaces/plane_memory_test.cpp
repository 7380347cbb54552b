// SPDX-License-Identifier: GPL-3.0-or-later
// Laws that remember: their states are those of least potential, whatever the path.
#include "stage3_nonlinear/interfaces/plane_memory.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "stage3_nonlinear/interfaces/interface.hpp"
#include "tests/stage3_nonlinear/scenes.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr const char* bilinear = R"({"type": "bilinear", "k": 1000, "F_yield": 40, "k_yield": 100})";
constexpr const char* plastic = R"({"type": "bilinear", "k": 1000, "F_yield": 40, "k_yield": 0})";
constexpr const char* four_stage =
    R"({"type": "four stage", "k_stick": 9000, "F_slip": 20, "slip": 0.01, "k_bearing": 1000, "F_yield": 60, "k_yield": 90})";
constexpr const char* table =
    R"({"type": "table", "delta": [0.02, 0.05, 0.1, 0.2, 0.4], "F": [20, 45, 60, 70, 80], "F_yield": 40})";

std::vector<Slider> at_rest(const Law& law, double clearance, Index n) {
  return std::vector<Slider>(law.branches(clearance).size(), Slider{PlaneVector::Zero(n), PlaneVector::Zero(n)});
}

/// A law under contact coordinates, one after another.
struct Plane {
  LawPointer law;
  double clearance, k;
  std::vector<MemoryBranch> branches = law->branches(clearance);
  std::vector<Slider> sliders = {};
  bool one_sided = false;

  [[nodiscard]] RememberedState at(const PlaneVector& c) const {
    return remembered(branches, sliders, c, k, c / (2 * k), one_sided);
  }
};

PlaneVector vector_of(const RadialFunction& function, const PlaneVector& v) {
  return v.norm() > 0 ? PlaneVector(function(v.norm()).value / v.norm() * v) : PlaneVector(v);
}

/// The conditions of the least potential: the sliders' forces are within their limits, and one that has moved is at its
/// limit along its motion; the branches sum up to F, and F + k delta is c. The potential is convex: there is one state.
void expect_least_potential(const Plane& plane, const PlaneVector& c, const RememberedState& state) {
  constexpr double rounding = 1e-9;
  PlaneVector sum = PlaneVector::Zero(c.size());
  for (std::size_t b = 0; b < plane.branches.size(); ++b) {
    const MemoryBranch& branch = plane.branches[b];
    const PlaneVector set = state.sliders[b].set, moved = set - plane.sliders[b].set;
    const PlaneVector F = vector_of(branch.elastic, state.delta - set), excess = F - vector_of(branch.backstress, set);
    sum += F;
    EXPECT_LE(excess.norm(), branch.limit * (1 + rounding));
    if (moved.norm() > 1e-12) {
      EXPECT_NEAR((excess - branch.limit * moved.normalized()).norm(), 0, 1e-6 * branch.limit) << moved.norm();
    }
  }
  EXPECT_NEAR((state.F - sum).norm(), 0, rounding * (1 + c.norm()));
  EXPECT_NEAR((state.F + plane.k * state.delta - c).norm(), 0, rounding * (1 + c.norm()));
}

/// Derivatives by central differences, where none of the steps crosses a corner.
void expect_derivatives(const Plane& plane, const PlaneVector& c, const RememberedState& state) {
  const double h = 1e-6 * (1 + c.norm());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(MatrixXd(state.dF));
  EXPECT_TRUE(state.dF.isApprox(state.dF.transpose(), 1e-9));
  EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-9);
  EXPECT_LE(eigen.eigenvalues().maxCoeff(), 1 + 1e-9);
  for (Index d = 0; d < c.size(); ++d) {
    const PlaneVector step = h * PlaneVector::Unit(c.size(), d);
    const PlaneVector ahead = (plane.at(c + step).F - state.F) / h, behind = (state.F - plane.at(c - step).F) / h;
    if ((ahead - behind).norm() > 1e-4) continue;  // a corner is near
    EXPECT_NEAR((state.dF.col(d) - (ahead + behind) / 2).norm(), 0, 2e-4);
  }
}

class PlaneMemoryOf : public testing::TestWithParam<const char*> {};

TEST_P(PlaneMemoryOf, IsTheLeastPotentialOnRandomPaths) {
  for (int seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Index n = 1 + seed % 2;
    Plane plane{test::law_of(GetParam()), seed % 3 == 0 ? 0.02 : 0, uniform(300, 3000)};
    plane.sliders = at_rest(*plane.law, plane.clearance, n);
    double dissipated = 0;
    for (int step = 0; step < 20; ++step) {
      const PlaneVector c = PlaneVector::NullaryExpr(n, [&] { return uniform(-200, 200); });
      const RememberedState state = plane.at(c);
      SCOPED_TRACE(fmt::format("seed {}, step {}", seed, step));
      expect_least_potential(plane, c, state);
      expect_derivatives(plane, c, state);
      double now = 0;
      for (const Slider& slider : state.sliders) now += slider.dissipated;
      EXPECT_GE(now, dissipated) << "slip and yield take energy";
      dissipated = now;
      plane.sliders = state.sliders;
    }
  }
}

TEST_P(PlaneMemoryOf, IsTheLawsOwnCurveFromNoSet) {
  for (const double clearance : {0.0, 0.015}) {
    Plane plane{test::law_of(GetParam()), clearance, 700};
    plane.sliders = at_rest(*plane.law, clearance, 2);
    for (const double c : {1.0, 10.0, 30.0, 55.0, 70.0, 120.0, 300.0}) {
      const PlaneVector way = Eigen::Vector2d(0.6, -0.8);
      const RememberedState state = plane.at(c * way);
      const Branch curve = plane.law->at(c, plane.k, clearance);
      EXPECT_NEAR((state.F - curve.F * way).norm(), 0, 1e-9) << c;
      EXPECT_NEAR((state.delta - curve.delta * way).norm(), 0, 1e-12) << c;
      EXPECT_NEAR(way.dot(state.dF * way), curve.dF, 1e-6) << c;
    }
  }
}

TEST_P(PlaneMemoryOf, DoesNotDependOnTheIncrementsAlongALine) {
  for (const bool one_sided : {false, true}) {
    Plane once{test::law_of(GetParam()), 0.01, 500}, often = once;
    once.one_sided = often.one_sided = one_sided;
    once.sliders = often.sliders = at_rest(*once.law, once.clearance, 1);
    double from = 0;
    for (const double to : {90.0, -70.0, 120.0, 5.0, 200.0, -130.0, 20.0}) {
      constexpr int parts = 16;
      for (int i = 1; i <= parts; ++i)
        often.sliders = often.at(PlaneVector::Constant(1, from + (to - from) * i / parts)).sliders;
      const RememberedState state = once.at(PlaneVector::Constant(1, to));
      once.sliders = state.sliders;
      EXPECT_NEAR(often.at(PlaneVector::Constant(1, to)).F[0], state.F[0], 1e-9) << to;
      if (one_sided) {
        EXPECT_GE(state.F[0], 0) << to;
      }
      for (std::size_t b = 0; b < once.sliders.size(); ++b)
        EXPECT_NEAR(often.sliders[b].dissipated, once.sliders[b].dissipated, 1e-9) << to << one_sided;
      from = to;
    }
  }
}

constexpr const char* straight_table =
    R"({"type": "table", "delta": [0.1, 0.2, 0.3, 0.4], "F": [20, 40, 60, 66], "F_yield": 40})";
constexpr const char* steep_table = R"({"type": "table", "delta": [0.3, 0.7, 1.2], "F": [40, 80, 80], "F_yield": 40})";
constexpr const char* steady_bearing =
    R"({"type": "four stage", "k_stick": 9000, "F_slip": 20, "slip": 0.01, "k_bearing": 90, "F_yield": 60, "k_yield": 90})";
INSTANTIATE_TEST_SUITE_P(Each, PlaneMemoryOf,
                         testing::Values(bilinear, plastic, four_stage, table, straight_table, steep_table,
                                         steady_bearing));

/// Masing's rule: a bilinear law goes back with its first slope, yields after twice the yield force, and a cycle
/// between
/// +-A takes 4 F_yield (A - F_yield) (1 / k_yield - 1 / k).
TEST(PlaneMemory, OfABilinearLawFollowsMasing) {
  constexpr double k = 1000, F_yield = 40, k_yield = 100, A = 70, stiffness = 1;
  Plane plane{test::law_of(bilinear), 0, stiffness};
  plane.sliders = at_rest(*plane.law, 0, 1);
  // The displacement at a force of the branch that is followed, and c = F + stiffness delta.
  const auto go = [&](double F, double delta) {
    const RememberedState state = plane.at(PlaneVector::Constant(1, F + stiffness * delta));
    EXPECT_NEAR(state.F[0], F, 1e-9);
    EXPECT_NEAR(state.delta[0], delta, 1e-12);
    plane.sliders = state.sliders;
    return state.sliders[0].dissipated;
  };
  const double top = F_yield / k + (A - F_yield) / k_yield;
  const auto back = [&](double F) {  // the loading curve, turned and twice as large
    const double down = A - F;
    return top - (down < 2 * F_yield ? down / k : 2 * F_yield / k + (down - 2 * F_yield) / k_yield);
  };
  go(A, top);
  for (const double F : {30.0, 0.0, -9.0, -30.0}) go(F, back(F));
  const double before = go(-A, back(-A));
  for (const double F : {-30.0, 5.0, 30.0}) go(F, -back(-F));
  go(A, -back(-A));
  EXPECT_NEAR(back(-A), -top, 1e-15);
  const double cycle = go(-A, back(-A)) - before;
  EXPECT_NEAR(cycle, 4 * F_yield * (A - F_yield) * (1 / k_yield - 1 / k), 1e-9);
}

/// The friction of a four-stage law before its rim bears: a spring and a slider.
TEST(PlaneMemory, OfAJenkinsElementIsItsParallelogram) {
  Plane plane{test::law_of(R"({"type": "four stage", "k_stick": 500, "F_slip": 20, "slip": 100, "k_bearing": 1,
                               "F_yield": 50, "k_yield": 0})"),
              0, 1};
  plane.sliders = at_rest(*plane.law, 0, 1);
  double dissipated = 0;
  for (const double delta : {1.0, -1.0, 1.0}) {
    const double F = delta > 0 ? 20 : -20;
    const RememberedState state = plane.at(PlaneVector::Constant(1, F + delta));
    EXPECT_NEAR(state.F[0], F, 1e-9);
    plane.sliders = state.sliders;
    const double now = state.sliders[0].dissipated;
    EXPECT_NEAR(now - dissipated, 20 * (dissipated == 0 ? 1 - 0.04 : 2 - 0.08), 1e-9);
    dissipated = now;
  }
}

}  // namespace
}  // namespace fastjoint::stage3
