// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/memory.hpp"
#include "common/program/progress.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/results/crack_errors.hpp"
#include "stage3_nonlinear/study/run_study.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr const char* program_name = "stage3_nonlinear";

using program::check_spare;

void check_csv(const program::Arguments& arguments, const std::string& csv_file) {
  for (const auto& path : {arguments.input, arguments.output})
    check_spare("--csv", csv_file, path, "the input or the output file");
  check_spare("--csv", csv_file, arguments.timings, "the file of --timings");
  if (!csv_file.empty()) h5::check_can_write(csv_file);
}

/// Refuses output files that would overwrite an input file.
void check_results_spare(const program::Arguments& arguments, const std::string& csv_file, const JointScene& scene) {
  const auto check = [&](const std::string& input) {
    for (const auto& [option, path] :
         {std::pair("-o", arguments.output), std::pair("--csv", csv_file), std::pair("--timings", arguments.timings)})
      check_spare(option, path, input, fmt::format("a file that {} reads", arguments.input));
  };
  for (const auto& plate : scene.plates) check(plate.file);
  for (const auto& [name, law] : scene.laws) check(law.law->file());
}

void warn(std::ostream& log, const std::vector<program::Warning>& warnings) {
  for (const auto& each : warnings) program::warn(log, program_name, each);
}

/// Bytes of the program and of the plates' matrices.
double matrices_need(const JointScene& scene) {
  double bytes = 20e6;  // the program itself
  for (const auto& plate : scene.plates) {
    std::error_code none;
    if (const auto size = std::filesystem::file_size(plate.file, none); !none) bytes += 2 * double(size);
  }
  return bytes;
}

/// Throws InputError if there is too little memory for the matrices, for solving and for the results of all increments.
void require_memory(const JointScene& scene, const JointModel& joint, bool with_csv, bool with_sensitivities,
                    bool with_rim_stresses) {
  using program::bytes_text;
  const JointNumbers numbers = joint_numbers(joint);
  const double n = double(joint.n_planes());
  double of_plane = with_csv ? 64 : 12;
  if (with_sensitivities) of_plane += double(numbers.n_derivatives());
  constexpr double number = sizeof(double), of_stiffness = 24, of_rim = 17, of_plate = 60;
  constexpr double of_points = 3 * 360,
                   of_loaded_rim = 600;  // stresses, and the waves and tractions that they follow from
  double solving = 0, of_step = of_plane * n, around_rims = 0;
  for (const auto& plate : joint.plates) {
    const auto cases = double(plate.R.cols()), unknowns = double(plate.n_unknowns());
    solving += of_stiffness * number * unknowns * (unknowns + (numbers.friction.empty() ? 0 : cases / 2));
    const double n_rims = plate.stress_level ? double(plate.stresses.rim_hole.size()) : 0;
    of_step += of_plate + unknowns + cases + of_rim * n_rims;
    if (with_rim_stresses) around_rims += (of_points + of_loaded_rim) * n_rims;
  }
  if (with_sensitivities) {  // derivatives of displacements and of friction loads
    const bool has_peaks =
        std::ranges::any_of(joint.plates, [](const auto& plate) { return plate.stress_level.has_value(); });
    constexpr double of_forces = 3, of_peaks = 4;
    const double each = of_forces + (has_peaks ? of_peaks : 0);
    solving += number * double(joint.n_unknowns()) * each * double(numbers.n_derivatives());
  }
  const double read = matrices_need(scene);
  const Index n_steps = std::max<Index>(std::ssize(scene.load_factors), 1);  // how many events is not known yet
  constexpr double copies = 2.5;                                             // in the states and in the tables
  const double results = number * (copies * of_step + around_rims) * double(n_steps);
  program::require_memory(
      scene.file + ": this", read + solving + results,
      fmt::format(" (matrices {}, solving {}, results of {} {})", bytes_text(read), bytes_text(solving),
                  program::counted(n_steps, "increment"), bytes_text(results)),
      fmt::format("fewer increments, or {}", with_sensitivities  ? "no --sensitivities"
                                             : with_rim_stresses ? "no --rim-stresses"
                                                                 : "matrices of stage2_extract --loads-only"));
}

void set_crack_errors(const std::vector<CrackErrors>& errors, formats::JointResult& result) {
  for (std::size_t i = 0; i < errors.size(); ++i)
    if (errors[i].K_I.size() > 0) {
      result.plates[i].cracks.K_I_error = errors[i].K_I;
      result.plates[i].cracks.K_II_error = errors[i].K_II;
    }
}

}  // namespace

void run(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings) {
  if (arguments.flag("--study")) {
    for (const char* option : {"--csv", "--sensitivities", "--rim-stresses", "--all-stresses", "--verbose"})
      if (arguments.flag(option))
        throw InputError(fmt::format("{}: given together with --study; allowed: one of them", option));
    return run_study(arguments, out, log, timings);
  }
  for (const char* option : {"--sample", "--slice", "--merge", "--threads"})
    if (arguments.flag(option)) throw InputError(fmt::format("{}: given without --study; allowed: both", option));
  timings.phase("read");
  const int p = arguments.integer("--p", 1, formats::highest_degree, 0);
  const std::string csv_file = arguments.text("--csv");
  const bool with_sensitivities = arguments.flag("--sensitivities");
  const bool with_rim_stresses = arguments.flag("--rim-stresses");
  check_csv(arguments, csv_file);
  const auto document = input::parse(arguments.input, input::read_text_file(arguments.input));
  const JointScene scene = read_joint_scene(document);
  check_results_spare(arguments, csv_file, scene);
  warn(log, scene.warnings);
  program::require_memory(scene.file + ": reading its plates' matrices", matrices_need(scene), "",
                          "matrices of fewer holes, or of stage2_extract --loads-only");
  const JointModel joint = load_joint(scene, p);
  require_memory(scene, joint, !csv_file.empty(), with_sensitivities, with_rim_stresses);
  timings.phase("solve");
  const JointEquations equations = make_equations(joint);
  const PathOptions solving{scene.initial, scene.solver, arguments.flag("--verbose") ? &log : nullptr};
  program::report_share(0);
  auto [path, increments] = follow_with_results(joint, equations, scene.load_factors, solving,
                                                {scene.solver.tolerance, with_sensitivities, with_rim_stresses});
  path.interference = search_interference(equations, solving, path);
  program::report_share(1);
  warn(log, warnings(joint, equations, path));
  warn(log, implausible_numbers(scene, joint, path));
  warn(log, rim_warnings(joint, increments.states));
  auto result = joint_result(joint, equations, path, increments, with_rim_stresses);
  result.header = {program::generator(program_name), scene.name, joint.units, document.text};
  const auto errors = crack_errors(scene, joint, path, increments.states, solving, scene.solver.tolerance);
  set_crack_errors(errors, result);
  warn(log, crack_warnings(joint, increments.states, errors));
  if (with_sensitivities) result.sensitivity = sensitivity_history(joint, path, increments);
  timings.phase("write");
  formats::write(arguments.output, result);
  if (!csv_file.empty()) h5::write_whole_file(csv_file, csv(joint, result));
  if (!arguments.quiet) out << summary(scene, joint, path, increments.states, result, arguments.flag("--all-stresses"));
  if (path.failure) throw IncompleteResult(failure_message(scene, joint, path, arguments.output));
}

}  // namespace fastjoint::stage3
