// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/run_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <ostream>
#include <random>
#include <thread>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/linalg/processor.hpp"
#include "common/program/memory.hpp"
#include "common/program/progress.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/output/case_warnings.hpp"
#include "stage3_nonlinear/output/memory_need.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/crack_errors.hpp"
#include "stage3_nonlinear/results/increments.hpp"
#include "stage3_nonlinear/study/samples.hpp"
#include "stage3_nonlinear/study/study_statistics.hpp"
#include "stage3_nonlinear/study/study_summary.hpp"

namespace fastjoint::stage3 {
namespace {

struct Slice {
  int number = 1, n = 1;
  bool is_whole = true;
};

/// Reads a slice, "3/20"; the whole study without the option.
Slice read_slice(const program::Arguments& arguments) {
  if (!arguments.flag("--slice")) return {};
  if (arguments.flag("--merge")) throw InputError("--slice: given together with --merge; allowed: one of them");
  const std::string text = arguments.text("--slice");
  const char *at = text.data(), *end = text.data() + text.size();
  Slice slice{0, 0, false};
  const auto [middle, first] = std::from_chars(at, end, slice.number);
  const bool parted = first == std::errc() && middle != end && *middle == '/';
  const auto [last, second] = std::from_chars(parted ? middle + 1 : end, end, slice.n);
  if (second != std::errc() || last != end || slice.number < 1 || slice.number > slice.n)
    throw InputError(fmt::format("--slice: \"{}\"; allowed: i/n with i from 1 to n", text));
  return slice;
}

Study read_study(const program::Arguments& arguments) {
  const std::string study_file = arguments.text("--study");
  const auto check = [&](const std::string& file, const std::string& what) {
    program::check_spare("-o", arguments.output, file, what);
    program::check_spare("--timings", arguments.timings, file, what);
  };
  check(study_file, "the study");
  Study study;
  study.joint_text = input::parse(arguments.input, input::read_text_file(arguments.input));
  study.study_text = input::parse(study_file, input::read_text_file(study_file));
  study.joint = read_joint_scene(study.joint_text);
  study.scene = read_study_scene(study.study_text, study.joint_text);
  const std::string of_joint = fmt::format("a file that {} reads", arguments.input);
  for (const auto& plate : study.joint.plates) check(plate.file, of_joint);
  for (const auto& [name, law] : study.joint.laws) check(law.law->file(), of_joint);
  for (const auto& variable : study.scene.variables)
    check(variable.table, fmt::format("a file that {} reads", study_file));
  return study;
}

/// The joint with friction wherever a sample may have some, since the condensed joint has columns for it.
JointScene with_all_friction(const Study& study, SampledJoint& sampled) {
  const std::vector<double> middle = middle_values(study.scene);
  JointScene all = sampled.scene(middle);
  for (std::size_t i = 0; i < middle.size(); ++i) {
    std::vector<double> values = middle;
    values[i] = largest_of(study.scene.variables[i]);
    try {
      const JointScene& scene = sampled.scene(values);
      for (std::size_t f = 0; f < all.fasteners.size(); ++f)
        for (std::size_t h = 0; h < all.fasteners[f].friction.size(); ++h)
          all.fasteners[f].friction[h] = std::max(all.fasteners[f].friction[h], scene.fasteners[f].friction[h]);
    } catch (const InputError&) {  // such a sample will be refused
      continue;
    }
  }
  return all;
}

formats::StudyOrigin origin_of(const Study& study, const JointModel& joint, std::uint64_t seed) {
  formats::StudyOrigin origin{
      program::generator(program_name), study.joint_text.text, study.study_text.text, std::to_string(seed), {}, {}};
  const auto add = [&](const std::string& name, const std::string& digest) {
    origin.file.push_back(name), origin.digest.push_back(digest);
  };
  add("polynomial degree", std::to_string(joint.p));
  for (const auto& plate : joint.plates) add(fmt::format("matrices of plate {}", plate.name), plate.header.digest);
  for (const auto& [name, law] : study.joint.laws)
    if (const auto file = law.law->file(); !file.empty()) add(fmt::format("file of law {}", name), h5::digest(file));
  for (const auto& variable : study.scene.variables)
    if (!variable.table.empty()) add(fmt::format("table of {}", variable.name), h5::digest(variable.table));
  return origin;
}

std::uint64_t seed_of(const program::Arguments& arguments, const StudyScene& study, bool may_draw, std::ostream& log) {
  if (study.seed) return *study.seed;
  if (const auto before = StudyBlocks::seed_in(arguments.output)) return *before;
  const bool draws = std::ranges::any_of(study.variables, [](const auto& its) { return its.table.empty(); });
  if (study.sampling == Sampling::grid || !draws) return 0;
  if (!may_draw)
    throw InputError(
        fmt::format("{}: /: no \"seed\"; allowed: a seed, without which slices and --sample would not be of one study",
                    study.file));
  const std::uint64_t seed = std::random_device()() & std::uint32_t(std::numeric_limits<int>::max());
  log << fmt::format("{}: the study's seed is {}; \"seed\": {} in {} repeats it\n", program_name, seed, seed,
                     study.file);
  return seed;
}

/// Warnings of a run of the joint with all variables in their middle, at the last increment of every case.
std::vector<program::Warning> middle_warnings(const JointModel& joint, const JointScene& scene,
                                              const std::vector<std::size_t>& cases) {
  const PathOptions solving{scene.initial, scene.solver};
  CaseRun run(scene, joint);
  CrackErrorEstimate cracks(scene, joint);
  CaseWarnings found;
  for (const std::size_t at : cases) {
    const auto [equations, path, increments, missing] =
        run.follow(at, {scene.cases[at].wanted_load_factors().back()}, solving, {scene.solver.tolerance});
    if (missing) continue;
    const auto errors = cracks.of(joint, at, path, increments.states, solving);
    for (const auto& some :
         {warnings(joint, equations, path), implausible_numbers(scene, joint, equations.parameters, path),
          rim_warnings(joint, equations.parameters, increments.states),
          crack_warnings(joint, increments.states, errors)})
      found.add(scene.cases[at].name, some);
  }
  std::vector<program::Warning> all = scene.warnings;
  for (const auto& each : found.all(cases.size())) all.push_back(each);
  for (auto& each : all) each.text += " (with every variable of the study in its middle)";
  return all;
}

/// Numbers of the cases that the study names, or of all. Throws InputError if they displace different externals, for
/// which the joint would have to be condensed again.
std::vector<std::size_t> studied_cases(const Study& study) {
  std::vector<std::size_t> cases;
  std::vector<std::string> names;
  for (const auto& its : study.joint.cases) names.push_back(its.name);
  for (const auto& name : study.scene.cases) {
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
      throw InputError(fmt::format(
          "{}: /cases: \"{}\" is no case of the joint; allowed: {}", study.scene.file, name,
          names.front().empty() ? "none, since it has no \"cases\"" : fmt::format("{}", fmt::join(names, ", "))));
    cases.push_back(found - names.begin());
  }
  for (std::size_t i = 0; i < names.size() && study.scene.cases.empty(); ++i) cases.push_back(i);
  for (const std::size_t at : cases)
    for (auto its = std::optional(at); its; its = study.joint.cases[*its].after)
      if (study.joint.cases[*its].held() != study.joint.cases[cases.front()].held())
        throw InputError(
            fmt::format("{}: /cases: \"{}\" and \"{}\" displace or tie different externals; allowed: "
                        "cases that displace and tie the same ones",
                        study.scene.file, names[cases.front()], names[*its]));
  return cases;
}

/// Sentence with the first failed samples, and how to write the joint of one.
std::string failures_text(const StudyBlocks& blocks) {
  constexpr std::size_t max_listed = 5;
  std::vector<std::uint64_t> failed;
  for (int block = 0; block < blocks.n_blocks() && failed.size() < max_listed; ++block) {
    const auto its = blocks.read(block);
    for (Index i = 0; i < its.status.size() && failed.size() < max_listed; ++i)
      if (its.status[i] != 0) failed.push_back(blocks.first(block) + i);
  }
  if (failed.empty()) return {};
  return fmt::format("the first are {}; --sample {} -o FILE.json writes that joint", fmt::join(failed, ", "),
                     failed[0]);
}

/// Loads the joint of the study, whose matrices must have the requested results.
/// @param scene With all friction.
JointModel load_studied(const program::Arguments& arguments, const Study& study, const JointScene& scene) {
  JointModel joint = load_joint(scene, arguments.integer("--p", 1, formats::highest_degree, 0));
  const auto require = [&](const char* word, bool has_some, const std::string& reason) {
    if (study.scene.outputs.contains(word) && !has_some)
      throw InputError(fmt::format("{}: /outputs: \"{}\", but {}", study.scene.file, word, reason));
  };
  require("peaks", std::ranges::any_of(joint.plates, [](const auto& plate) { return plate.stress_level.has_value(); }),
          fmt::format("no plate's matrices hold stresses at p = {}; allowed: matrices of stage2_extract without "
                      "--loads-only, at their highest degree",
                      joint.p));
  require("bending", joint.plates.front().bends,
          "the joint has no secondary bending; allowed: without \"bending\": \"none\", and with matrices of sheets in "
          "plane stress that have \"bay\"");
  require("cracks", std::ranges::any_of(joint.plates, [](const auto& plate) { return !plate.cracks.tips.empty(); }),
          "no plate has cracks; allowed: at least one plate with \"cracks\" in its PLATE.json");
  require("margins", !study.joint.checks.empty(),
          fmt::format("the joint has no checks; allowed: with \"margins\" in {}", study.joint.file));
  return joint;
}

/// Throws InputError if there is too little memory for the matrices, and for samples on all threads or the statistics
/// after them.
void require_memory(const Study& study, const JointModel& joint, const Parameters& parameters,
                    const StudyOutputs& outputs, int threads) {
  using program::bytes_text;
  constexpr double of_tangent = 8 * sizeof(double);  // its factors and the matrices that it is made of
  const auto [solving, of_step] = joint_need(joint, parameters, false, false, false);
  const auto r = double(joint.n_planes() * joint.n_directions() + joint.n_moments());
  const double read = matrices_need(study.joint), samples = solving + threads * (of_step + of_tangent * r * r);
  const double statistics = statistics_need(study.scene, outputs);
  program::require_memory(study.scene.file + ": this", read + std::max(samples, statistics),
                          fmt::format(" (matrices {}, solving on {} {}, then statistics of {} {})", bytes_text(read),
                                      program::counted(threads, "thread"), bytes_text(samples),
                                      program::counted(outputs.size(), "number"), bytes_text(statistics)),
                          "fewer \"outputs\" or threads, or matrices of stage2_extract --loads-only");
}

/// Solves the missing blocks from `first` to `end`.
void solve_blocks(const StudyBlocks& blocks, int first, int end, bool quiet, Samples& samples, std::ostream& log) {
  int there = 0;
  program::report_share(0);
  for (int block = first; block < end; ++block) {
    if (blocks.has(block))
      ++there;
    else
      samples.solve_block(blocks, block);
    program::report_share(double(block + 1 - first) / double(end - first));
  }
  if (there > 0 && !quiet)
    log << fmt::format("{}: {} of {} blocks of samples were there already\n", program_name, there, end - first);
}

/// A merge removes the blocks after it has written the study, so that a study that is there may be whole.
void check_all_there(const StudyBlocks& blocks, const std::string& output) {
  const std::string missing = blocks.missing();
  if (missing.empty()) return;
  const std::string may_be_made =
      std::filesystem::exists(output)
          ? fmt::format("; {} is there: another merge may have made it of these samples, and removed them", output)
          : "";
  throw InputError(fmt::format("{}: lacks samples {}; allowed: all of them (run the slices that make them){}",
                               blocks.folder(), missing, may_be_made));
}

/// Writes STUDY.h5 from all blocks, and returns the summary.
std::string merge(const Study& study, const StudyContext& context, const StudyBlocks& blocks,
                  formats::StudyOrigin origin, const std::string& output, program::Timings& timings) {
  check_all_there(blocks, output);
  timings.phase("statistics");
  auto result = study_statistics(context, blocks);
  const std::string& name = study.scene.name.empty() ? study.joint.name : study.scene.name;
  result.header = {program::generator(program_name), name, context.units, study.joint_text.text};
  result.origin = std::move(origin);
  result.sampling = sampling_names[std::size_t(study.scene.sampling)];
  timings.phase("write");
  const std::string failures = failures_text(blocks);
  formats::write(output, result, [&](h5::Writer& file) { write_samples(file, context, blocks); });
  blocks.remove();
  return study_summary(result, study.scene, failures);
}

}  // namespace

void run_study(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings) {
  timings.phase("read");
  const Slice slice = read_slice(arguments);
  const bool merge_only = arguments.flag("--merge"), one_sample = arguments.flag("--sample");
  const int threads = program::threads_that_fit(
      arguments.integer("--threads", 1, 1024, int(std::max(1U, std::thread::hardware_concurrency()))));
  linalg::set_threads(threads);
  timings.set_threads(threads);
  const Study study = read_study(arguments);
  SampledJoint sampled(study.joint_text, study.scene, study.joint);
  const std::uint64_t seed = seed_of(arguments, study.scene, slice.is_whole && !merge_only && !one_sample, log);
  if (one_sample) {
    const int sample = arguments.integer("--sample", 0, int(study.scene.n_samples) - 1, 0);
    h5::write_whole_file(arguments.output, sampled.text(sample_values(study.scene, seed, sample), arguments.output));
    return;
  }
  require_memory_to_read(study.joint);
  const JointScene rubbing = with_all_friction(study, sampled);
  JointModel joint = load_studied(arguments, study, rubbing);
  const Parameters parameters = parameters_of(joint, rubbing, rubbing.cases.front());
  const formats::StudyOrigin origin = origin_of(study, joint, seed);
  StudyOutputs outputs(joint, parameters, study.joint, study.scene);
  const StudyBlocks blocks(arguments.output, origin, study.scene.n_samples, outputs.size());
  blocks.check();
  const auto cases = studied_cases(study);
  require_memory(study, joint, parameters, outputs, threads);
  if (merge_only) check_all_there(blocks, arguments.output);
  timings.phase("solve");
  const JointScene middle_scene = sampled.scene(middle_values(study.scene));
  if (slice.is_whole)
    for (const auto& some : {middle_warnings(joint, middle_scene, cases), outputs.left_out().warnings(study.joint)})
      for (const auto& each : some) program::warn(log, program_name, each);
  for (auto& plate : joint.plates) {
    plate.peaks_alone = true;
    if (!outputs.need_stresses()) plate.stress_level.reset();
  }
  const StudySolver solver(joint, middle_scene, cases, std::move(outputs));
  Samples samples(study, seed, solver);
  const auto [first, end] = blocks.of_slice(slice.number, slice.n);
  if (!merge_only) solve_blocks(blocks, first, end, arguments.quiet, samples, log);
  const std::string summary =
      slice.is_whole
          ? merge(study, {study.scene, seed, solver.outputs(), joint.units, solver.middle(), samples.sensitivity()},
                  blocks, origin, arguments.output, timings)
          : fmt::format("{} of {} blocks of samples are in {}; --merge makes {} of all slices\n", end - first,
                        blocks.n_blocks(), blocks.folder(), arguments.output);
  if (!arguments.quiet) out << summary;
}

}  // namespace fastjoint::stage3
