// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/plates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/linalg/condensed.hpp"
#include "common/plate/plate_factor.hpp"

namespace fastjoint::test {

Plate make_plate(const std::string& json) {
  Plate plate{stage1::read_scene(input::parse("plate.json", json)), {}, {}};
  plate.mesh = stage1::make_mesh(plate.scene);
  plate.problem = stage1::assemble(plate.scene, plate.mesh);
  return plate;
}

Eigen::MatrixXd unit_fields(const stage1::PlateProblem& problem, int p) {
  const plate::PlateFactor K(problem, plate::Skeleton(problem), p);
  return K.solve(-Eigen::MatrixXd(problem.K_fc.topRows(problem.unknowns.n_free[p])));
}

formats::PlateSolution solve(const Plate& plate) {
  auto solution = stage1::to_solution(plate.scene, plate.mesh, plate.problem, "test");
  program::Timings timings;
  stage1::solve_cases(plate.problem, plate::Skeleton(plate.problem), solution, timings);
  return solution;
}

Eigen::MatrixXd stiffness(const formats::PlateSolution& a, std::size_t level) {
  return linalg::condensed_stiffness(a.cases[level].E_c, a.shift, a.K_cc);
}

stage2::Extraction extract(const formats::PlateSolution& solution, bool stresses) {
  if (!stresses) return stage2::extract(solution, "test", nullptr);
  stage2::FieldSolver solver(solution, "plate.h5");
  return stage2::extract(solution, "test", &solver);
}

stage2::Extraction extract(const std::string& json, bool stresses) {
  return extract(solve(make_plate(json)), stresses);
}

std::string grid_scene(const std::vector<double>& x, const std::vector<double>& y, const std::vector<HoleText>& holes,
                       const std::string& extra) {
  std::vector<std::string> list;
  for (const auto& h : holes)
    list.push_back(fmt::format(R"({{"id": "{}", "center": [{}, {}], "radius": {}, "rings": {}{}}})", h.id, h.x, h.y,
                               h.radius, h.rings, h.sprung ? R"(, "spring": {"disk": {"E": 1e7, "nu": 0.3}})" : ""));
  return fmt::format(R"({{"format": "plate", "version": 1, "analysis": "plane stress",
    "materials": {{"al": {{"E": 1e7, "nu": 0.3}}}},
    "geometry": {{"grid": {{"x": [{}], "y": [{}], "thickness": 0.1}}}}, "holes": [{}]{}}})",
                     fmt::join(x, ","), fmt::join(y, ","), fmt::join(list, ","), extra);
}

std::string panel(int nx, int ny, int rings, const std::string& extra) {
  std::vector<double> x, y;
  std::vector<HoleText> holes;
  for (int i = 0; i <= nx; ++i) x.push_back(i);
  for (int j = 0; j <= ny; ++j) y.push_back(j);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) holes.push_back({fmt::format("{},{}", i, j), i + 0.5, j + 0.5, 0.125, rings});
  return grid_scene(x, y, holes,
                    R"(, "supports": [{"on": "left", "fix": ["x"]}, {"on": "bottom", "fix": ["y"]}],
    "external": [{"id": "P", "on": "right", "direction": "x", "kind": "rigid"}])" +
                        extra);
}

std::string in_space(pfem::Space space) { return fmt::format(R"(, "space": "{}")", pfem::name_of(space)); }

}  // namespace fastjoint::test
