// SPDX-License-Identifier: GPL-3.0-or-later
// Four ways to the hoop stress around the hole of a strip (d/W = 0.5), as CSV: error against a fine solution, over p.
#include <fmt/format.h>

#include <iostream>

#include "stage2_extract/rim_stress.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/rim_methods.hpp"

namespace {

using namespace fastjoint;

constexpr double E = 1e7;  // of grid_scene
constexpr int highest_harmonic = 10;

formats::PlateSolution strip(int rings) {
  return test::solve(
      test::make_plate(test::grid_scene({0, 0.5, 2}, {0, 0.5}, {{"1", 0, 0, 0.25, rings, false}},
                                        R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
           "external": [{"id": "P", "on": "right", "direction": "x", "kind": "traction"}])")));
}

struct Methods {
  Eigen::VectorXd plain, tractions, patch, harmonics;
};

Methods hoop_stress(const formats::PlateSolution& plate, std::size_t level) {
  stage2::UnitFields fields(plate, "strip");
  fields.use(level);
  const auto points = stage2::rim_points(plate.mesh, fields.edges(), plate.hole_rim[0]);
  const auto n = static_cast<Eigen::Index>(points.size());
  Methods m{Eigen::VectorXd(n), Eigen::VectorXd(n), test::patch_hoop_stress(fields, points, E).col(0),
            test::harmonic_hoop_stress(fields, points, highest_harmonic, E).col(0)};
  for (Eigen::Index i = 0; i < n; ++i) {
    m.plain[i] = test::plain_rim_stress(fields, points[static_cast<std::size_t>(i)])(1, 0);
    m.tractions[i] = stage2::rim_stress(fields, 0, points[static_cast<std::size_t>(i)])(1, 0);
  }
  return m;
}

}  // namespace

int main() {
  const Eigen::VectorXd exact = hoop_stress(strip(6), 7).tractions;
  std::cout << "rings,p,unknowns,plain,known tractions,patch recovery,harmonics\n";
  for (const int rings : {0, 1, 2}) {
    const auto plate = strip(rings);
    for (std::size_t level = 0; level < plate.cases.size(); ++level) {
      const Methods m = hoop_stress(plate, level);
      const auto error = [&](const Eigen::VectorXd& sigma) {
        return (sigma - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
      };
      const auto at = static_cast<Eigen::Index>(level);
      std::cout << fmt::format("{},{},{},{:.3e},{:.3e},{:.3e},{:.3e}\n", rings, plate.p[at], plate.ndof[at],
                               error(m.plain), error(m.tractions), error(m.patch), error(m.harmonics));
    }
  }
}
