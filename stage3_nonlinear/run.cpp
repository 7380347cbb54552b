// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <ostream>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/program/memory.hpp"
#include "common/program/progress.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/output/case_summary.hpp"
#include "stage3_nonlinear/output/case_warnings.hpp"
#include "stage3_nonlinear/output/envelope.hpp"
#include "stage3_nonlinear/output/governing.hpp"
#include "stage3_nonlinear/output/joined_result.hpp"
#include "stage3_nonlinear/output/margin_lines.hpp"
#include "stage3_nonlinear/output/memory_need.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/output/secondary_bending.hpp"
#include "stage3_nonlinear/output/stress_range_lines.hpp"
#include "stage3_nonlinear/output/totals.hpp"
#include "stage3_nonlinear/results/crack_errors.hpp"
#include "stage3_nonlinear/strength/margins.hpp"
#include "stage3_nonlinear/study/run_study.hpp"

namespace fastjoint::stage3 {
namespace {

using program::check_spare;

constexpr std::array table_options{"--csv", "--envelope", "--margins", "--totals"};

/// Refuses tables that would overwrite another file.
void check_tables(const program::Arguments& arguments) {
  for (const char* option : table_options) {
    const std::string table = arguments.text(option);
    for (const auto& path : {arguments.input, arguments.output})
      check_spare(option, table, path, "the input or the output file");
    check_spare(option, table, arguments.timings, "the file of --timings");
    if (!table.empty()) h5::check_can_write(table);
  }
  for (std::size_t i = 0; i < table_options.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      check_spare(table_options[i], arguments.text(table_options[i]), arguments.text(table_options[k]),
                  fmt::format("the file of {}", table_options[k]));
}

/// Refuses output files that would overwrite an input file.
void check_results_spare(const program::Arguments& arguments, const JointScene& scene) {
  const auto check = [&](const std::string& input) {
    const std::string role = fmt::format("a file that {} reads", arguments.input);
    check_spare("-o", arguments.output, input, role);
    check_spare("--timings", arguments.timings, input, role);
    for (const char* option : table_options) check_spare(option, arguments.text(option), input, role);
  };
  for (const auto& plate : scene.plates) check(plate.file);
  for (const auto& [name, law] : scene.laws) check(law.law->file());
}

/// The cases to solve: all, or that of --case.
std::vector<std::size_t> chosen_cases(const program::Arguments& arguments, const JointScene& scene) {
  std::vector<std::size_t> chosen;
  const std::string name = arguments.text("--case");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.cases.size(); ++i) {
    names.push_back(scene.cases[i].name);
    if (!arguments.flag("--case") || names.back() == name) chosen.push_back(i);
  }
  if (chosen.empty() || (arguments.flag("--case") && name.empty()))
    throw InputError(fmt::format("--case: \"{}\"; allowed: {}", name,
                                 names.front().empty() ? "no such option: the joint has no \"cases\""
                                                       : fmt::format("{}", fmt::join(names, ", "))));
  for (const char* option : {"--sensitivities", "--all-stresses"})
    if (chosen.size() > 1 && arguments.flag(option))
      throw InputError(fmt::format("{}: given for {}; allowed: together with --case NAME", option,
                                   program::counted(chosen.size(), "case")));
  if (arguments.flag("--envelope") && names.front().empty())
    throw InputError(
        fmt::format("--envelope: given for a joint without cases; allowed: with \"cases\" in {}", scene.file));
  if (arguments.flag("--margins") && scene.checks.empty())
    throw InputError(
        fmt::format("--margins: given for a joint without checks; allowed: with \"margins\" in {}", scene.file));
  return chosen;
}

/// Prints warnings and adds them to those for the result.
void warn(std::ostream& log, const std::vector<program::Warning>& warnings, std::vector<program::Warning>& all) {
  for (const auto& each : warnings) program::warn(log, program_name, each);
  all.insert(all.end(), warnings.begin(), warnings.end());
}

/// Throws InputError if there is too little memory for the matrices, for solving and for the results of all increments
/// of the chosen cases.
void require_memory(const JointScene& scene, const JointModel& joint, const Parameters& parameters,
                    const std::vector<std::size_t>& chosen, bool with_csv, bool with_sensitivities,
                    bool with_rim_stresses) {
  using program::bytes_text;
  const auto [solving, of_step] = joint_need(joint, parameters, with_csv, with_sensitivities, with_rim_stresses);
  const double read = matrices_need(scene);
  Index n_steps = 0;
  for (const std::size_t at : chosen)
    n_steps += std::max<Index>(std::ssize(scene.cases[at].load_factors), 1);  // how many events is not known yet
  const double results = of_step * double(n_steps);
  program::require_memory(
      scene.file + ": this", read + solving + results,
      fmt::format(" (matrices {}, solving {}, results of {} {})", bytes_text(read), bytes_text(solving),
                  program::counted(n_steps, "increment"), bytes_text(results)),
      fmt::format("fewer increments, or {}", with_sensitivities  ? "no --sensitivities"
                                             : with_rim_stresses ? "no --rim-stresses"
                                                                 : "matrices of stage2_extract --loads-only"));
}

/// What a load case comes to.
struct SolvedCase {
  formats::JointResult result;
  std::vector<SpotExtremes> spots;
  std::vector<program::Warning> warnings;
  std::string failure;  ///< empty if all increments converged
  std::string summary;  ///< of every increment, of one case of several its secondary bending alone
};

MoreStresses stresses_wanted(const program::Arguments& arguments) {
  MoreStresses wanted{arguments.flag("--rim-stresses"), {}};
  constexpr double least = 1e-30, most = 1e30;  // as lengths of the input
  if (arguments.flag("--distance")) wanted.distance = arguments.number("--distance", least, most, 0);
  return wanted;
}

/// Solves a load case. @param alone It is the only one, whose increments the summary tells.
SolvedCase solve_case(const program::Arguments& arguments, const JointScene& scene, const JointModel& joint,
                      CaseRun& cases, CrackErrorEstimate& cracks, std::size_t at, bool alone, std::ostream& log) {
  const CaseScene& its = scene.cases[at];
  const PathOptions solving{scene.initial, scene.solver, arguments.flag("--verbose") ? &log : nullptr};
  const MoreStresses wanted = stresses_wanted(arguments);
  const bool with_slopes = arguments.flag("--sensitivities");
  auto [equations, path, increments, missing] =
      cases.follow(at, its.load_factors, solving,
                   {scene.solver.tolerance, with_slopes, &cases.bending(), wanted.all_around || wanted.distance});
  const auto& states = increments.states;
  path.interference = search_interference(equations, solving, path);
  const auto errors = cracks.of(joint, at, path, states, solving);
  SolvedCase solved{
      joint_result(joint, equations, path, increments, wanted, errors), std::move(increments.spots), {}, {}, {}};
  if (missing) {
    solved.result.complete = false;
    solved.failure = fmt::format("{}: case \"{}\" comes after \"{}\", which was not solved", scene.file, its.name,
                                 scene.cases[*missing].name);
    return solved;
  }
  for (const auto& some :
       {warnings(joint, equations, path), implausible_numbers(scene, joint, equations.parameters, path),
        rim_warnings(joint, equations.parameters, states), crack_warnings(joint, states, errors),
        bending_warnings(joint, states),
        wanted.distance ? distance_warnings(joint, *wanted.distance) : std::vector<program::Warning>()})
    solved.warnings.insert(solved.warnings.end(), some.begin(), some.end());
  if (with_slopes) solved.result.sensitivity = sensitivity_history(joint, increments);
  if (!alone && !states.empty()) solved.summary = secondary_bending(joint, states.back());
  if (alone) solved.summary = summary(scene, joint, path, states, solved.result, arguments.flag("--all-stresses"));
  if (path.failure) solved.failure = failure_message(scene, its, joint, path, arguments.output);
  return solved;
}

/// Throws IncompleteResult if some cases failed. @param failures Messages of those that did.
void check_solved(const std::vector<std::string>& failures, std::size_t n_cases) {
  if (failures.empty()) return;
  const std::string more =
      n_cases == 1 ? "" : fmt::format(" ({} of {} cases were not solved)", failures.size(), n_cases);
  throw IncompleteResult(fmt::format("{}{}", fmt::join(failures, "; "), more));
}

}  // namespace

void run(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings) {
  if (arguments.flag("--study")) {
    for (const char* option : {"--csv", "--envelope", "--margins", "--totals", "--case", "--sensitivities",
                               "--rim-stresses", "--distance", "--all-stresses", "--verbose"})
      if (arguments.flag(option))
        throw InputError(fmt::format("{}: given together with --study; allowed: one of them", option));
    for (const char* option : {"--slice", "--merge", "--threads", "--p"})
      if (arguments.flag("--sample") && arguments.flag(option))
        throw InputError(fmt::format("{}: given together with --sample; allowed: one of them", option));
    return run_study(arguments, out, log, timings);
  }
  for (const char* option : {"--sample", "--slice", "--merge", "--threads"})
    if (arguments.flag(option)) throw InputError(fmt::format("{}: given without --study; allowed: both", option));
  timings.phase("read");
  const int p = arguments.integer("--p", 1, formats::highest_degree, 0);
  check_tables(arguments);
  const auto document = input::parse(arguments.input, input::read_text_file(arguments.input));
  const JointScene scene = read_joint_scene(document);
  const auto chosen = chosen_cases(arguments, scene);
  check_results_spare(arguments, scene);
  std::vector<program::Warning> warnings;
  warn(log, scene.warnings, warnings);
  require_memory_to_read(scene);
  const JointModel joint = load_joint(scene, p);
  const Parameters first = parameters_of(joint, scene, scene.cases.front());
  require_memory(scene, joint, first, chosen, !arguments.text("--csv").empty(), arguments.flag("--sensitivities"),
                 arguments.flag("--rim-stresses"));
  const CheckedItems checked = checked_items(scene, joint, first);  // ends before solving if a check cannot be made
  timings.phase("solve");
  program::report_share(0);
  CaseRun cases(scene, joint);
  CrackErrorEstimate cracks(scene, joint);
  formats::JointResult result;
  std::vector<SpotExtremes> spots;
  CaseWarnings found;
  std::vector<std::string> texts, failures;
  for (const std::size_t at : chosen) {
    SolvedCase its = solve_case(arguments, scene, joint, cases, cracks, at, chosen.size() == 1, log);
    append(spots, std::move(its.spots));
    append(result, scene.cases[at].name, std::move(its.result));
    found.add(scene.cases[at].name, its.warnings);
    if (!its.failure.empty()) failures.push_back(std::move(its.failure));
    texts.push_back(std::move(its.summary));
  }
  program::report_share(1);
  warn(log, found.all(chosen.size()), warnings);
  result.header = {program::generator(program_name), scene.name, joint.units, document.text};
  if (!scene.cases.front().name.empty()) result.envelope = envelope(joint, result);
  if (!scene.checks.empty()) {
    LeftOut left_out = checked.left_out;
    result.margins = margins(checked.items, result, left_out);
    warn(log, left_out.warnings(scene), warnings);
    warn(log, edge_warnings(scene, result.margins), warnings);
  }
  for (const auto& each : failures) warnings.push_back({"not-solved", each});
  set_governing(result);
  result.stress_ranges = stress_ranges(spots, result);
  for (const auto& each : warnings) {
    result.warning_code.emplace_back(each.code);
    result.warning.push_back(each.text);
  }
  timings.phase("write");
  formats::write(arguments.output, result);
  if (arguments.flag("--csv")) h5::write_whole_file(arguments.text("--csv"), csv(joint, result));
  if (arguments.flag("--envelope")) h5::write_whole_file(arguments.text("--envelope"), envelope_csv(result));
  if (arguments.flag("--margins")) h5::write_whole_file(arguments.text("--margins"), margins_csv(result));
  if (arguments.flag("--totals")) h5::write_whole_file(arguments.text("--totals"), totals_csv(result));
  if (!arguments.quiet) {
    const int of = result.governing > 0 ? result.case_of[result.governing - 1] : 0;
    if (chosen.size() > 1) out << case_summary(scene, joint, result) << stress_range_lines(result);
    if (chosen.size() > 1 && !texts[of].empty()) out << fmt::format("case \"{}\":\n", result.case_name[of]);
    out << texts[of] << (chosen.size() > 1 ? "" : stress_range_lines(result)) << margin_lines(scene, result);
  }
  check_solved(failures, chosen.size());
}

}  // namespace fastjoint::stage3
