// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/run.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <ostream>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/memory.hpp"
#include "common/program/program.hpp"
#include "stage3_nonlinear/output/joint_history.hpp"
#include "stage3_nonlinear/output/summary.hpp"
#include "stage3_nonlinear/output/warnings.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/force_error.hpp"
#include "stage3_nonlinear/results/sensitivity.hpp"

namespace fastjoint::stage3 {
namespace {

void check_csv(const RunOptions& options) {
  if (options.csv.empty()) return;
  for (const auto& [path, what] :
       {std::pair(options.input, "the input or the output file"),
        std::pair(options.output, "the input or the output file"), std::pair(options.timings, "the file of --timings")})
    if (h5::same_file(options.csv, path))
      throw InputError(fmt::format("--csv {}: is {}; choose another name", options.csv, what));
  h5::check_can_write(options.csv);
}

/// The results must not take the place of what they are made of.
void check_results_spare(const RunOptions& options, const JointScene& scene) {
  const auto check = [&](const std::string& input) {
    for (const auto& [option, path] :
         {std::pair("-o", options.output), std::pair("--csv", options.csv), std::pair("--timings", options.timings)})
      if (h5::same_file(path, input))
        throw InputError(
            fmt::format("{} {}: is a file that {} reads; choose another name", option, path, options.input));
  };
  for (const auto& plate : scene.plates) check(plate.file);
  for (const auto& [name, law] : scene.laws) check(law.law->file());
}

void warn(std::ostream& log, const std::vector<std::string>& sentences) {
  for (const auto& sentence : sentences) log << "stage3_nonlinear: warning: " << program::one_line(sentence) << "\n";
}

/// Bytes of the program and of the plates' matrices.
double matrices_need(const JointScene& scene) {
  double bytes = 26e6;  // of the program
  for (const auto& plate : scene.plates) {
    std::error_code none;
    if (const auto size = std::filesystem::file_size(plate.file, none); !none) bytes += 1.25 * double(size);
  }
  return bytes;
}

/// Throws InputError if there is too little memory for the matrices, for solving and for the results of n_steps
/// increments.
void require_memory(const JointScene& scene, const JointModel& joint, const JointEquations& equations,
                    const RunOptions& options, std::size_t n_steps) {
  using program::bytes_text;
  const JointNumbers numbers = joint_numbers(joint, equations.system);
  const double n = double(joint.n_planes());
  double of_plane = options.csv.empty() ? 12 : 37;
  if (options.sensitivities)
    of_plane += n + double(numbers.friction.size() + numbers.law.size() + numbers.loads.force.size() +
                           numbers.loads.displacement.size());
  constexpr double number = sizeof(double), of_rim = 17, of_stiffness = 24;
  double solving = 0, of_step = of_plane * n;
  for (const auto& plate : joint.plates) {
    const auto cases = double(plate.R.cols()), unknowns = double(plate.n_unknowns());
    solving += of_stiffness * number * unknowns * (unknowns + (numbers.friction.empty() ? 0 : cases / 2));
    of_step += unknowns + cases + of_rim * (plate.stress_level ? double(plate.stresses.rim_hole.size()) : 0);
  }
  const double read = matrices_need(scene);
  constexpr double copies = 4.5;  // in the states, in the tables, in the file and in its image
  const double results = copies * number * of_step * double(n_steps);
  program::require_memory(
      scene.file + ": this", read + solving + results,
      fmt::format(" (matrices {}, solving {}, results of {} {})", bytes_text(read), bytes_text(solving),
                  program::counted(n_steps, "increment"), bytes_text(results)),
      fmt::format("fewer increments, or {}",
                  options.sensitivities ? "no --sensitivities" : "matrices of stage1_plate --loads-only"));
}

}  // namespace

void run(const RunOptions& options, std::ostream& out, std::ostream& log, program::Timings& timings) {
  timings.phase("read");
  check_csv(options);
  const auto document = input::parse(options.input, input::read_text_file(options.input));
  const JointScene scene = read_joint_scene(document);
  check_results_spare(options, scene);
  warn(log, scene.warnings);
  program::require_memory(scene.file + ": reading its plates' matrices", matrices_need(scene), "",
                          "matrices of fewer holes, or of stage1_plate --loads-only");
  const JointModel joint = load_joint(scene, options.p);
  if (scene.solver.method == Method::exact_path && joint.n_directions() > 1)
    refuse(scene.file + ": /solver/method", "\"exact path\", but the discs move along x and y",
           "another method, or plates whose discs have one direction");
  timings.phase("solve");
  const JointEquations equations = make_equations(joint);
  require_memory(scene, joint, equations, options, scene.load_factors.size());
  const PathOptions solving{scene.initial, scene.solver};
  LoadPath path = scene.at_events ? follow_events(equations, solving) : follow(equations, scene.load_factors, solving);
  const auto states = balanced_states(joint, equations.system, scene.solver.tolerance, path);
  warn(log, warnings(joint, equations, path));
  warn(log, implausible_numbers(scene, joint, path));
  warn(log, rim_warnings(joint, states));
  auto result = joint_result(joint, path, states);
  result.header = {options.generator, scene.name, joint.units, document.text};
  result.F_error = force_errors(joint, equations, path, states);
  if (options.sensitivities) result.sensitivity = sensitivity_history(joint, equations, path);
  timings.phase("write");
  formats::write(options.output, result);
  if (!options.csv.empty()) h5::write_whole_file(options.csv, csv(joint, result));
  if (!options.quiet) out << summary(scene, joint, path, states, result.F_error, options.all_stresses);
  if (path.failure)
    throw IncompleteResult(failure_message(scene, joint, *path.failure, path.n_increments, options.output));
}

}  // namespace fastjoint::stage3
