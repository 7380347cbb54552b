// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/strength/stress_ranges.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index, Eigen::MatrixXd;

/// A result of plates with holes whose peaks are known to 1 at the first increment, to 2 at the second and so on.
formats::JointResult result_of(Index n_plates, Index n_holes, Index steps) {
  formats::JointResult result;
  result.load_factor.setZero(steps);
  for (Index i = 0; i < n_plates; ++i) {
    formats::PlateHistory plate;
    plate.name = "plate " + std::to_string(i);
    for (Index hole = 0; hole < n_holes; ++hole) plate.holes.hole.push_back(std::to_string(hole));
    const MatrixXd errors = Eigen::VectorXd::LinSpaced(steps, 1, double(steps)).replicate(1, n_holes);
    plate.columns.put({{"rim/peak_error", columns::stress, ""}, columns::Of::hole, n_holes, {}, errors});
    result.plates.push_back(plate);
  }
  return result;
}

/// Random stresses, some of them not known, in batches like those of load cases, against a loop over everything.
TEST(StressRanges, ByBruteForce) {
  std::mt19937 random(1);
  std::normal_distribution<> normal;
  constexpr Index n_spots = 16, n_holes = 3;
  for (int round = 0; round < 50; ++round) {
    const Index n_plates = 1 + round % 3, steps = 2 + round % 7;
    std::vector<std::vector<MatrixXd>> hoop(steps);  // by increment and plate
    for (auto& each : hoop)
      for (Index i = 0; i < n_plates; ++i)
        each.push_back(MatrixXd::NullaryExpr(n_spots, n_holes, [&] {
          return normal(random) > 2.5 ? std::numeric_limits<double>::quiet_NaN() : normal(random);
        }));
    std::vector<SpotExtremes> all;
    for (Index step = 0; step < steps;) {
      std::vector<SpotExtremes> batch;
      do {
        std::vector<SpotExtremes> one;
        for (const MatrixXd& each : hoop[step]) one.emplace_back(each);
        append(batch, std::move(one));
      } while (++step < steps && normal(random) > 0);
      append(all, std::move(batch));
    }
    double before = std::numeric_limits<double>::infinity();
    const auto ranges = stress_ranges(all, result_of(n_plates, n_holes, steps));
    EXPECT_EQ(std::ssize(ranges), n_plates * n_holes);
    for (const auto& each : ranges) {
      EXPECT_LE(float(each.range), before) << "the largest range first";
      before = each.range;
      const Index plate = each.of[6] - '0', hole = each.of.back() - '0';
      double widest = 0;
      for (Index spot = 0; spot < n_spots; ++spot) {
        Eigen::VectorXd at(steps);
        for (Index step = 0; step < steps; ++step) at[step] = hoop[step][plate](spot, hole);
        if (at.array().isNaN().all()) continue;
        const double largest = at.maxCoeff<Eigen::PropagateNumbers>(),
                     smallest = at.minCoeff<Eigen::PropagateNumbers>();
        widest = std::max(widest, largest - smallest);
        if (std::abs(std::remainder(each.angle - 360.0 * double(spot) / n_spots, 360)) > 1e-9) continue;
        EXPECT_EQ(each.largest, largest);
        EXPECT_EQ(each.smallest, smallest);
        EXPECT_EQ(each.largest, at[each.largest_at]);
        EXPECT_EQ(each.smallest, at[each.smallest_at]);
      }
      EXPECT_EQ(each.range, widest);
      EXPECT_EQ(each.error, each.largest_at + 1 + each.smallest_at + 1);
    }
  }
}

TEST(StressRanges, NoneOfOneIncrementAndOfHolesWhoseStressDoesNotVaryOrIsNotKnown) {
  MatrixXd hoop = MatrixXd::Ones(4, 3);
  hoop.col(1).setConstant(std::numeric_limits<double>::quiet_NaN());
  std::vector<SpotExtremes> all;
  append(all, {SpotExtremes(hoop)});
  EXPECT_TRUE(stress_ranges(all, result_of(1, 3, 1)).empty());
  hoop.col(0) *= 2;
  append(all, {SpotExtremes(hoop)});
  const auto ranges = stress_ranges(all, result_of(1, 3, 2));
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0].of, "plate 0:0");
  EXPECT_EQ(ranges[0].range, 1);
}

/// A spot next to a jump of friction at one increment counts at the others.
TEST(StressRanges, OfASpotThatIsNotKnownAtOneIncrement) {
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  std::vector<SpotExtremes> all;
  for (const double stress : {missing, 300.0, missing, 100.0}) append(all, {SpotExtremes(MatrixXd{{stress}, {100}})});
  const auto ranges = stress_ranges(all, result_of(1, 1, 4));
  ASSERT_EQ(ranges.size(), 1U);
  EXPECT_EQ(ranges[0].range, 200);
  EXPECT_EQ(ranges[0].largest_at, 1);
  EXPECT_EQ(ranges[0].smallest_at, 3);
}

}  // namespace
}  // namespace fastjoint::stage3
