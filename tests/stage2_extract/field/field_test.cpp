// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/field/field.hpp"

#include <gmock/gmock.h>

#include <Eigen/LU>
#include <cmath>

#include "common/errors.hpp"
#include "common/pfem/material.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/rim_methods.hpp"
#include "tests/support/spaces.hpp"

namespace fastjoint {
namespace {

using Eigen::Index;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A whole hole and a half hole, an external of each kind; cases P, a.x, b.x, four frictions, T.
std::string scene(pfem::Space space) {
  return test::grid_scene({0, 1, 2.2}, {0, 1}, {{"a", 0.4, 0.5, 0.2, 1}, {"b", 1.7, 0, 0.15}},
                          R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"},
                 {"id": "T", "on": "top", "direction": "y", "kind": "traction"}])" +
                              test::in_space(space));
}

class FieldTest : public testing::TestWithParam<pfem::Space> {
 protected:
  static const formats::PlateSolution& plate() {
    static const auto trunk = test::solve(test::make_plate(scene(pfem::Space::trunk)));
    static const auto product = test::solve(test::make_plate(scene(pfem::Space::product)));
    return GetParam() == pfem::Space::trunk ? trunk : product;
  }
  static stage2::Field superposed(int p, const Eigen::VectorXd& amounts) {
    stage2::FieldSolver solver(plate(), "plate.h5");
    solver.factorise(p);
    return stage2::at_nodes(solver.solve(amounts), p);
  }
};

TEST(LagrangeNodes, AreInTheOrderOfVtk) {
  Eigen::Matrix2Xd cubic(2, 16);
  const double t = 1.0 / 3;
  cubic << -1, 1, 1, -1, -t, t, 1, 1, -t, t, -1, -1, -t, t, -t, t,  //
      -1, -1, 1, 1, -1, -1, -t, t, 1, 1, -t, t, -t, -t, t, t;
  EXPECT_LT((stage2::lagrange_nodes(3) - cubic).norm(), 1e-15);
  EXPECT_EQ(stage2::lagrange_nodes(1), cubic.leftCols(4));
  EXPECT_EQ(stage2::lagrange_nodes(8).cols(), 81);
}

/// The nodes of a cell as a grid (row eta, column xi), by VTK's rule written from the inside out.
Eigen::Matrix2Xd grid_of(const Eigen::Matrix2Xd& cell, int p, int row) {
  const Eigen::Matrix2Xd nodes = stage2::lagrange_nodes(p);
  Eigen::Matrix2Xd line(2, p + 1);
  int found = 0;
  for (Index i = 0; i < nodes.cols(); ++i) {
    const double column = (nodes(0, i) + 1) / 2 * p;
    if (std::abs((nodes(1, i) + 1) / 2 * p - row) > 1e-9) continue;
    line.col(std::lround(column)) = cell.col(i);
    ++found;
  }
  EXPECT_EQ(found, p + 1);
  return line;
}

/// Differences between neighbouring nodes span a positive area in every cell: no cell is folded or mirrored.
TEST_P(FieldTest, CellsHavePositiveArea) {
  constexpr int p = 8;
  const auto field = superposed(p, Eigen::VectorXd::Zero(8));
  ASSERT_EQ(field.points.cols(), 81 * plate().mesh.n_elements());
  for (int element = 0; element < plate().mesh.n_elements(); ++element)
    for (int row = 0; row < p; ++row) {
      const Eigen::Matrix2Xd cell = field.points.middleCols(81 * element, 81);
      const Eigen::Matrix2Xd low = grid_of(cell, p, row), high = grid_of(cell, p, row + 1);
      for (int i = 0; i < p; ++i) {
        Eigen::Matrix2d J;
        J << low.col(i + 1) - low.col(i), high.col(i) - low.col(i);
        EXPECT_GT(J.determinant(), 0) << element << " " << row << " " << i;
      }
    }
}

TEST_P(FieldTest, NodesOfArcsLieOnTheirCircles) {
  for (const int p : {2, 3, 8}) {
    const auto field = superposed(p, Eigen::VectorXd::Zero(8));
    int n_checked = 0;
    for (const auto& rim : plate().hole_rim)
      for (const auto& side : rim.sides)
        for (Index i = 0; i < p - 1; ++i, ++n_checked) {
          const Index at = side.element * (p + 1) * (p + 1) + 4 + side.local_edge * (p - 1) + i;
          EXPECT_NEAR((field.points.col(at) - rim.center).norm(), rim.radius, 1e-14);
        }
    EXPECT_GT(n_checked, 4 * (p - 1));
  }
}

/// Straight elements under tension by a traction: the exact stress is constant, at every degree.
TEST(FieldOfAStrip, ConstantStrainGivesConstantStress) {
  const auto strip = test::solve(
      test::make_plate(test::grid_scene({0, 1, 1.5}, {0, 0.7, 1}, {}, R"(, "supports": [{"on": "left", "fix": ["x"]},
    {"on": "bottom", "fix": ["y"]}], "external": [{"id": "T", "on": "right", "direction": "x", "kind": "traction"}])")));
  stage2::FieldSolver solver(strip, "strip.h5");
  for (const int p : {1, 2, 8}) {
    solver.factorise(p);
    const auto field = stage2::at_nodes(solver.solve(Eigen::VectorXd::Constant(1, 30)), p);
    const double sigma = 30 / 0.1;  // the end is 1 wide and 0.1 thick
    const Eigen::Matrix3Xd exact = Eigen::Vector3d(sigma, 0, 0).replicate(1, field.stress.cols());
    EXPECT_LT((field.stress - exact).cwiseAbs().maxCoeff(), 1e-10 * sigma) << p;
    EXPECT_LT((field.displacement.row(0) - sigma / 1e7 * field.points.row(0)).cwiseAbs().maxCoeff(), 1e-16) << p;
    EXPECT_LT((stage2::von_mises(field.stress).array() - sigma).abs().maxCoeff(), 1e-10 * sigma) << p;
  }
}

TEST_P(FieldTest, OfAnotherSpaceAreRefused) {
  formats::PlateSolution other = plate();
  const bool is_trunk = GetParam() == pfem::Space::trunk;
  other.space = is_trunk ? pfem::Space::product : pfem::Space::trunk;
  EXPECT_THAT([&] { stage2::FieldSolver(other, "plate.h5"); },
              ThrowsMessage<FileError>(AllOf(HasSubstr("plate.h5:unknown: has "),
                                             HasSubstr(is_trunk ? "of the product space" : "of the trunk space"))));
}

TEST_P(FieldTest, Superpose) {
  Eigen::VectorXd amounts(8);
  amounts << 0.01, -0.002, 0.003, 50, 0, 20, 7, -30;
  const auto all = superposed(8, amounts);
  Eigen::Matrix3Xd stress = Eigen::Matrix3Xd::Zero(3, all.stress.cols());
  Eigen::Matrix2Xd displacement = Eigen::Matrix2Xd::Zero(2, all.stress.cols());
  for (Index i = 0; i < 8; ++i) {
    const auto one = superposed(8, Eigen::VectorXd::Unit(8, i));
    stress += amounts[i] * one.stress;
    displacement += amounts[i] * one.displacement;
  }
  EXPECT_LT((stress - all.stress).norm(), 1e-12 * stress.norm());
  EXPECT_LT((displacement - all.displacement).norm(), 1e-12 * displacement.norm());
}

/// At every node inside a side of a rim, against the operator of the benches.
TEST_P(FieldTest, StressAtRimNodesIsThePlainRimStress) {
  constexpr int p = 7;
  stage2::FieldSolver solver(plate(), "plate.h5");
  solver.factorise(p);
  for (Index k = 0; k < 8; ++k) {
    const auto fields = solver.solve(Eigen::VectorXd::Unit(8, k));
    const auto field = stage2::at_nodes(fields, p);
    for (const auto& rim : plate().hole_rim)
      for (const auto& side : rim.sides)
        for (Index i = 0; i < p - 1; ++i) {
          const Index at_node = side.element * 64 + 4 + side.local_edge * (p - 1) + i;
          const Eigen::Vector2d n = field.points.col(at_node) - rim.center;
          const test::RimPoint point{std::atan2(n.y(), n.x()), {{side, -1 + 2 * static_cast<double>(i + 1) / p, 0}}};
          const Eigen::Vector3d plain = test::plain_rim_stress(fields, point).col(0);
          const Eigen::Vector3d here = pfem::polar_stress(point.angle) * field.stress.col(at_node);
          EXPECT_LT((here - plain).norm(), 1e-11 * field.stress.cwiseAbs().maxCoeff());
        }
  }
}

/// The right edge moves as one by the amount of its external.
TEST_P(FieldTest, BoundariesMoveByTheirAmounts) {
  Eigen::VectorXd amounts = Eigen::VectorXd::Zero(8);
  amounts[0] = 0.01;
  amounts[2] = -0.5;
  const auto field = superposed(8, amounts);
  int n_on_right = 0;
  for (Index i = 0; i < field.points.cols(); ++i) {
    if (field.points(0, i) < 2.2 - 1e-12) continue;
    EXPECT_NEAR(field.displacement(0, i), 0.01, 1e-14);
    ++n_on_right;
  }
  EXPECT_GE(n_on_right, 9);
}

TEST(StressMeasures, OfKnownStates) {
  Eigen::Matrix3Xd stress(3, 4);
  stress << 100, 0, 5, 0,  //
      0, -20, 5, 0,        //
      0, 0, 0, 7;
  EXPECT_LT((stage2::von_mises(stress) - Eigen::Vector4d(100, 20, 5, 7 * std::sqrt(3))).norm(), 1e-13);
  Eigen::Matrix2Xd exact(2, 4);
  exact << 100, 0, 5, 7,  //
      0, -20, 5, -7;
  EXPECT_LT((stage2::principal(stress) - exact).norm(), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Spaces, FieldTest, test::both_spaces(), test::space_tested);

}  // namespace
}  // namespace fastjoint
