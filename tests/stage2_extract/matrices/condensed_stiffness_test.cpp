// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/support/plates.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

/// S by forward elimination alone against the energy products (unit field)^T K (unit field), which need the plate's own
/// matrix.
TEST(CondensedStiffness, IsTheEnergyProductOfUnitFields) {
  const test::Plate plate = test::make_plate(test::panel(2, 1));
  const auto solution = test::solve(plate);
  const auto K = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
  for (const std::size_t level : {0U, 3U, 7U}) {
    const Eigen::MatrixXd U = test::unit_fields(plate.problem, solution.p[level]);
    const Eigen::MatrixXd K_level = Eigen::MatrixXd(K).topLeftCorner(U.rows(), U.rows());
    const Eigen::MatrixXd UK_fc = U.transpose() * Eigen::MatrixXd(plate.problem.K_fc.topRows(U.rows()));
    const Eigen::MatrixXd energy = U.transpose() * K_level * U + UK_fc + UK_fc.transpose() + plate.problem.K_cc;
    const Eigen::MatrixXd& S = solution.cases[level].S;
    EXPECT_LT((S - energy).norm(), 1e-13 * S.norm()) << "level " << level;
  }
}

/// An unperforated strip in tension: S_ee = E t h / l exactly at every degree, and Poisson's contraction free.
TEST(CondensedStiffness, StripInTension) {
  const auto m =
      test::extract(test::grid_scene({0, 1, 5}, {0, 2}, {},
                                     R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])"))
          .matrices;
  for (const auto& S : m.S_ee) EXPECT_NEAR(S(0, 0) / (1e7 * 0.1 * 2 / 5), 1, 1e-13);
  EXPECT_EQ(m.n_discs(), 0);
}

/// A rigid disc on stiff springs in a wide plate that is fixed all around: springs and plate act in series, so S_dd
/// rises with the modulus and stays below the springs' own k t pi r.
TEST(CondensedStiffness, SpringsAndPlateActInSeries) {
  const auto S = [](double modulus) {
    const std::string scene = R"({"format": "plate", "version": 1, "analysis": "plane stress", "disc_directions": ["x"],
      "materials": {"al": {"E": 1e7, "nu": 0.3}}, "geometry": {"grid": {"x": [0, 2], "y": [0, 2], "thickness": 0.1}},
      "holes": [{"id": "a", "center": [1, 1], "radius": 0.25, "spring": {"modulus": )" +
                              std::to_string(modulus) + R"(}}],
      "supports": [{"on": "left", "fix": ["x", "y"]}, {"on": "right", "fix": ["x", "y"]},
                   {"on": "top", "fix": ["x", "y"]}, {"on": "bottom", "fix": ["x", "y"]}]})";
    return test::extract(scene).matrices.S_dd.back()(0, 0);
  };
  double previous = 0;
  for (const double k : {1e0, 1e4, 1e7, 1e9, 1e12}) {
    const double own = k * 0.1 * 3.14159265358979 * 0.25;
    EXPECT_GT(S(k), previous) << "k=" << k;
    EXPECT_LT(S(k), own) << "k=" << k;
    previous = S(k);
  }
  EXPECT_NEAR(S(1e0) / (0.1 * 3.14159265358979 * 0.25), 1, 1e-5);
  EXPECT_NEAR(S(1e12) / S(1e11), 1, 1e-3);  // a rigid inclusion with a frictionless rim
}

/// A sheet that one disc alone holds along x follows it without force: S is zero, not rounding of either sign.
TEST(CondensedStiffness, OfASheetOnOneDiscIsZero) {
  const auto extraction = test::extract(test::grid_scene({0, 1, 2.5}, {0, 0.5}, {{"1", 0.5, 0, 0.2}},
                                                         R"(, "supports": [{"on": "bottom", "fix": ["y"]}],
         "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}])"));
  for (const auto& S : extraction.matrices.S_dd) EXPECT_EQ(S(0, 0), 0);
  EXPECT_NEAR(extraction.matrices.T_d.back()(0, 0), -1, 1e-10) << "all of the traction";
  EXPECT_NO_THROW(stage2::require_good(extraction.checks, "plate.h5"));
}

}  // namespace
}  // namespace fastjoint
