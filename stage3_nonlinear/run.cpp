// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/run.hpp"

#include <fmt/format.h>

#include <ostream>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/program.hpp"
#include "common/program/text_file.hpp"
#include "stage3_nonlinear/event_path.hpp"
#include "stage3_nonlinear/force_error.hpp"
#include "stage3_nonlinear/joint_history.hpp"
#include "stage3_nonlinear/report.hpp"
#include "stage3_nonlinear/rim_history.hpp"
#include "stage3_nonlinear/sensitivity_history.hpp"
#include "stage3_nonlinear/summary.hpp"

namespace fastjoint::stage3 {
namespace {

void check_csv(const RunOptions& options) {
  if (options.csv.empty()) return;
  if (h5::same_file(options.csv, options.input) || h5::same_file(options.csv, options.output))
    throw InputError(fmt::format("--csv {}: is the input or the output file; choose another name", options.csv));
  if (h5::same_file(options.csv, options.timings))
    throw InputError(fmt::format("--csv {}: is the file of --timings; choose another name", options.csv));
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
  for (const auto& [name, law] : scene.laws) check(law.file);
}

void warn(std::ostream& log, const std::vector<std::string>& sentences) {
  for (const auto& sentence : sentences) log << "stage3_nonlinear: warning: " << program::one_line(sentence) << "\n";
}

}  // namespace

void run(const RunOptions& options, std::ostream& out, std::ostream& log, program::Timings& timings) {
  timings.phase("read");
  check_csv(options);
  const auto document = input::parse(options.input, program::read_text_file(options.input));
  const JointScene scene = read_joint_scene(document);
  check_results_spare(options, scene);
  warn(log, scene.warnings);
  const JointModel joint = load_joint(scene, options.p);
  timings.phase("solve");
  const JointEquations equations = make_equations(joint);
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
