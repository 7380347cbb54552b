// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/rim/rim_compliance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "common/pfem/material.hpp"

namespace fastjoint::rim {
namespace {

using pfem::Analysis;

Eigen::Matrix3d laminate(double angle) {
  return pfem::elasticity({140e3, 10e3, 10e3, 0.3, 0.3, 0.4, 5e3}, angle, Analysis::plane_stress).inverse();
}
Eigen::Matrix3d metal(Analysis analysis) { return pfem::elasticity(pfem::isotropic(72e3, 0.3), 0, analysis).inverse(); }

/// A pressure of order n >= 2 on a hole of radius a in an infinite isotropic sheet moves its rim by
/// a (2 n + 1 - nu) / (E (n^2 - 1)) times itself (Airy's functions r^-n and r^(2-n); plane strain with E / (1 - nu^2)
/// and nu / (1 - nu)).
TEST(RimCompliance, OfIsotropicSheetsIsThatOfAirysFunctions) {
  constexpr double a = 2.5, nu = 0.3, E = 72e3;
  for (const auto& [analysis, e, n_u] : {std::tuple(Analysis::plane_stress, E, nu),
                                         std::tuple(Analysis::plane_strain, E / (1 - nu * nu), nu / (1 - nu))}) {
    const Harmonics waves{12};
    const Eigen::MatrixXd C = RimCompliance(metal(analysis), a).displacements(waves);
    const auto p = C.topLeftCorner(waves.size(), waves.size());
    for (int n = 2; n <= 12; ++n)
      for (const int k : {2 * n - 1, 2 * n})
        EXPECT_NEAR(p(k, k) * e / a, (2 * n + 1 - n_u) / (n * n - 1), 1e-13) << "n = " << n;
    EXPECT_LT((p - Eigen::MatrixXd(p.diagonal().asDiagonal())).cwiseAbs().maxCoeff() * e, 1e-12);
  }
}

TEST(RimCompliance, IsSymmetricAndPositiveForWavesWithoutResultant) {
  for (const double angle : {0.0, 0.4, 1.2}) {
    const Harmonics waves{9};
    const int n = waves.size();
    const Eigen::MatrixXd C = RimCompliance(laminate(angle), 1).displacements(waves);
    EXPECT_LT((C - C.transpose()).cwiseAbs().maxCoeff(), 1e-15);
    std::vector<int> short_waves;  // of two orders and more: of order 1 those of a resultant are among them
    for (int k = 5; k < 2 * n; ++k)
      if (k < n || k >= n + 5) short_waves.push_back(k);
    const Eigen::MatrixXd part = C(short_waves, short_waves);
    EXPECT_GT(part.llt().matrixL().toDenseMatrix().diagonal().minCoeff(), 0) << angle;
    EXPECT_GT(C(5, 9) * C(5, 9), angle == 0.0 ? 1e-14 : 0) << "orders n and n + 2 are coupled";
  }
}

/// Turning sheet and tractions together changes nothing.
TEST(RimCompliance, TurnsWithTheSheet) {
  constexpr double angle = 0.7;
  const Harmonics waves{8};
  const int n = waves.size();
  const Eigen::MatrixXd straight = RimCompliance(laminate(0), 3).displacements(waves);
  const Eigen::MatrixXd turned = RimCompliance(laminate(angle), 3).displacements(waves);
  Eigen::MatrixXd T = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  for (const int block : {0, n})
    for (int m = 1; m <= 8; ++m)
      T.block<2, 2>(block + 2 * m - 1, block + 2 * m - 1) << std::cos(m * angle), -std::sin(m * angle),
          std::sin(m * angle), std::cos(m * angle);
  const auto upper = Eigen::seq(3, n - 1);
  EXPECT_LT((turned - T * straight * T.transpose())(upper, upper).cwiseAbs().maxCoeff(),
            1e-12 * straight.cwiseAbs().maxCoeff());
}

TEST(RimCompliance, OfPartsIsThatOfTheirWholeRim) {
  for (const Harmonics& part : {Harmonics{8, -full_turn / 4, full_turn / 2}, Harmonics{8, 0, full_turn / 4},
                                Harmonics{8, full_turn / 2, full_turn / 2}}) {
    EXPECT_TRUE(part.repeats());
    const double angle = part.start + 0.3;
    EXPECT_LT((part.at(angle) - part.pressures_of_whole().transpose() * Harmonics{8}.at(angle)).cwiseAbs().maxCoeff(),
              1e-13);
    EXPECT_LT((part.shears_at(angle) - part.shears_of_whole().transpose() * Harmonics{8}.shears_at(angle))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-13);
    const RimCompliance sheet(laminate(0), 1);
    const Eigen::MatrixXd C = sheet.displacements(part), whole = sheet.displacements(Harmonics{8});
    Eigen::VectorXd load = Eigen::VectorXd::Zero(C.rows());
    load[2] = 1;  // a pressure
    Eigen::VectorXd of_whole = Eigen::VectorXd::Zero(whole.rows());
    of_whole.head(17) = part.pressures_of_whole() * load.head(part.size());
    const Eigen::VectorXd u = C * load, w = whole * of_whole;
    EXPECT_LT((part.pressures_of_whole() * u.head(part.size()) - w.head(17)).norm(), 1e-12 * w.norm());
    EXPECT_LT((part.shears_of_whole() * u.tail(part.n_shears()) - w.tail(17)).norm(), 1e-12 * w.norm());
  }
  EXPECT_FALSE((Harmonics{7, 0.3, 2.1}).repeats());
}

}  // namespace
}  // namespace fastjoint::rim
