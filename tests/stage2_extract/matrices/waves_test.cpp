// SPDX-License-Identifier: GPL-3.0-or-later
// Displacements of rims in waves, as MATRICES.h5 has them: energy products, which converge as S does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "common/rim/rim_compliance.hpp"
#include "tests/support/plates.hpp"

namespace fastjoint::waves_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using formats::PlateMatrices;

/// A sheet pulled at its right end, with a hole of each kind: in contact, on springs, open.
std::string scene(const char* more, int rings = 1) {
  const std::string spring = R"("spring": {"modulus": 5e6)", hole = R"({{"id": "{}", "center": [{}, {}], "radius": 0.2,
    "rings": {}, "waves": 5{}}})";
  const auto one = [&](const char* id, double x, double y, const std::string& extra) {
    return fmt::format(fmt::runtime(hole), id, x, y, rings, extra);
  };
  return fmt::format(
      R"({{"format": "plate", "version": 1, "analysis": "plane stress", "materials": {{"m": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [0, 1, 2, 3], "y": [0, 1], "thickness": 0.1}}}}, "holes": [{}, {}, {}],
    "supports": [{{"on": "left", "fix": ["x", "y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}},
                 {{"id": "T", "on": "top", "direction": "y", "kind": "traction"}}]{}}})",
      one("contact", 0.5, 0.45, ", " + spring + R"(, "compression_only": true, "harmonics": 8})"),
      one("sprung", 1.5, 0.55, ", " + spring + "}"), one("open", 2.6, 0.5, ""), more);
}

/// All rows of waves at a level of the stress degrees, those that nothing loads behind the loaded ones.
MatrixXd rows(const PlateMatrices& a, Index level) {
  const Index behind = std::ssize(a.W) - std::ssize(a.stresses.other_waves);
  MatrixXd all(a.n_waves(), a.n_cases());
  all << a.W[behind + level], a.stresses.other_waves[level];
  return all;
}

TEST(RimWaves, OfEveryKindOfHoleHaveTheirRows) {
  const auto a = test::extract(scene("")).matrices;
  ASSERT_EQ(a.waves.size(), 3U);
  EXPECT_EQ(a.waves[0].hole, "contact");
  EXPECT_EQ(a.waves[1].hole, "sprung");
  EXPECT_EQ(a.waves[2].hole, "open");
  EXPECT_EQ(a.n_loaded_waves(), 22);
  EXPECT_EQ(a.n_waves(), 66);
  EXPECT_EQ(a.waves[2].modulus, 0);
  EXPECT_TRUE(rows(a, 1).allFinite());
  const auto few = test::extract(scene(""), false).matrices;
  EXPECT_TRUE(few.stresses.other_waves.empty());
  ASSERT_EQ(few.waves.size(), 1U) << "stage 3 needs those of contact";
  EXPECT_EQ(few.W.back(), a.W.back());
}

/// The energy of the loaded waves: symmetric, and between zero and what the springs alone would give.
TEST(RimWaves, OfContactAreSymmetricAndBetweenNothingAndTheSprings) {
  const auto a = test::extract(scene("")).matrices;
  const Index k = a.n_loaded_waves(), n = a.waves[0].waves.size();
  const MatrixXd energy = -a.W.back().middleCols(a.n_externals() + a.n_discs(), k) / a.waves[0].area;
  EXPECT_LT((energy - energy.transpose()).cwiseAbs().maxCoeff(), 1e-12 * energy.cwiseAbs().maxCoeff());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(energy).eigenvalues().minCoeff(), 0);
  const MatrixXd C = energy.topLeftCorner(n, n);
  EXPECT_LT(Eigen::SelfAdjointEigenSolver<MatrixXd>(C).eigenvalues().maxCoeff(), 1 / a.waves[0].modulus);
}

/// With the degree the error of a rim's waves falls as fast as that of S, its smallest part of it.
TEST(RimWaves, ConvergeAsTheStiffnessDoes) {
  const auto of_degree = [](int p, int rings) {
    return test::extract(scene(fmt::format(R"(, "space": "product", "p": [{}, {}])", p, p).c_str(), rings)).matrices;
  };
  const PlateMatrices best = of_degree(8, 3);
  const MatrixXd truth = rows(best, 0);
  const auto errors = [&](int p) {
    const auto a = of_degree(p, 1);
    return std::pair((rows(a, 0) - truth).norm() / truth.norm(),
                     (a.S_dd[0] - best.S_dd[0]).norm() / best.S_dd[0].norm());
  };
  const auto [waves_3, S_3] = errors(3);
  const auto [waves_6, S_6] = errors(6);
  const double order_of_waves = std::log(waves_3 / waves_6), order_of_S = std::log(S_3 / S_6);
  EXPECT_GT(order_of_S, 3);
  EXPECT_GT(order_of_waves, 0.75 * order_of_S);
  EXPECT_LT(waves_6, 1e-4);
}

/// Unit pressures and shears on the rim of an open hole far from all edges move it as in an infinite sheet; on springs
/// K each order n of pressure is divided by 1 + K c_n.
TEST(RimWaves, InAWideSheetAreThoseOfTheClosedForm) {
  constexpr double modulus = 5e6;
  const auto a = test::extract(R"({"format": "plate", "version": 1, "analysis": "plane strain",
    "materials": {"m": {"E": 1e7, "nu": 0.3}},
    "geometry": {"grid": {"x": [-20, 20], "y": [-20, 20], "thickness": 0.1}},
    "holes": [{"id": "h", "center": [0, 0], "radius": 1, "waves": 5,
               "spring": {"modulus": 5e6, "compression_only": true, "harmonics": 8}}],
    "supports": [{"on": "left", "fix": ["x", "y"]}]})")
                     .matrices;
  const auto& rim = a.waves.at(0);
  const Index n = rim.waves.size(), k = rim.size();
  const MatrixXd found = -a.W.back().middleCols(a.n_externals() + a.n_discs(), k) / rim.area;
  const MatrixXd D = rim::RimCompliance(rim.compliance, rim.radius).displacements(rim.waves);
  const MatrixXd D_nn = D.topLeftCorner(n, n), D_nt = D.topRightCorner(n, k - n);
  const MatrixXd held = (MatrixXd::Identity(n, n) + modulus * D_nn).inverse();
  MatrixXd expected(k, k);
  expected << held * D_nn, held * D_nt, (held * D_nt).transpose(),
      D.bottomRightCorner(k - n, k - n) - modulus * D_nt.transpose() * held * D_nt;
  for (Index i = 3; i < k; ++i)  // of order 2 and more
    if (i < n || i >= n + 3) {
      const double bound = (i < n + 5 && i >= n) || i < 5 ? 6e-3 : 1e-3;  // of order 2 the edges send back most
      EXPECT_NEAR(found(i, i) / expected(i, i), 1, bound) << i;
    }
}

}  // namespace
}  // namespace fastjoint::waves_test
