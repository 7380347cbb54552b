// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/problem/plate_problem.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/support/plates.hpp"
#include "tests/support/spaces.hpp"
#include "tests/support/straightforward.hpp"

namespace fastjoint {
namespace {

/// Whole stiffness over free and controlled unknowns.
Eigen::MatrixXd whole(const test::Plate& plate) {
  const auto& problem = plate.problem;
  const auto n = problem.K_fc.rows();
  const auto nc = problem.K_cc.rows();
  Eigen::MatrixXd K(n + nc, n + nc);
  K.topLeftCorner(n, n) = Eigen::MatrixXd(test::free_stiffness(plate.scene, plate.mesh, problem));
  K.topRightCorner(n, nc) = Eigen::MatrixXd(problem.K_fc);
  K.bottomLeftCorner(nc, n) = K.topRightCorner(n, nc).transpose();
  K.bottomRightCorner(nc, nc) = problem.K_cc;
  return K;
}

/// Coefficients of u = direction everywhere, discs and externals along.
Eigen::VectorXd translation(const test::Plate& plate, int component) {
  const auto& unknowns = plate.problem.unknowns;
  Eigen::VectorXd u = Eigen::VectorXd::Zero(unknowns.n_free.back() + unknowns.n_controlled());
  for (int node = 0; node < plate.mesh.mesh.n_nodes(); ++node) {
    const int dof = unknowns.dofs(component, node);
    if (pfem::is_free(dof)) u[dof] = 1;
  }
  const auto rigid = stage1::rigid_externals(plate.scene);
  for (int i = 0; i < unknowns.n_externals; ++i)
    u[unknowns.n_free.back() + i] = rim::coordinate(plate.scene.externals[rigid[i]].direction) == component;
  for (int i = 0; i < unknowns.n_discs(); ++i)
    u[unknowns.n_free.back() + unknowns.n_externals + i] = rim::coordinate(unknowns.disc_direction[i]) == component;
  return u;
}

const std::string floating = test::grid_scene({0, 1, 2}, {0, 1}, {{"a", 0.4, 0.5, 0.2}, {"b", 1.5, 0.6, 0.25}},
                                              R"(, "disc_directions": ["x", "y"],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}, {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])");

TEST(PlateProblem, MovingEverythingTogetherCostsNothing) {
  const test::Plate plate = test::make_plate(floating);
  const Eigen::MatrixXd K = whole(plate);
  EXPECT_LT((K - K.transpose()).norm(), 1e-15 * K.norm());
  for (int component = 0; component < 2; ++component)
    EXPECT_LT((K * translation(plate, component)).norm(), 1e-13 * K.norm()) << component;
}

TEST(PlateProblem, LoadsHaveTheirResultants) {
  const test::Plate plate = test::make_plate(floating);
  const auto n = plate.problem.K_fc.rows();
  const auto along = [&](const Eigen::SparseMatrix<double>& f, const Eigen::MatrixXd& c, Eigen::Index column,
                         int component) {
    const Eigen::VectorXd u = translation(plate, component);
    return u.head(n).dot(Eigen::VectorXd(f.col(column))) + u.tail(c.rows()).dot(c.col(column));
  };
  const auto& problem = plate.problem;
  EXPECT_NEAR(along(problem.T_f, problem.T_c, 0, 1), 1, 1e-13);
  EXPECT_NEAR(along(problem.T_f, problem.T_c, 0, 0), 0, 1e-13);
  const double t = 0.1;
  ASSERT_EQ(problem.unknowns.n_loaded, 0);
  for (Eigen::Index j = 0; j < problem.unknowns.n_friction; ++j) {
    const std::string bearing = problem.friction_bearing[j];
    const double r = problem.friction_hole[j] == "a" ? 0.2 : 0.25;
    const double expected = (bearing[0] == '+' ? 1 : -1) * t * r;
    EXPECT_NEAR(along(problem.L_f, problem.L_c, j, 0), bearing[1] == 'x' ? expected : 0, 1e-14);
    EXPECT_NEAR(along(problem.L_f, problem.L_c, j, 1), bearing[1] == 'y' ? expected : 0, 1e-14);
  }
}

/// int k t (e.n)^2 ds = k t pi r over a whole rim: the discs' own stiffness, and no coupling between x and y.
TEST(PlateProblem, SpringsGiveTheDiscItsStiffness) {
  const test::Plate plate = test::make_plate(floating);
  const double k = 2 / (1 - 0.3) * 1e7 / 0.4;
  EXPECT_NEAR(plate.problem.K_cc(1, 1) / (k * 0.1 * std::numbers::pi * 0.2), 1, 1e-13);
  EXPECT_NEAR(plate.problem.K_cc(1, 2) / plate.problem.K_cc(1, 1), 0, 1e-14);
}

class PlateProblemIn : public testing::TestWithParam<pfem::Space> {};

TEST_P(PlateProblemIn, ALowerDegreeIsALeadingBlock) {
  test::Plate high = test::make_plate(floating);
  high.scene.space = GetParam();
  high.problem = test::assemble(high.scene, high.mesh);
  const Eigen::MatrixXd K_high = test::free_stiffness(high.scene, high.mesh, high.problem);
  for (const int p : {1, 3, 5}) {
    auto scene = high.scene;
    scene.p_high = p;
    const auto low = test::assemble(scene, high.mesh);
    const auto n = low.K_fc.rows();
    ASSERT_EQ(n, high.problem.unknowns.n_free[p]);
    // the lower degree is integrated with fewer points; the rim's springs and loads to rounding
    const Eigen::MatrixXd K = test::free_stiffness(scene, high.mesh, low);
    EXPECT_LT((K - K_high.topLeftCorner(n, n)).norm(), 1e-6 * K.norm());
    EXPECT_LT((Eigen::MatrixXd(low.K_fc) - Eigen::MatrixXd(high.problem.K_fc.topRows(n))).norm(),
              1e-6 * low.K_fc.norm());
    const auto h = low.unknowns.n_friction;  // the waves behind them are as many as elements of that degree follow
    const Eigen::MatrixXd L = low.L_f.leftCols(h), L_high = high.problem.L_f.leftCols(h).topRows(n);
    EXPECT_LT((L - L_high).norm(), 1e-12 * L.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Spaces, PlateProblemIn, test::both_spaces(), test::space_tested);

}  // namespace
}  // namespace fastjoint
