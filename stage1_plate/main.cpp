// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <optional>

#include "common/linalg/threads.hpp"
#include "common/program/program.hpp"
#include "common/program/text_file.hpp"
#include "stage1_plate/accuracy.hpp"
#include "stage1_plate/degree_range.hpp"
#include "stage1_plate/solved_plate.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "stage1_plate",
    "Solves one sheet of a joint by the p-version of the finite element method: a unit displacement of every fastener\n"
    "disc and rigid boundary, a unit force on every traction boundary.",
    "PLATE.json",
    "PLATE.h5",
    {{"--p", "N or A..B", "degree 1..8, or a range of degrees; default: \"p\" of the input, else 1..8"},
     {"--accuracy", "A",
      "relative error of S (Frobenius norm) to reach, 1e-10 to 1: chooses what \"space\", \"rings\" the input leaves "
      "open and the least degree within --p that do, and says so; warns where nothing does"},
     {"--threads", "N", "threads that integrate, condense, factorise and solve; default: 1"},
     {"--loads-only", "", "leave out what only stresses need; stage 2 then extracts none"}}};

/// Section 3 of the paper: what line springs and links do converges slowly or not at all.
void warn(const stage1::PlateScene& scene) {
  const bool has_links = std::any_of(scene.holes.begin(), scene.holes.end(),
                                     [](const stage1::Hole& hole) { return hole.spring && hole.spring->link > 0; });
  if (has_links || !scene.points.empty())
    std::cerr << fmt::format(
        "{}: warning: {}: points and links concentrate their load at nodes: the results depend on the mesh\n",
        command.name, scene.file);
}

/// The model that reaches the accuracy asked for, if one is.
std::optional<stage1::Accuracy> meet_accuracy(const stage1::PlateScene& scene, const program::Arguments& arguments) {
  constexpr double least = 1e-10, most = 1;
  const double accuracy = arguments.number("--accuracy", least, most, 0);
  if (accuracy == 0) return std::nullopt;
  auto chosen = stage1::meet_accuracy(scene, accuracy);
  if (!chosen.is_reached())
    std::cerr << fmt::format(
        "{}: warning: {}: {}, the best that there is: finer cells, above all at ends of clamped "
        "edges and of steps in thickness, come closer\n",
        command.name, scene.file, stage1::to_text(chosen));
  return chosen;
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  constexpr int most_threads = 256;
  const int threads = arguments.integer("--threads", 1, most_threads, 1);
  linalg::set_threads(threads);
  timings.set_threads(threads);
  timings.phase("read");
  stage1::PlateScene scene =
      stage1::read_scene(input::parse(arguments.input, program::read_text_file(arguments.input)));
  stage1::set_degrees(scene, arguments.text("--p"));
  if (arguments.flag("--accuracy")) timings.phase("search");
  const auto accuracy = meet_accuracy(scene, arguments);
  if (accuracy) scene = accuracy->scene;
  warn(scene);
  const auto wanted = arguments.flag("--loads-only") ? stage1::Wanted::loads : stage1::Wanted::loads_and_stresses;
  const auto plate = stage1::solve_plate(std::move(scene), wanted, program::generator(command.name), timings);
  timings.phase("write");
  formats::write(arguments.output, plate.solution);
  if (arguments.quiet) return;
  std::cout << stage1::summary(plate, arguments.output);
  if (accuracy) std::cout << "  " << stage1::to_text(*accuracy) << "\n";
}

}  // namespace

int main(int argc, char** argv) { return program::run(command, argc, argv, run); }
