// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/springs.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "common/errors.hpp"
#include "tests/support/message.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

constexpr double k = 1e6, t = 0.1, r = 0.25;

/// One square cell with a hole in its middle (or on its lower border), discs in x and y.
std::string hole_on(const std::string& spring, bool half = false) {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [-1, 1], "y": [{}, 1], "thickness": 0.1}}}},
    "holes": [{{"id": "h", "center": [0, 0], "radius": 0.25, "spring": {{{}}}}}], "disc_directions": ["x", "y"]}})",
                     half ? 0 : -1, spring);
}

std::string refusal(const std::string& json) {
  return test::message_of([&] { return test::make_plate(json); });
}

/// int k t (cos^2, sin cos, sin^2) r dtheta from a to b.
Eigen::Matrix2d arc_stiffness(double a, double b) {
  const double s2 = (std::sin(2 * b) - std::sin(2 * a)) / 4;
  const double sc = (std::pow(std::sin(b), 2) - std::pow(std::sin(a), 2)) / 2;
  Eigen::Matrix2d K;
  K << (b - a) / 2 + s2, sc, sc, (b - a) / 2 - s2;
  return k * t * r * K;
}

/// The ends lie inside the sides of elements, which span 45 degrees; one arc runs over 180 degrees.
TEST(Springs, AnArcIsIntegratedExactly) {
  for (const auto& [from, to] : {std::pair(-70.0, 25.0), std::pair(100.0, 290.0), std::pair(0.0, 1.0)}) {
    const auto plate = test::make_plate(hole_on(fmt::format(R"("modulus": 1e6, "arc": [{}, {}])", from, to)));
    const Eigen::Matrix2d expected = arc_stiffness(from * pi / 180, to * pi / 180);
    EXPECT_LT((plate.problem.K_cc - expected).norm(), 1e-13 * k * t * r) << from;
    const auto acts = plate.scene.holes[0].sprung().arcs;
    ASSERT_EQ(acts.size(), 1U);
    EXPECT_NEAR(acts[0].from, from * pi / 180, 1e-15);
    EXPECT_NEAR(acts[0].to, to * pi / 180, 1e-15);
  }
}

Eigen::MatrixXd K_ff(const test::Plate& plate) { return test::free_stiffness(plate.scene, plate.mesh, plate.problem); }

TEST(Springs, ArcsThatMakeTheCircleAddUp) {
  const auto stiffness = [](const std::string& arc) {
    const auto plate = test::make_plate(hole_on(fmt::format(R"("modulus": 1e6, "arc": {})", arc)));
    return std::pair(K_ff(plate), plate.problem.K_cc);
  };
  const auto whole = test::make_plate(hole_on(R"("modulus": 1e6)"));
  const auto none = test::make_plate(hole_on(R"("modulus": 1e-100)"));  // the plate alone
  const auto a = stiffness("[-33, 71]"), b = stiffness("[71, 327]");
  const Eigen::MatrixXd sum = a.first + b.first - K_ff(none);
  EXPECT_LT((sum - K_ff(whole)).norm(), 1e-13 * sum.norm());
  EXPECT_LT((a.second + b.second - whole.problem.K_cc).norm(), 1e-13 * whole.problem.K_cc.norm());
}

TEST(Springs, AnArcBesideTheModelIsRefused) {
  EXPECT_THAT(refusal(hole_on(R"("modulus": 1, "arc": [190, 350])", true)),
              HasSubstr("plate.json: /holes/0/spring/arc: no part of the rim of hole \"h\" in the model"));
  EXPECT_EQ(refusal(hole_on(R"("modulus": 1, "arc": [170, 350])", true)), "no error");
}

/// 8 nodes, 45 degrees apart: sum K n n^T = 4 K; a half rim has 5 nodes, half a link on either end.
TEST(Springs, LinksAreOneForEachNodeOfTheRim) {
  const auto whole = test::make_plate(hole_on(R"("links": 100)"));
  EXPECT_LT((whole.problem.K_cc - 400 * Eigen::Matrix2d::Identity()).norm(), 1e-11);
  const auto half = test::make_plate(hole_on(R"("links": 100)", true));
  ASSERT_EQ(half.problem.K_cc.size(), 1) << "the line of symmetry holds it across";
  EXPECT_NEAR(half.problem.K_cc(0, 0), 200, 1e-11);
  const auto spring = whole.scene.holes[0].sprung();
  EXPECT_EQ(spring.modulus, 0);
  EXPECT_EQ(spring.arcs.size(), 1U);
}

/// The nodes are at 0, 45 and 90 degrees: the first has half a link from the side inside the arc, the last none.
TEST(Springs, LinksOutsideTheArcAreNone) {
  const auto plate = test::make_plate(hole_on(R"("links": 100, "arc": [0, 80])"));
  Eigen::Matrix2d expected = 50 * Eigen::Vector2d::UnitX() * Eigen::RowVector2d::UnitX();
  expected += 100 * Eigen::Matrix2d::Constant(0.5);
  EXPECT_LT((plate.problem.K_cc - expected).norm(), 1e-11);
}

/// Springs resist no motion of plate and disc together.
TEST(Springs, LinksCostNothingWhenEverythingMoves) {
  const auto plate = test::make_plate(hole_on(R"("links": 100)"));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(plate.problem.K_fc.rows());
  for (int node = 0; node < plate.mesh.mesh.n_nodes(); ++node) u[plate.problem.unknowns.dofs(0, node)] = 1;
  const Eigen::VectorXd f = K_ff(plate) * u + plate.problem.K_fc.col(0);
  EXPECT_LT(f.norm(), 1e-13 * 1e7);
}

TEST(Springs, WhatTheyAreMustBeSaidOnce) {
  EXPECT_THAT(refusal(hole_on(R"("modulus": 1, "links": 1)")), HasSubstr("/holes/0/spring: {"));
  EXPECT_THAT(refusal(hole_on(R"("modulus": 1, "arc": [10, 10])")), HasSubstr("from < to <= from + 360"));
  EXPECT_THAT(refusal(hole_on(R"("modulus": 1, "arc": [0, 361])")), HasSubstr("/holes/0/spring/arc: [0,361]"));
  EXPECT_THAT(refusal(hole_on(R"("disk": {"E": 1, "nu": 0.5, "law": "plane strain"})")),
              HasSubstr("/holes/0/spring/disk/nu: 0.5 is not allowed; allowed: a number > -1 and < 0.5"));
  EXPECT_THAT(refusal(hole_on(R"("disk": {"E": 1, "nu": 0.3, "law": "cubic"})")),
              HasSubstr("allowed: \"plane stress\", \"plane strain\", \"second harmonic\""));
  EXPECT_THAT(refusal(hole_on(R"("links": 1, "compression_only": true)")), HasSubstr("given with \"links\""));
  EXPECT_THAT(refusal(hole_on(R"("modulus": 1, "arc": [0, 9], "compression_only": true)")),
              HasSubstr("/holes/0/spring/compression_only: given with \"arc\""));
}

}  // namespace
}  // namespace fastjoint
