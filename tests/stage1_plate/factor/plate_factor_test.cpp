// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/factor/plate_factor.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "common/linalg/threads.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

struct Scene {
  const char* name;
  std::string json;
};

std::string two_holes(const std::string& extra, const char* thickness = "[[0.1, 0.2], [0.1, 0.05]]") {
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 1, 2.2], "y": [0, 0.9, 1.7], "thickness": {}}}}}{}}})",
                     thickness, extra);
}

/// A square with a hole at its corner, two elements, by hand; the disc's rim crosses from one to the other.
const char* const own_mesh = R"({"format": "plate", "version": 1, "analysis": "plane stress",
  "materials": {"al": {"E": 1e7, "nu": 0.3}},
  "geometry": {"mesh": {"nodes": [[0.5, 0], [2, 0], [2, 2], [0.3535533905932738, 0.3535533905932738], [0, 2], [0, 0.5]],
    "quads": [[0, 1, 2, 3], [3, 2, 4, 5]], "arcs": [{"edge": [0, 3], "center": [0, 0]}, {"edge": [3, 5], "center": [0, 0]}],
    "thickness": 0.1, "edges": {"low": [[0, 1]], "side": [[4, 5]]}}},
  "holes": [{"id": "h", "center": [0, 0], "radius": 0.5, "spring": {"disk": {"E": 1e7, "nu": 0.3}}}],
  "supports": [{"on": "low", "fix": ["y"]}, {"on": "side", "fix": ["x"]}]})";

std::vector<Scene> scenes() {
  const std::string holes = R"(, "disc_directions": ["x", "y"],
    "holes": [{"id": "a", "center": [0.4, 0.5], "radius": 0.2, "rings": 1, "spring": {"modulus": 1e6}},
              {"id": "b", "center": [1.5, 1.3], "radius": 0.2, "spring": {"links": 1e5}},
              {"id": "open", "center": [1.7, 0], "radius": 0.3}])";
  return {{"panel", test::panel(3, 2)},
          {"panel in the product space", test::panel(3, 2, 0, test::in_space(pfem::Space::product))},
          {"panel with many rings, element by element", test::panel(2, 1, 4)},
          {"floating, two thicknesses, traction, rigid edge",
           two_holes(holes + R"(, "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                                       {"id": "T", "on": "top", "direction": "y", "kind": "traction"},
                                       {"id": "B", "on": "open", "direction": "x", "kind": "bearing"}])")},
          {"half holes on supports and on an external", two_holes(R"(,
         "holes": [{"id": "a", "center": [0.4, 0], "radius": 0.2, "spring": {"disk": {"E": 1e7, "nu": 0.3}}},
                   {"id": "b", "center": [2.2, 1.3], "radius": 0.2, "spring": {"modulus": 1e7, "arc": [100, 200]}}],
         "supports": [{"on": "bottom", "fix": ["y"]}, {"on": "left", "fix": ["x"]}],
         "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])")},
          {"points", two_holes(R"(, "supports": [{"on": "left", "fix": ["x", "y"]}],
         "points": [{"id": "K", "at": [2.2, 0.9], "stiffness": 1e5}, {"id": "L", "at": [1, 0.9], "stiffness": 3e4}])")},
          {"own mesh", own_mesh}};
}

/// S and R by shortcuts (elements and cells condensed, each congruence class once, no solve) against the
/// straightforward path.
TEST(PlateFactor, GivesWhatTheStraightforwardPathGives) {
  for (const auto& [name, json] : scenes()) {
    const auto plate = test::make_plate(json);
    const auto& problem = plate.problem;
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, problem);
    const stage1::Skeleton skeleton(problem);
    for (int p = 1; p <= 8; ++p) {
      const auto plain = test::plain_matrices(K_ff, problem, p);
      const Eigen::MatrixXd E = stage1::PlateFactor(problem, skeleton, p).energy_rows();
      const auto nc = problem.K_cc.rows();
      const Eigen::MatrixXd S = E.topRows(nc) * E.topRows(nc).transpose();
      const Eigen::MatrixXd R = E.topRows(nc) * E.bottomRows(E.rows() - nc).transpose();
      EXPECT_LT((S - Eigen::MatrixXd(shift(problem).asDiagonal()) - plain.S).norm(), 1e-11 * problem.K_cc.norm())
          << name << ", p = " << p;
      EXPECT_LE((R - plain.R).norm(), 1e-11 * plain.R.norm()) << name << ", p = " << p;
    }
  }
}

TEST(PlateFactor, IsTheSameOnSeveralThreads) {
  const auto plate = test::make_plate(test::panel(3, 2, 1));
  const stage1::Skeleton skeleton(plate.problem);
  const Eigen::MatrixXd B = Eigen::MatrixXd::Random(plate.problem.K_fc.rows(), 3);
  const stage1::PlateFactor one(plate.problem, skeleton, 8);
  const Eigen::MatrixXd E = one.energy_rows(), X = one.solve(B);
  linalg::set_threads(3);
  const stage1::PlateFactor three(plate.problem, skeleton, 8);
  EXPECT_LT((three.energy_rows() - E).norm(), 1e-13 * E.norm());
  EXPECT_LT((three.solve(B) - X).norm(), 1e-12 * X.norm());
  linalg::set_threads(1);
}

TEST(PlateFactor, SolvesForAnyLoads) {
  for (const auto& [name, json] : scenes()) {
    const auto plate = test::make_plate(json);
    const auto K_ff = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
    const stage1::Skeleton skeleton(plate.problem);
    for (const int p : {1, 2, 5, 8}) {
      const int n = plate.problem.unknowns.n_free[p];
      const Eigen::MatrixXd B = Eigen::MatrixXd::Random(n, 70);  // more than one block of columns
      const Eigen::MatrixXd X = stage1::PlateFactor(plate.problem, skeleton, p).solve(B);
      const Eigen::MatrixXd residual = K_ff.topLeftCorner(n, n) * X - B;
      EXPECT_LT(residual.norm(), 1e-12 * K_ff.norm() * X.norm()) << name << ", p = " << p;
    }
  }
}

}  // namespace
}  // namespace fastjoint
