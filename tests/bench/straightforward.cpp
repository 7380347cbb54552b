// SPDX-License-Identifier: GPL-3.0-or-later
// S and R of a scene by the straightforward path, as JSON: what the two stages are timed against. Every element is
// integrated, the stiffness among all free unknowns is assembled and factorised, and every case is solved for.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iostream>

#include "common/h5/whole_file.hpp"
#include "common/linalg/processor.hpp"
#include "common/program/program.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "stage1_plate/scene/scene.hpp"
#include "tests/support/straightforward.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "straightforward",
    "S and R of one sheet the plain way: every element integrated, all unknowns in one sparse system, one solve for\n"
    "each unit displacement and friction case.",
    "PLATE.json",
    "MATRICES.json",
    {{"--p", "N or A..B", "degree 1..8, or a range of degrees; default: \"p\" of the input, else 1..8"}}};

std::string json(const Eigen::MatrixXd& A) {
  std::vector<std::string> rows;
  for (const auto& row : A.rowwise()) rows.push_back(fmt::format("[{}]", fmt::join(row.begin(), row.end(), ", ")));
  return fmt::format("[{}]", fmt::join(rows, ", "));
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  linalg::set_threads(1);
  timings.phase("read");
  auto scene = stage1::read_scene(input::parse(arguments.input, input::read_text_file(arguments.input)));
  stage1::set_degrees(scene, arguments.text("--p"));
  timings.phase("mesh");
  const auto mesh = stage1::make_mesh(scene);
  timings.phase("couple");
  const auto problem = test::assemble(scene, mesh);
  stage1::check_rigid_motions(scene, mesh, problem.unknowns);
  timings.phase("integrate");
  const auto K_ff = test::free_stiffness(scene, mesh, problem);
  timings.phase("solve");
  std::vector<std::string> S, R;
  for (int p = scene.p_low; p <= scene.p_high; ++p) {
    const auto matrices = test::plain_matrices(K_ff, problem, p);
    const Eigen::Index nc = problem.unknowns.n_controlled(), h = problem.unknowns.n_friction;
    S.push_back(json(matrices.topLeftCorner(nc, nc)));
    R.push_back(json(matrices.block(0, nc + problem.unknowns.n_loaded, nc, h)));
    timings.set_unknowns(p, problem.unknowns.n_free[p]);
  }
  timings.phase("write");
  h5::write_whole_file(arguments.output,
                       fmt::format("{{\"S\": [{}],\n\"R\": [{}]}}\n", fmt::join(S, ",\n"), fmt::join(R, ",\n")));
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
