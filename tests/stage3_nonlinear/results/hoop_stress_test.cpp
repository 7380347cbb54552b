// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/hoop_stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "common/pfem/material.hpp"

namespace fastjoint::stage3 {
namespace hoop_stress_test {

using rim::Harmonics;

Eigen::Matrix3d sheet(double E1, double angle) {
  return pfem::elasticity({E1, 10e3, 10e3, 0.3, 0.3, 0.4, 5e3}, angle, pfem::Analysis::plane_stress).inverse();
}

Tractions none() {
  return [](double) -> Eigen::Vector2d { return {0, 0}; };
}

/// Kirsch: under remote tension s along x the rim moves by u_n = s a / E (1 + 2 cos 2 theta), u_e = -2 s a / E sin 2
/// theta, and sigma_tt = s (1 - 2 cos 2 theta).
TEST(HoopStress, OfAnOpenHoleUnderTensionIsKirschs) {
  constexpr double E = 70e3, a = 3;
  const rim::RimCompliance metal(pfem::elasticity(pfem::isotropic(E, 0.3), 0, pfem::Analysis::plane_stress).inverse(),
                                 a);
  for (const Harmonics& waves :
       {Harmonics{4}, Harmonics{4, 0, rim::full_turn / 2}, Harmonics{4, 0, rim::full_turn / 4}}) {
    const int cos_2 = waves.is_whole() ? 3 : waves.sweep > 2 ? 2 : 1;
    const int sin_2 = waves.size() + (waves.is_whole() ? 4 : waves.sweep > 2 ? 1 : 0);
    Eigen::VectorXd w = Eigen::VectorXd::Zero(waves.size() + waves.n_shears());
    w[0] = -a / E, w[cos_2] = -2 / std::sqrt(2) * a / E, w[sin_2] = 2 / std::sqrt(2) * a / E;
    const HoopStress hoop(metal, waves, w, std::make_shared<const TractionWaves>(waves, none()));
    for (int i = 0; i < TractionWaves::n_points; ++i)
      EXPECT_NEAR(hoop.values()[i], 1 - 2 * std::cos(2 * hoop.angles()[i]), 1e-12);
    EXPECT_NEAR(hoop.at(0.77), 1 - 2 * std::cos(2 * 0.77), 1e-12);
  }
}

/// Pressure over a part of the rim, with kinks where it ends, and shear beside it.
Eigen::Vector2d contact(double angle) {
  const double p = std::max(std::cos(angle - 0.3) - 0.4, 0.0);
  return {p, 0.2 * p * std::sin(angle - 0.3)};
}

/// The displacements that the tractions make in an infinite sheet give the same hoop stress, however many of their
/// waves are told.
TEST(HoopStress, DoesNotDependOnWhereShortWavesBegin) {
  for (const auto& S : {sheet(10e3, 0), sheet(140e3, 0), sheet(140e3, 0.6)}) {
    const rim::RimCompliance infinite(S, 2);
    const Harmonics all{200};
    Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * all.size());
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const double angle = (i + 0.5) * rim::full_turn / n;
      const Eigen::VectorXd phi = all.at(angle);
      load.head(all.size()) += contact(angle).x() / n * phi;
      load.tail(all.size()) += contact(angle).y() / n * phi;
    }
    const Eigen::VectorXd u = infinite.displacements(all) * load;
    std::vector<HoopStress> each;
    for (const int highest : {6, 9, 16}) {
      const Harmonics waves{highest};
      Eigen::VectorXd w(2 * waves.size());
      w << -u.head(waves.size()), -u.segment(all.size(), waves.size());
      each.emplace_back(infinite, waves, w, std::make_shared<const TractionWaves>(waves, contact));
    }
    constexpr double aliasing = 3e-5;  // waves of a kink fall as the square of their order, beyond half of 1024 points
    const double largest = each[0].values().lpNorm<Eigen::Infinity>();
    // Waves of order 0 and 1 are missing in all of them alike.
    EXPECT_LT((each[0].values() - each[1].values()).lpNorm<Eigen::Infinity>(), aliasing * largest);
    EXPECT_LT((each[0].values() - each[2].values()).lpNorm<Eigen::Infinity>(), aliasing * largest);
    for (const int i : {0, 100, 777}) EXPECT_NEAR(each[0].at(each[0].angles()[i]), each[0].values()[i], 1e-9 * largest);
  }
}

/// In an isotropic sheet a pressure without mean and without resultant makes sigma_tt = sigma_rr.
TEST(HoopStress, IsTheRadialStressUnderPressureInAnInfiniteIsotropicSheet) {
  const rim::RimCompliance metal(
      pfem::elasticity(pfem::isotropic(70e3, 0.3), 0, pfem::Analysis::plane_stress).inverse(), 1);
  const Harmonics waves{8};
  const auto pressure = [](double angle) -> Eigen::Vector2d {
    return {std::max(std::cos(angle), 0.0) - 1 / std::numbers::pi - std::cos(angle) / 2, 0};
  };
  Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * waves.size());  // 2 (-1)^(j/2 + 1) / (pi (j^2 - 1)) cos j theta
  for (int j = 2; j <= 8; j += 2)
    load[2 * j - 1] = 2 * (j % 4 == 2 ? 1 : -1) / (std::numbers::pi * (j * j - 1)) / std::numbers::sqrt2;
  const HoopStress hoop(metal, waves, -metal.displacements(waves) * load,
                        std::make_shared<const TractionWaves>(waves, pressure));
  for (const double at : {0.0, 0.5, 1.5, 1.6, 3.0}) EXPECT_NEAR(hoop.at(at), -pressure(at).x(), 1e-5) << at;
}

}  // namespace hoop_stress_test
}  // namespace fastjoint::stage3
