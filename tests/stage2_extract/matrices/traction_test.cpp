// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>

#include <Eigen/LU>

#include "common/errors.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

const std::string supports = R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}])";

/// Uniform tension of a strip without holes is exact at every degree: mean displacement l / (E t h) per unit force.
TEST(Traction, StripInTension) {
  const auto m =
      test::extract(
          test::grid_scene(
              {0, 1, 5}, {0, 2}, {},
              supports + R"(, "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}])"))
          .matrices;
  for (const auto& C : m.C_t) EXPECT_NEAR(C(0, 0) * 1e7 * 0.1 * 2 / 5, 1, 1e-13);
}

const std::string moment = R"(, "external": [{"id": "M", "on": "right", "kind": "moment"}])";

/// Pure bending is exact from p = 2 on: rotation M l / (E t h^3 / 12), so per force f = M / arm, arm^2 = h^2 / 12, the
/// mean displacement arm times rotation is l / (E t h). The point that holds the strip against sliding carries nothing.
TEST(Traction, AMomentBendsAStrip) {
  const auto m =
      test::extract(test::grid_scene({0, 1, 5}, {-1, 1}, {},
                                     R"(, "supports": [{"on": "left", "fix": ["x"]}], "disc_directions": ["y"],
                                    "points": [{"id": "slides", "at": [1, 1], "stiffness": 1000}])" +
                                         moment))
          .matrices;
  EXPECT_EQ(m.traction_direction, std::vector<std::string>{"rotation"});
  EXPECT_NEAR(m.traction_arm[0], 2 / std::sqrt(12), 1e-14);
  for (std::size_t p = 2; p <= m.C_t.size(); ++p) {
    EXPECT_NEAR(m.C_t[p - 1](0, 0) * 1e7 * 0.1 * 2 / 5, 1, 1e-12) << p;
    EXPECT_NEAR(m.T_d[p - 1](0, 0), 0, 1e-12) << p;
  }
}

/// Reciprocal with a force, and without a resultant: discs that hold a free sheet carry none of it.
TEST(Traction, AMomentHasNoResultant) {
  const auto result = test::extract(
      test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                       R"(, "disc_directions": ["x", "y"], "external": [{"id": "M", "on": "top", "kind": "moment"},
                                          {"id": "V", "on": "right", "direction": "y", "kind": "traction"}])"));
  const auto& C = result.matrices.C_t.back();
  EXPECT_NEAR(C(0, 1) / C(1, 0), 1, 1e-10);
  EXPECT_GT(C.determinant(), 0);
  const auto& T = result.matrices.T_d.back();  // a x, a y, b x, b y
  for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR(T(axis, 0) + T(2 + axis, 0), 0, 1e-12) << axis;
  EXPECT_GT(T.col(0).cwiseAbs().maxCoeff(), 0.1);
  // Couple of the discs: rigid discs may carry moments of their own by friction only, so forces balance the moment.
  const double arm = 2 / std::sqrt(12.0);
  EXPECT_NEAR(1.1 * T(3, 0) - 0.1 * T(2, 0), -arm, 1e-6 * arm);
}

TEST(Traction, AMomentOnAnEdgeThatMovesAsOneIsRefused) {
  EXPECT_THAT(
      [] {
        (void)test::make_plate(test::grid_scene(
            {0, 1}, {0, 1}, {}, supports + R"(, "external": [{"id": "M", "on": "right", "kind": "moment"},
                                                      {"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"));
      },
      testing::ThrowsMessage<InputError>(testing::HasSubstr("/external/0: supports fix all displacements")));
}

/// Two tractions are reciprocal, and discs and supports together carry each of them.
TEST(Traction, IsReciprocalAndInEquilibrium) {
  const auto result =
      test::extract(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                     R"(, "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"},
                                                          {"id": "V", "on": "top", "direction": "x", "kind": "traction"}])"));
  const auto& C = result.matrices.C_t.back();
  EXPECT_NEAR(C(0, 1) / C(1, 0), 1, 1e-10);
  EXPECT_GT(C(0, 0), 0);
  EXPECT_GT(C.determinant(), 0);
  ASSERT_TRUE(result.checks.equilibrium);  // nothing supports x: discs carry the whole force
  EXPECT_LT(*result.checks.equilibrium, 1e-12);
  EXPECT_LT((result.matrices.T_d.back().colwise().sum().array() + 1).abs().maxCoeff(), 1e-12);
}

/// A rigid boundary and a traction on the same far edge of a long strip act alike on the disc (Saint-Venant).
TEST(Traction, ActsOnFarDiscsAsARigidBoundaryDoes) {
  const auto strip = [](const std::string& kind) {
    return test::extract(
               test::grid_scene({0, 1, 4}, {0, 1}, {{"a", 0.5, 0.5, 0.2}},
                                supports + R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": ")" +
                                    kind + "\"}]"))
        .matrices;
  };
  const auto rigid = strip("rigid");
  const double by_rigid = rigid.S_ed.back()(0, 0) / rigid.S_ee.back()(0, 0);  // force on the held disc per unit load
  EXPECT_NEAR(strip("traction").T_d.back()(0, 0) / by_rigid, 1, 1e-3);
}

TEST(Traction, OnAnEdgeThatSupportsHoldIsRefused) {
  EXPECT_THAT(
      [] {
        (void)test::make_plate(test::grid_scene(
            {0, 1}, {0, 1}, {},
            supports + R"(, "external": [{"id": "T", "on": "left", "direction": "x", "kind": "traction"}])"));
      },
      testing::ThrowsMessage<InputError>(
          testing::HasSubstr("/external/0: supports fix all displacements that it loads")));
}

}  // namespace
}  // namespace fastjoint
