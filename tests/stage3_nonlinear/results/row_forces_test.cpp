// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/row_forces.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fastjoint::stage3 {
namespace {

constexpr double unknown = std::numeric_limits<double>::infinity();

/// A sheet with four holes in two rows along x, at 10 and 30, pulled by 100 at x = 50 and held at x = 0; its fasteners
/// take 12, 13, 20 and 15 of it, and 3 across from the first hole to the last.
struct Sheet {
  PlateModel plate;
  PlateState state;

  Sheet() {
    plate.holes = {"1", "2", "3", "4"};
    plate.axes = {0, 1};
    plate.discs = {0, 1, 2, 3, 4, 5, 6, 7};
    plate.places.disc.resize(8, 2);
    plate.places.disc << 10, 5, 10, 5, 30, 15, 30, 15, 10 + 1e-9, 15, 10 + 1e-9, 15, 30, 5, 30, 5;
    plate.places.external = Eigen::RowVector2d(50, 50);
    plate.places.traction = Eigen::RowVector2d(50, 50);
    plate.places.support = Eigen::Matrix2d::Zero();
    plate.external_id = {"P"};
    plate.external_axis = {0};
    plate.traction_id = {"M"};
    plate.traction_axis = {0};
    plate.traction_arm = {5};
    state.Pe = VectorXd::Constant(1, 100);
    state.traction = VectorXd::Constant(1, 1e6);
    state.friction = VectorXd::Zero(8);
    state.friction[0] = -2;
    state.bearing.resize(8);
    state.bearing << -10, 3, -20, 0, -13, 0, -15, -3;
    state.by_supports = {-40, 0};
  }
};

void expect_near(const VectorXd& values, std::vector<double> expected) {
  ASSERT_EQ(values.size(), std::ssize(expected));
  for (Index i = 0; i < values.size(); ++i) EXPECT_DOUBLE_EQ(values[i], expected[i]) << i;
}

TEST(RowForces, AreOfTheFastenersAndOfTheSectionsBesideThem) {
  Sheet sheet;
  const auto rows = disc_rows(sheet.plate);
  ASSERT_EQ(rows.size(), 4);
  EXPECT_EQ(rows[0].discs, (std::vector<Index>{0, 4})) << "rounding of a place makes no row";
  EXPECT_NEAR(rows[0].at, 10, 1e-8);
  EXPECT_EQ(rows[2].discs, (std::vector<Index>{1, 7}));
  const MatrixXd forces = row_forces(sheet.plate, rows, sheet.state);
  expect_near(forces.col(0), {-25, -35, 0, 0});
  expect_near(forces.col(1), {40, 65, 0, 0});
  expect_near(forces.col(2), {65, 100, 0, 0});
}

TEST(RowForces, AreNotKnownWhereASectionCrossesALoadedEdge) {
  Sheet sheet;
  sheet.plate.places.external = Eigen::RowVector2d(20, 50);
  const MatrixXd forces = row_forces(sheet.plate, disc_rows(sheet.plate), sheet.state);
  expect_near(forces.col(1).head(2), {40, unknown});
  expect_near(forces.col(2).head(2), {65, unknown});
  sheet.plate.places.support(0, 1) = 12;
  expect_near(row_forces(sheet.plate, disc_rows(sheet.plate), sheet.state).col(1).head(1), {unknown});
}

TEST(RowForces, OfAFileWithoutPlacesAreNone) {
  Sheet sheet;
  sheet.plate.places = {};
  EXPECT_TRUE(disc_rows(sheet.plate).empty());
}

}  // namespace
}  // namespace fastjoint::stage3
