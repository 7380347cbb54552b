// SPDX-License-Identifier: GPL-3.0-or-later
// S is superconvergent: its error is the square of the energy norm's; integrated stresses are not.
#include <gtest/gtest.h>

#include <cmath>

#include "stage2_extract/condensed_stiffness.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/straightforward.hpp"
#include "tests/support/stress.hpp"

namespace fastjoint {
namespace {

/// Reference values of panel(1,1) from two independent codes, order external, disc.
const Eigen::Matrix2d panel_S =
    (Eigen::Matrix2d() << 1362823.65898, -696592.70961, -696592.70961, 1393185.41922).finished();

/// Slope of log y against log x by least squares.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::ArrayXd lx = Eigen::Map<const Eigen::ArrayXd>(x.data(), n).log();
  Eigen::ArrayXd ly = Eigen::Map<const Eigen::ArrayXd>(y.data(), n).log();
  lx -= lx.mean();
  return (lx * ly).sum() / lx.square().sum();
}

struct Errors {
  std::vector<double> energy, stiffness, by_stress;
};

/// Errors of the unit external case of panel(1,1): energy norm against a much finer space that contains it, S_ee
/// against the published value, S_ee by integrated stresses likewise.
Errors measure(int p_low, int p_high) {
  const test::Plate plate = test::make_plate(test::panel(1, 1));
  const auto solution = test::solve_all_fields(plate);
  const auto K = test::free_stiffness(plate.scene, plate.mesh, plate.problem);
  const Eigen::VectorXd finest = solution.cases.back().U.col(0);
  Errors errors;
  for (int p = p_low; p <= p_high; ++p) {
    const auto level = static_cast<std::size_t>(p - 1);
    Eigen::VectorXd u = Eigen::VectorXd::Zero(finest.size());
    u.head(solution.ndof[p - 1]) = solution.cases[level].U.col(0);
    const Eigen::VectorXd e = u - finest;
    errors.energy.push_back(std::sqrt(e.dot(K * e)));
    errors.stiffness.push_back(std::abs(stage2::condensed_stiffness(solution, level)(0, 0) - panel_S(0, 0)));
    const auto coefficients = test::coefficients(plate, u, Eigen::Vector2d::UnitX());
    errors.by_stress.push_back(std::abs(test::integrated_force(plate, coefficients, "right") - panel_S(0, 0)));
  }
  return errors;
}

TEST(Convergence, StiffnessConvergesAtTwiceTheRateOfTheEnergyNorm) {
  const Errors errors = measure(1, 6);
  EXPECT_NEAR(slope(errors.energy, errors.stiffness), 2, 0.05);
}

TEST(Convergence, StiffnessFromIntegratedStressesConvergesVisiblySlower) {
  const Errors errors = measure(2, 6);
  EXPECT_LT(slope(errors.energy, errors.by_stress), 1.6);
  for (std::size_t i = 2; i < errors.energy.size(); ++i)
    EXPECT_GT(errors.by_stress[i], 10 * errors.stiffness[i]) << "p=" << i + 2;
}

TEST(Convergence, PanelReachesTheReferenceOfTwoOtherCodes) {
  const auto S = [](int rings) {
    return stage2::condensed_stiffness(test::solve(test::make_plate(test::panel(1, 1, rings))), 7);
  };
  EXPECT_LT((S(0) - panel_S).norm() / panel_S.norm(), 1.5e-5);
  EXPECT_LT((S(1) - panel_S).norm() / panel_S.norm(), 1e-7);
  EXPECT_LT((S(2) - panel_S).norm() / panel_S.norm(), 5e-8);
}

/// A space of degree p is part of that of degree p + 1, so energies fall.
TEST(Convergence, EnergiesFallMonotonically) {
  const auto solution = test::solve(test::make_plate(test::panel(2, 1)));
  Eigen::VectorXd previous = Eigen::VectorXd::Constant(3, 1e300);
  for (std::size_t level = 0; level < 8; ++level) {
    const Eigen::VectorXd energies = stage2::condensed_stiffness(solution, level).diagonal();
    EXPECT_TRUE((energies.array() < previous.array()).all()) << "p=" << level + 1;
    previous = energies;
  }
}

}  // namespace
}  // namespace fastjoint
