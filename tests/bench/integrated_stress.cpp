// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness of a scene's first external by integrating the stresses along its edge, as JSON: what must not be
// used, kept to chart how much slower it converges. Solved by stage 1's own factor.
#include <fmt/format.h>

#include <iostream>

#include "common/h5/whole_file.hpp"
#include "common/linalg/processor.hpp"
#include "common/plate/plate_factor.hpp"
#include "common/program/program.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "stage1_plate/scene/scene.hpp"
#include "tests/support/plates.hpp"
#include "tests/support/stress.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "integrated_stress",
    "Force per displacement of the first external, an edge x = const that moves along x, by integrating the stresses\n"
    "of the highest degree along it.",
    "PLATE.json",
    "STIFFNESS.json",
    {{"--p", "N or A..B", "degree 1..8, or a range of degrees; default: \"p\" of the input, else 1..8"}}};

/// The edge that moves.
const stage1::External& first_external(const stage1::PlateScene& scene) {
  const auto& all = scene.externals;
  if (all.empty() || all[0].kind != stage1::ExternalKind::rigid || all[0].direction != rim::Axis::x)
    stage1::reject(scene, "/external", "another first external, or none", "a rigid one along x first");
  return all[0];
}

/// Plate unknowns under a unit displacement of the first external, all else held.
Eigen::VectorXd first_field(const stage1::PlateProblem& problem, int p) {
  return test::fields(problem, p, Eigen::VectorXd::Unit(problem.unknowns.n_prescribed(), 0),
                      Eigen::VectorXd::Zero(problem.unknowns.n_free[p]));
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  linalg::set_threads(1);
  timings.phase("read");
  auto scene = stage1::read_scene(input::parse(arguments.input, input::read_text_file(arguments.input)));
  stage1::set_degrees(scene, arguments.text("--p"));
  const std::string edge = first_external(scene).on;
  timings.phase("mesh");
  auto mesh = stage1::make_mesh(scene);
  timings.phase("integrate");
  auto problem = test::assemble(scene, mesh);
  stage1::check_rigid_motions(scene, mesh, problem.unknowns);
  timings.set_unknowns(scene.p_high, problem.unknowns.n_free.back());
  timings.phase("solve");
  const Eigen::VectorXd u = first_field(problem, scene.p_high);
  timings.phase("extract");
  const Eigen::VectorXd controlled = Eigen::VectorXd::Unit(problem.K_cc.cols(), 0);
  const test::Plate plate{std::move(scene), std::move(mesh), std::move(problem)};
  const double S_ee = test::integrated_force(plate, test::coefficients(plate, u, controlled), edge);
  timings.phase("write");
  h5::write_whole_file(arguments.output, fmt::format("{{\"S_ee\": {}}}\n", S_ee));
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
