// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <iostream>
#include <optional>

#include "common/linalg/processor.hpp"
#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "common/program/warning.hpp"
#include "stage1_plate/run/accuracy.hpp"
#include "stage1_plate/run/solve.hpp"

namespace {

using namespace fastjoint;

const program::Command command = {
    "stage1_plate",
    "Solves one sheet of a joint by the p-version of the finite element method: a unit displacement of every fastener\n"
    "disc and rigid boundary, a unit force on every traction boundary.",
    "PLATE.json",
    "PLATE.h5",
    {{"--p", "N or A..B",
      fmt::format("degree 1..{0}, or a range of degrees; default: \"p\" of the input, else 1..{0}", pfem::highest_p)},
     {"--accuracy", "A",
      "estimated relative error of S, R and C_t (Frobenius norms) to reach, 1e-10 to 1: chooses the lowest degree "
      "within --p, and \"space\" and \"rings\" where the input leaves them open; says so, warns where nothing does"},
     {"--peak-accuracy", "A",
      "the same of the estimated relative error of hoop stresses around holes, 1e-6 to 1; also chooses how many waves "
      "around the holes the elements carry"},
     {"--threads", "N",
      "threads for different classes of elements, then for different degrees, at the same time, 1 to 256; default: "
      "1"}}};

/// The worst of several warnings of one kind, and their number.
struct WorstOfKind {
  double severity = 0;
  int count = 0;
  std::string text;

  void add(double by, std::string words) {
    ++count;
    if (by > severity) std::tie(severity, text) = std::pair(by, std::move(words));
  }
  [[nodiscard]] std::string worst() const {
    return count > 1 ? fmt::format("{} (the worst of {})", text, count) : text;
  }
};

/// Warns of doubtful input: links, whose results converge slowly or not at all (section 3 of the paper), a thickness or
/// a disc's modulus of an unlikely magnitude, half holes without symmetry supports.
void warn(const stage1::PlateScene& scene, const stage1::SolvedPlate& plate) {
  constexpr double min_thickness_ratio = 1e-4, max_modulus_ratio = 300;  // GPa mistaken for MPa give 1000
  const auto say = [&](const char* code, const std::string& doubt) {
    program::warn(std::cerr, command.name, {code, scene.file + ": " + doubt});
  };
  for (const auto& name : scene.coupled_laminates)
    say("laminate-couples",
        fmt::format("the laminate \"{}\" is not symmetric about its middle: it bends as it stretches, which the plane "
                    "model prevents",
                    name));
  const pfem::Mesh& mesh = plate.solution.mesh;
  const double width = (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).minCoeff();
  const double thinnest = mesh.thickness.minCoeff(), thickest = mesh.thickness.maxCoeff();
  bool has_links = !scene.points.empty();
  WorstOfKind thin, stiff;
  if (thickest > width)
    thin.add(thickest / width, fmt::format("the thickness {:g} is above the width {:g} of the sheet", thickest, width));
  for (std::size_t i = 0; i < scene.holes.size(); ++i) {
    const auto& hole = scene.holes[i];
    if (thinnest < min_thickness_ratio * hole.radius)
      thin.add(hole.radius / thinnest, fmt::format("the thickness {:g} is below {:g} of the radius {:g} of hole \"{}\"",
                                                   thinnest, min_thickness_ratio, hole.radius, hole.id));
    if (!hole.spring) continue;
    has_links |= hole.spring->link > 0;
    const double disc = hole.spring->disk_E;
    double E = disc;  // modulus of the sheet that differs most from the disc's
    const auto ratio = [&](double modulus) { return std::max(disc / modulus, modulus / disc); };
    for (const auto& D : scene.elasticity)
      if (const double other = D.inverse().diagonal().head<2>().cwiseInverse().maxCoeff(); ratio(other) > ratio(E))
        E = other;
    if (disc > 0 && ratio(E) > max_modulus_ratio)
      stiff.add(ratio(E), fmt::format("/holes/{}/spring/disk/E: {:g} is {:.3g} times the modulus {:g} of the sheet", i,
                                      disc, disc / E, E));
  }
  for (const auto& line : plate.missing_symmetry) say("symmetry-missing", line);
  for (const auto& line : plate.few_waves) say("waves-few", line);
  for (const auto& crack : scene.cracks)
    if (crack.hole && scene.holes[*crack.hole].spring && !scene.holes[*crack.hole].spring->compression_only &&
        !scene.holes[*crack.hole].spring->has_arc)
      say("springs-pull",
          fmt::format("/cracks: the springs all around hole \"{}\" pull the faces of crack \"{}\" together, as "
                      "a fastener cannot: K is too low; give the spring \"compression_only\": true",
                      scene.holes[*crack.hole].id, crack.id));
  if (has_links)
    say("springs-at-nodes", "points and links concentrate their load at nodes: the results depend on the mesh");
  if (thin.count > 0)
    say("thickness-unlikely", fmt::format("/geometry: {}: one of them may be in another unit of length", thin.worst()));
  if (stiff.count > 0) say("disc-modulus-unlikely", stiff.worst() + ": one of them may be in another unit of stress");
}

/// Finds the model for the requested accuracies, if any.
std::optional<stage1::Accuracy> meet_accuracy(const stage1::PlateScene& scene, const program::Arguments& arguments) {
  if (!arguments.flag("--accuracy") && !arguments.flag("--peak-accuracy")) return std::nullopt;
  constexpr double min = 1e-10, min_of_peaks = 1e-6, max = 1;
  stage1::Targets targets;
  targets.matrices = arguments.number("--accuracy", min, max, targets.matrices);
  targets.hoop = arguments.number("--peak-accuracy", min_of_peaks, max, targets.hoop);
  auto chosen = stage1::meet_accuracy(scene, targets);
  const std::string option = arguments.text("--p");
  const std::string bound = option.empty() ? "\"p\" of the scene" : "--p " + option;
  if (!chosen.is_reached())
    program::warn(
        std::cerr, command.name,
        {"accuracy-not-reached",
         fmt::format(
             "{}: {}; {}", scene.file, stage1::to_text(chosen),
             scene.p_high < pfem::highest_p
                 ? fmt::format("that is the best that {} allows: degrees up to {} come closer", bound, pfem::highest_p)
                 : "that is the best with these cells: finer ones, above all at ends of clamped edges "
                   "and of steps in thickness, come closer")});
  return chosen;
}

void run(const program::Arguments& arguments, program::Timings& timings) {
  constexpr int max_threads = 256;
  const int threads = program::threads_that_fit(arguments.integer("--threads", 1, max_threads, 1));
  linalg::set_threads(threads);
  timings.set_threads(threads);
  timings.phase("read");
  stage1::PlateScene scene = stage1::read_scene(input::parse(arguments.input, input::read_text_file(arguments.input)));
  stage1::set_degrees(scene, arguments.text("--p"));
  if (arguments.flag("--accuracy") || arguments.flag("--peak-accuracy")) timings.phase("search");
  const auto accuracy = meet_accuracy(scene, arguments);
  if (accuracy) scene = accuracy->scene;
  const auto plate = stage1::solve_plate(scene, program::generator(command.name), timings);
  warn(scene, plate);
  timings.phase("write");
  formats::write(arguments.output, plate.solution);
  if (arguments.quiet) return;
  std::cout << stage1::summary(plate, arguments.output);
  if (accuracy) std::cout << "  " << stage1::to_text(*accuracy) << "\n";
}

}  // namespace

int main(int argc, char** argv) { program::run(command, argc, argv, run); }
