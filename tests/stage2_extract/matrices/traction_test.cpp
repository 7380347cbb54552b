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
