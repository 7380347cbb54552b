// SPDX-License-Identifier: GPL-3.0-or-later
// The same plate described in two ways must give the same matrices.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/plates.hpp"

namespace fastjoint {
namespace {

const std::string support = R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])";

/// Half plate with half holes on y = 0 against the whole plate: half of S, R and c.
TEST(Symmetry, AHoleInAHalfModelEqualsHalfOfTheWholeModel) {
  const auto half =
      test::extract(test::grid_scene({0, 1, 2.2}, {0, 0.5}, {{"a", 0.4, 0, 0.2}, {"b", 1.7, 0, 0.15}}, support))
          .matrices;
  const auto whole = test::extract(test::grid_scene({0, 1, 2.2}, {-0.5, 0.5}, {{"a", 0.4, 0, 0.2}, {"b", 1.7, 0, 0.15}},
                                                    R"(, "supports": [{"on": "left", "fix": ["x"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"))
                         .matrices;
  for (std::size_t level = 0; level < 8; ++level) {
    EXPECT_LT((2 * half.S_ee[level] - whole.S_ee[level]).norm(), 1e-12 * whole.S_ee[level].norm()) << level;
    EXPECT_LT((2 * half.S_ed[level] - whole.S_ed[level]).norm(), 1e-12 * whole.S_ed[level].norm()) << level;
    EXPECT_LT((2 * half.S_dd[level] - whole.S_dd[level]).norm(), 1e-12 * whole.S_dd[level].norm()) << level;
    EXPECT_LT((2 * half.R_df[level] - whole.R_df[level]).norm(), 1e-12 * whole.R_df[level].norm()) << level;
  }
  EXPECT_LT((2 * half.friction_unit_force - whole.friction_unit_force).norm(), 1e-14);
  EXPECT_LT((2 * half.friction_resultant - whole.friction_resultant).norm(), 1e-14);
}

/// A quarter of a plate with one hole in its middle, pulled from both ends.
TEST(Symmetry, AQuarterHoleEqualsAQuarterOfTheWhole) {
  const auto quarter = test::extract(test::grid_scene({0, 1}, {0, 0.5}, {{"a", 0, 0, 0.2}}, support)).matrices;
  const auto half = test::extract(test::grid_scene({0, 1}, {-0.5, 0.5}, {{"a", 0, 0, 0.2}},
                                                   R"(, "supports": [{"on": "left", "fix": ["x"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"))
                        .matrices;
  EXPECT_NEAR(2 * quarter.S_ee.back()(0, 0) / half.S_ee.back()(0, 0), 1, 1e-12);
  EXPECT_NEAR(2 * quarter.S_ed.back()(0, 0) / half.S_ed.back()(0, 0), 1, 1e-12);
}

/// The grid's own mesh of two holes, turned by an angle, as an explicit mesh of a material that is turned along.
std::string turned(double degrees) {
  const test::Plate plate =
      test::make_plate(test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.45, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}}));
  const double angle = degrees * std::numbers::pi / 180;
  Eigen::Matrix2d Q;
  Q << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  const auto point = [&](const Eigen::Vector2d& x) {
    const Eigen::Vector2d y = Q * x;
    return fmt::format("[{:.17g}, {:.17g}]", y.x(), y.y());
  };
  std::string nodes, quads, arcs;
  const auto& mesh = plate.mesh.mesh;
  for (int i = 0; i < mesh.n_nodes(); ++i) nodes += fmt::format("{}{}", i ? "," : "", point(mesh.nodes.col(i)));
  for (int i = 0; i < mesh.n_elements(); ++i)
    quads += fmt::format("{}[{},{},{},{}]", i ? "," : "", mesh.quads(0, i), mesh.quads(1, i), mesh.quads(2, i),
                         mesh.quads(3, i));
  for (const auto& arc : mesh.arcs)
    arcs += fmt::format("{}{{\"edge\": [{}, {}], \"center\": {}}}", arcs.empty() ? "" : ",", arc.a, arc.b,
                        point(arc.center));
  const auto hole = [&](const char* id, double x, double y, double r) {
    return fmt::format(R"({{"id": "{}", "center": {}, "radius": {}, "spring": {{"modulus": 1e6}}}})", id, point({x, y}),
                       r);
  };
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"ply": {{"E1": 2e7, "E2": 1e6, "nu12": 0.3, "G12": 7e5, "angle": {}}}}},
    "geometry": {{"mesh": {{"nodes": [{}], "quads": [{}], "arcs": [{}], "thickness": 0.1}}}},
    "holes": [{}, {}], "disc_directions": ["x", "y"]}})",
                     20 + degrees, nodes, quads, arcs, hole("a", 0.45, 0.5, 0.2), hole("b", 1.5, 0.6, 0.25));
}

/// S of the turned plate is S in turned axes, disc by disc.
TEST(Symmetry, ATurnedOrthotropicPlateEqualsThePlateWithTurnedMaterial) {
  const auto original = test::extract(turned(0)).matrices;
  const double degrees = 37, angle = degrees * std::numbers::pi / 180;
  const auto rotated = test::extract(turned(degrees)).matrices;
  Eigen::Matrix4d Q = Eigen::Matrix4d::Zero();
  Q.topLeftCorner<2, 2>() << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  Q.bottomRightCorner<2, 2>() = Q.topLeftCorner<2, 2>();
  for (std::size_t level = 0; level < 8; ++level)
    EXPECT_LT((rotated.S_dd[level] - Q * original.S_dd[level] * Q.transpose()).norm(),
              1e-10 * original.S_dd[level].norm())
        << level;
}

}  // namespace
}  // namespace fastjoint
