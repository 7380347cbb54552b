// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/LU>
#include <iostream>
#include <optional>

#include "common/linalg/threads.hpp"
#include "common/program/program.hpp"
#include "common/program/text_file.hpp"
#include "stage1_plate/run/accuracy.hpp"
#include "stage1_plate/run/solved_plate.hpp"
#include "stage1_plate/scene/degree_range.hpp"

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
      "relative error of S, R and C_t (Frobenius norms) to reach, 1e-10 to 1: chooses what \"space\", \"rings\" the "
      "input leaves open and the least degree within --p that do, and says so; warns where nothing does"},
     {"--threads", "N", "threads that integrate, condense, factorise and solve; default: 1"},
     {"--loads-only", "", "leave out what only stresses need; stage 2 then extracts none"}}};

/// Says what is to be doubted: links (section 3 of the paper: what they do converges slowly or not at all), a thickness
/// or a disk's modulus far from the sheet's other numbers.
void warn(const stage1::SolvedPlate& plate) {
  constexpr double foil = 1e-4, apart = 300;  // GPa beside MPa are 1000
  const auto& [scene, mesh] = std::tie(plate.scene, plate.solution.mesh);
  const auto say = [&](const std::string& doubt) {
    std::cerr << fmt::format("{}: warning: {}: {}\n", command.name, plate.scene.file, program::one_line(doubt));
  };
  const double width = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).minCoeff();
  const double thinnest = mesh.thickness.minCoeff(), thickest = mesh.thickness.maxCoeff();
  bool has_links = !scene.points.empty();
  std::string thin, stiff;
  if (thickest > width) thin = fmt::format("the thickness {:g} is above the width {:g} of the sheet", thickest, width);
  for (std::size_t i = 0; i < scene.holes.size(); ++i) {
    const auto& hole = scene.holes[i];
    if (thinnest < foil * hole.radius)
      thin = fmt::format("the thickness {:g} is below {:g} of the radius {:g} of hole \"{}\"", thinnest, foil,
                         hole.radius, hole.id);
    if (!hole.spring) continue;
    has_links |= hole.spring->link > 0;
    for (const auto& D : scene.elasticity) {
      const double E = D.inverse().diagonal().head<2>().cwiseInverse().maxCoeff(), disk = hole.spring->disk_E;
      if (disk > 0 && (disk > apart * E || disk < E / apart))
        stiff = fmt::format("/holes/{}/spring/disk/E: {:g} is {:.3g} times the modulus {:g} of the sheet", i, disk,
                            disk / E, E);
    }
  }
  if (has_links) say("points and links concentrate their load at nodes: the results depend on the mesh");
  if (!thin.empty()) say(fmt::format("/geometry: {}: one of them may be in another unit of length", thin));
  if (!stiff.empty()) say(stiff + ": one of them may be in another unit of stress");
}

/// The model that reaches the accuracy asked for, if one is.
std::optional<stage1::Accuracy> meet_accuracy(const stage1::PlateScene& scene, const program::Arguments& arguments) {
  constexpr double least = 1e-10, most = 1;
  const double accuracy = arguments.number("--accuracy", least, most, 0);
  if (accuracy == 0) return std::nullopt;
  auto chosen = stage1::meet_accuracy(scene, accuracy);
  if (!chosen.is_reached())
    std::cerr << fmt::format(
        "{}: warning: {}: {}; that is the best with these cells: finer ones, above all at ends of clamped "
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
  const auto wanted = arguments.flag("--loads-only") ? stage1::Wanted::loads : stage1::Wanted::loads_and_stresses;
  const auto plate = stage1::solve_plate(std::move(scene), wanted, program::generator(command.name), timings);
  warn(plate);
  timings.phase("write");
  formats::write(arguments.output, plate.solution);
  if (arguments.quiet) return;
  std::cout << stage1::summary(plate, arguments.output);
  if (accuracy) std::cout << "  " << stage1::to_text(*accuracy) << "\n";
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
