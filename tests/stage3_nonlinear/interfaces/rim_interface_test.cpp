// SPDX-License-Identifier: GPL-3.0-or-later
// A rim of contact with short waves of its own, as the joint sees it: slopes, and changes with gap and friction.
#include "stage3_nonlinear/interfaces/rim_interface.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "common/pfem/material.hpp"

namespace fastjoint::stage3::rim_interface_test {

constexpr double radius = 2, area = 3, K = 4e3, k = 5e4;

/// A laminate off its axes, or an isotropic sheet.
Eigen::Matrix3d sheet(bool laminate) {
  if (!laminate) return pfem::elasticity(pfem::isotropic(70e3, 0.3), 0, pfem::Analysis::plane_stress).inverse();
  return pfem::elasticity({140e3, 10e3, 10e3, 0.3, 0.3, 0.4, 5e3}, 0.4, pfem::Analysis::plane_stress).inverse();
}

RimProblem rim(bool laminate, bool elastic, double gap, double mu) {
  const rim::Harmonics all{24}, carried{4};
  const formats::ContactRim contact{"1",    all,  K,
                                    radius, area, elastic ? rim::ElasticDisk{50e3, 0.3} : rim::ElasticDisk{}};
  const formats::WaveRim waves{"1", carried, radius, area, K, sheet(laminate)};
  return {ContactWaves(contact, waves).up_to(all.highest), area, k, gap, mu};
}

TEST(RimInterface, SlopesAndChangesAreDifferences) {
  constexpr double step = 1e-6;
  for (const auto& [laminate, elastic] : {std::pair(false, false), {true, false}, {false, true}, {true, true}})
    for (const double mu : {0.0, 0.3})
      for (const double gap : {0.0, 0.002, -0.002}) {
        const auto interface = [&](double its_gap, double its_mu) {
          return RimInterface(std::make_shared<const RimProblem>(rim(laminate, elastic, its_gap, its_mu)), 0, true);
        };
        const RimInterface here = interface(gap, mu);
        VectorXd c(9), direction(9);
        c << 40, 300, 90, -20, 30, 10, -15, 5, 8;
        direction << 1, -2, 0.5, 1, 1, -1, 2, 0.3, -0.7;
        const Response at = here.respond(c, {});
        ASSERT_TRUE(at.F.allFinite());
        EXPECT_LT((at.F + k * at.delta - c).norm(), 1e-12 * c.norm());
        const Response more = here.respond(c + step * direction, {}), less = here.respond(c - step * direction, {});
        EXPECT_LT((at.dF * direction - (more.F - less.F) / (2 * step)).norm(), 1e-5) << gap << " " << mu;
        EXPECT_LT((at.ddelta * direction - (more.delta - less.delta) / (2 * step)).norm() * k, 1e-5);
        EXPECT_LT((at.dLambda * direction - (more.Lambda - less.Lambda) / (2 * step)).norm(), 1e-5);
        if (mu == 0) {
          EXPECT_LT((at.dF - at.dF.transpose()).norm(), 1e-12);
          const VectorXd values = Eigen::SelfAdjointEigenSolver<MatrixXd>(at.dF).eigenvalues();
          EXPECT_GT(values[0], -1e-12);
          EXPECT_LT(values[8], 1);
        }
        for (const Change& change : here.changes(c, at)) {
          const double by = change.kind == NumberKind::gap ? 1e-8 : 1e-6;
          const auto after = [&](double sign) {
            const bool of_gap = change.kind == NumberKind::gap;
            return interface(gap + (of_gap ? sign * by : 0), mu + (of_gap ? 0 : sign * by)).respond(c, {});
          };
          const Response up = after(1), down = after(-1);
          EXPECT_LT((change.F - (up.F - down.F) / (2 * by)).norm(), 1e-5 * (1 + change.F.norm()));
          EXPECT_LT((change.delta - (up.delta - down.delta) / (2 * by)).norm(), 1e-5 * (1 + change.F.norm()) / k);
          EXPECT_LT((change.Lambda - (up.Lambda - down.Lambda) / (2 * by)).norm(), 1e-5 * (1 + change.Lambda.norm()));
        }
      }
}

}  // namespace fastjoint::stage3::rim_interface_test
