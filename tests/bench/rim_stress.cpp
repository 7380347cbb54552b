// SPDX-License-Identifier: GPL-3.0-or-later
// Four ways to the hoop stress around the open hole of a strip (d/W = 0.5), as CSV: error against a fine solution, over
// p.
#include <fmt/format.h>

#include <Eigen/LU>
#include <iostream>

#include "common/pfem/material.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/rim_methods.hpp"

namespace {

using namespace fastjoint;

constexpr int highest_harmonic = 10;

struct Material {
  const char *name, *json;
};
constexpr Material isotropic = {"isotropic", R"({"E": 1, "nu": 0.3})"};
constexpr Material laminate = {"laminate, Ex/Ey = 20", R"({"E1": 20, "E2": 1, "nu12": 0.3, "G12": 0.7, "angle": 0})"};

formats::PlateSolution strip(const Material& material, int rings) {
  return test::solve(test::make_plate(fmt::format(
      R"({{"format": "plate", "version": 1, "analysis": "plane stress", "materials": {{"m": {}}},
    "geometry": {{"grid": {{"x": [0, 0.5, 2], "y": [0, 0.5], "thickness": 1}}}},
    "holes": [{{"id": "1", "center": [0, 0], "radius": 0.25, "rings": {}}}],
    "supports": [{{"on": "left", "fix": ["x"]}}, {{"on": "bottom", "fix": ["y"]}}],
    "external": [{{"id": "P", "on": "right", "direction": "x", "kind": "traction"}}]}})",
      material.json, rings)));
}

struct Methods {
  Eigen::VectorXd plain, tractions, patch, harmonics;
};

Methods hoop_stress(const formats::PlateSolution& plate, std::size_t level) {
  stage2::FieldSolver solver(plate, "strip");
  solver.factorise(plate.p[level]);
  const auto points = test::rim_points(plate.mesh, solver.edges(), plate.hole_rim[0]);
  const auto fields = solver.solve(Eigen::VectorXd::Ones(1));
  const Eigen::Index n = points.size();
  Methods m{Eigen::VectorXd(n),
            {},
            test::patch_hoop_strain(fields, points).col(0),
            test::harmonic_hoop_strain(fields, points, highest_harmonic).col(0)};
  m.tractions = test::RimStress(solver, 0, points)(fields).tt.transpose();
  const Eigen::Matrix3d compliance = solver.elasticity(0).inverse();
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto& point = points[i];
    m.plain[i] = test::plain_rim_stress(fields, point)(1, 0);
    const Eigen::Matrix3d to_global = pfem::polar_stress(-point.angle);
    const double E_hoop = 1 / (to_global.transpose() * compliance * to_global)(1, 1);
    m.patch[i] *= E_hoop;
    m.harmonics[i] *= E_hoop;
  }
  return m;
}

void print(const Material& material, int finest, const std::vector<int>& all_rings) {
  const Eigen::VectorXd exact = hoop_stress(strip(material, finest), 7).tractions;
  const auto error = [&](const Eigen::VectorXd& sigma) {
    return (sigma - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  };
  for (const int rings : all_rings) {
    const auto plate = strip(material, rings);
    for (std::size_t level = 0; level < plate.cases.size(); ++level) {
      const Methods m = hoop_stress(plate, level);
      const Eigen::Index at = level;
      std::cout << fmt::format("\"{}\",{},{},{},{:.3e},{:.3e},{:.3e},{:.3e}\n", material.name, rings, plate.p[at],
                               plate.ndof[at], error(m.plain), error(m.tractions), error(m.patch), error(m.harmonics));
    }
  }
}

}  // namespace

int main() {
  std::cout << "material,rings,p,unknowns,plain,known tractions,patch recovery,harmonics\n";
  print(isotropic, 6, {0, 1, 2});
  print(laminate, 12, {4});
}
