// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/run_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <mutex>
#include <ostream>
#include <random>
#include <thread>
#include <utility>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/linalg/processor.hpp"
#include "common/program/progress.hpp"
#include "common/program/warning.hpp"
#include "stage3_nonlinear/output/output.hpp"
#include "stage3_nonlinear/results/increments.hpp"
#include "stage3_nonlinear/study/sampled_joint.hpp"
#include "stage3_nonlinear/study/study_solver.hpp"
#include "stage3_nonlinear/study/study_statistics.hpp"
#include "stage3_nonlinear/study/study_summary.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr const char* program_name = "stage3_nonlinear";
constexpr std::array sampling_names{"grid", "random", "latin hypercube"};

struct Slice {
  int number = 1, n = 1;
  bool is_whole = true;
};

/// "3/20"
Slice read_slice(const std::string& text) {
  if (text.empty()) return {};
  Slice slice{0, 0, false};
  char rest = 0;
  const bool reads = std::sscanf(text.c_str(), "%d/%d%c", &slice.number, &slice.n, &rest) == 2;
  if (!reads || slice.n < 1 || slice.number < 1 || slice.number > slice.n)
    throw InputError(fmt::format("--slice: \"{}\"; allowed: i/n with i from 1 to n", text));
  return slice;
}

/// The study and the joint that it varies.
struct Study {
  input::Document joint_text, study_text;
  JointScene joint;
  StudyScene scene;
};

Study read_study(const program::Arguments& arguments) {
  const std::string study_file = arguments.text("--study");
  program::check_spare("-o", arguments.output, study_file, "the study");
  program::check_spare("--timings", arguments.timings, study_file, "the study");
  Study study;
  study.joint_text = input::parse(arguments.input, input::read_text_file(arguments.input));
  study.study_text = input::parse(study_file, input::read_text_file(study_file));
  study.joint = read_joint_scene(study.joint_text);
  study.scene = read_study_scene(study.study_text, study.joint_text);
  for (const auto& plate : study.joint.plates)
    program::check_spare("-o", arguments.output, plate.file, fmt::format("a file that {} reads", arguments.input));
  return study;
}

std::vector<double> middle_values(const StudyScene& study) {
  std::vector<double> values;
  for (const auto& variable : study.variables) values.push_back(middle_of(variable));
  return values;
}

/// The joint with friction wherever a sample may have some, which the condensed joint must know of.
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
  for (const auto& plate : joint.plates) {
    origin.file.push_back(fmt::format("matrices of plate {}", plate.name));
    origin.digest.push_back(plate.matrices_digest);
  }
  for (const auto& [name, law] : study.joint.laws)
    if (!law.law->file().empty()) {
      origin.file.push_back(fmt::format("file of law {}", name));
      origin.digest.push_back(h5::digest(law.law->file()));
    }
  for (const auto& variable : study.scene.variables)
    if (!variable.table.empty()) {
      origin.file.push_back(fmt::format("table of {}", variable.name));
      origin.digest.push_back(h5::digest(variable.table));
    }
  return origin;
}

std::uint64_t seed_of(const program::Arguments& arguments, const StudyScene& study, bool may_draw, std::ostream& log) {
  if (study.seed) return *study.seed;
  if (const auto before = StudyBlocks::seed_in(arguments.output)) return std::stoull(*before);
  if (study.sampling == Sampling::grid) return 0;
  if (!may_draw)
    throw InputError(
        fmt::format("{}: /: no \"seed\"; allowed: a seed, without which slices would not be of one study", study.file));
  const std::uint64_t seed = std::random_device()() & std::uint32_t(std::numeric_limits<int>::max());
  log << fmt::format("{}: the study's seed is {}; \"seed\": {} in {} repeats it\n", program_name, seed, seed,
                     study.file);
  return seed;
}

/// Samples of a study on all threads.
class Samples {
 public:
  Samples(const Study& study, std::uint64_t seed, const JointModel& joint, const StudySolver& solver)
      : study_(study), seed_(seed), joint_(joint), solver_(solver), middle_(middle_values(study.scene)) {
    find_slopes();
  }
  /// (columns, v) change of each number with each variable in the middle; infinite if not known.
  [[nodiscard]] const MatrixXd& sensitivity() const { return slopes_; }

  /// Numbers of the joint with values of the variables.
  SampleNumbers of_values(const std::vector<double>& values) {
    auto sampled = take();
    SampleNumbers result;
    try {
      result = solver_.solve(parameters_of(joint_, sampled->scene(values)), away(values));
    } catch (const InputError&) {
      result = solver_.nothing(SampleStatus::refused);
    }
    give(std::move(sampled));
    return result;
  }

  void solve_block(const StudyBlocks& blocks, int block) {
    const std::uint64_t first = blocks.first(block);
    const Index n = Index(blocks.end(block) - first);
    Eigen::VectorXi status(n);
    formats::StudyRows values(n, solver_.names().size());
    linalg::for_each_index(n, [&](std::size_t i) {
      const auto numbers = of_values(sample_values(study_.scene, seed_, first + i));
      const Index row = Index(i);
      status[row] = int(numbers.status);
      values.row(row) = numbers.status == SampleStatus::solved
                            ? Eigen::RowVectorXd(numbers.all.transpose())
                            : Eigen::RowVectorXd::Constant(values.cols(), std::numeric_limits<double>::infinity());
    });
    blocks.write(block, std::move(status), std::move(values));
  }

 private:
  /// Finds the changes of all numbers, and of the contact coordinates, with each variable in the middle, by central
  /// differences.
  void find_slopes() {
    const Index v = std::ssize(middle_);
    slopes_.resize(solver_.names().size(), v);
    MatrixXd c_slopes = MatrixXd::Zero(solver_.middle().c.size(), v);
    linalg::for_each_index(v, [&](std::size_t i) {
      constexpr double part = 1e-3;
      const Index column = Index(i);
      const double step = part * spread_of(study_.scene.variables[i]);
      auto values = middle_;
      values[i] += step;
      const auto above = of_values(values);
      values[i] -= 2 * step;
      const auto below = of_values(values);
      const bool known = above.status == SampleStatus::solved && below.status == SampleStatus::solved;
      if (known && step > 0 && c_slopes.rows() > 0) c_slopes.col(column) = (above.c - below.c) / (2 * step);
      slopes_.col(column) = step == 0 ? VectorXd::Zero(slopes_.rows())
                            : known   ? VectorXd((above.all - below.all) / (2 * step))
                                      : VectorXd::Constant(slopes_.rows(), std::numeric_limits<double>::infinity());
    });
    c_slopes_ = std::move(c_slopes);
  }

  /// Change of the contact coordinates from the middle to values of the variables, by these slopes; empty before.
  [[nodiscard]] VectorXd away(const std::vector<double>& values) const {
    if (c_slopes_.size() == 0) return {};
    return c_slopes_ *
           (VectorXd::Map(values.data(), std::ssize(values)) - VectorXd::Map(middle_.data(), std::ssize(middle_)));
  }
  /// A joint for one thread at a time.
  std::unique_ptr<SampledJoint> take() {
    const std::lock_guard lock(mutex_);
    if (spare_.empty()) return std::make_unique<SampledJoint>(study_.joint_text, study_.scene, study_.joint);
    auto result = std::move(spare_.back());
    spare_.pop_back();
    return result;
  }
  void give(std::unique_ptr<SampledJoint> sampled) {
    const std::lock_guard lock(mutex_);
    spare_.push_back(std::move(sampled));
  }

  const Study& study_;
  std::uint64_t seed_;
  const JointModel& joint_;
  const StudySolver& solver_;
  std::vector<double> middle_;
  MatrixXd slopes_, c_slopes_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<SampledJoint>> spare_;
};

/// Warnings about the joint whose variables are in the middle, as a run of its own has them.
std::vector<program::Warning> middle_warnings(const JointModel& joint, const JointScene& scene,
                                              const Parameters& middle) {
  const JointEquations equations =
      make_equations(joint, std::make_shared<const CondensedSystem>(condense(joint)), middle);
  const PathOptions solving{scene.initial, scene.solver};
  const auto [path, increments] =
      follow_with_results(joint, equations, scene.wanted_load_factors(), solving, {scene.solver.tolerance});
  std::vector<program::Warning> all = scene.warnings;
  for (const auto& some : {warnings(joint, equations, path), implausible_numbers(scene, joint, path),
                           rim_warnings(joint, increments.states)})
    all.insert(all.end(), some.begin(), some.end());
  for (auto& each : all) each.text += " (with every variable of the study in its middle)";
  return all;
}

/// The first samples that failed, and how to see one.
std::string failures_text(const StudyBlocks& blocks) {
  constexpr std::size_t most = 5;
  std::vector<std::uint64_t> failed;
  for (int block = 0; block < blocks.n_blocks() && failed.size() < most; ++block) {
    const auto its = blocks.read(block);
    for (Index i = 0; i < its.status.size() && failed.size() < most; ++i)
      if (its.status[i] != 0) failed.push_back(blocks.first(block) + i);
  }
  if (failed.empty()) return {};
  return fmt::format("the first are {}; --sample {} -o FILE.json writes that joint", fmt::join(failed, ", "),
                     failed[0]);
}

}  // namespace

void run_study(const program::Arguments& arguments, std::ostream& out, std::ostream& log, program::Timings& timings) {
  timings.phase("read");
  const Slice slice = read_slice(arguments.text("--slice"));
  const bool merge_only = arguments.flag("--merge");
  const int threads = arguments.integer("--threads", 1, 1024, int(std::max(1U, std::thread::hardware_concurrency())));
  linalg::set_threads(threads);
  timings.set_threads(threads);
  Study study = read_study(arguments);
  SampledJoint sampled(study.joint_text, study.scene, study.joint);
  const bool one_sample = arguments.flag("--sample");
  const std::uint64_t seed = seed_of(arguments, study.scene, slice.is_whole && !merge_only && !one_sample, log);
  if (one_sample) {
    const int sample = arguments.integer("--sample", 0, int(study.scene.n_samples) - 1, 0);
    h5::write_whole_file(arguments.output, sampled.text(sample_values(study.scene, seed, sample), arguments.output));
    return;
  }
  JointModel joint =
      load_joint(with_all_friction(study, sampled), arguments.integer("--p", 1, formats::highest_degree, 0));
  timings.phase("solve");
  const JointScene middle_scene = sampled.scene(middle_values(study.scene));
  const Parameters middle = parameters_of(joint, middle_scene);
  if (slice.is_whole)
    for (const auto& each : middle_warnings(joint, middle_scene, middle)) program::warn(log, program_name, each);
  for (auto& plate : joint.plates) {  // what takes time and no study tells
    plate.peaks_alone = true;
    if (!study.scene.peaks) plate.stress_level.reset();
  }
  const StudySolver solver(joint, study.joint, middle, study.scene.peaks, study.scene.displacements);
  const StudyBlocks blocks(arguments.output, origin_of(study, joint, seed), study.scene.n_samples,
                           solver.names().size());
  Samples samples(study, seed, joint, solver);
  const auto [first, end] = merge_only ? std::pair(0, 0) : blocks.of_slice(slice.number, slice.n);
  int there = 0;
  program::report_share(0);
  for (int block = first; block < end; ++block) {
    if (blocks.has(block))
      ++there;
    else
      samples.solve_block(blocks, block);
    program::report_share(double(block + 1 - first) / double(end - first));
  }
  if (there > 0 && !arguments.quiet)
    log << fmt::format("{}: {} of {} blocks of samples were there already\n", program_name, there, end - first);
  if (!slice.is_whole) {
    if (!arguments.quiet)
      out << fmt::format("samples {} to {} are in {}; --merge makes {} of all slices\n", blocks.first(first),
                         end > first ? blocks.end(end - 1) - 1 : blocks.first(first), blocks.folder(),
                         arguments.output);
    return;
  }
  if (const std::string missing = blocks.missing(); !missing.empty())
    throw InputError(fmt::format("{}: lacks samples {}; allowed: all of them (run the slices that make them)",
                                 blocks.folder(), missing));
  timings.phase("statistics");
  const StudyContext context{study.scene, seed, solver.names(), joint.units, solver.middle(), samples.sensitivity()};
  auto result = study_statistics(context, blocks);
  result.header = {program::generator(program_name), study.scene.name.empty() ? study.joint.name : study.scene.name,
                   joint.units, study.joint_text.text};
  result.origin = origin_of(study, joint, seed);
  result.sampling = sampling_names[std::size_t(study.scene.sampling)];
  timings.phase("write");
  const std::string failures = failures_text(blocks);
  formats::write(arguments.output, result, [&](h5::Writer& file) { write_samples(file, context, blocks); });
  blocks.remove();
  if (!arguments.quiet) out << study_summary(result, failures);
}

}  // namespace fastjoint::stage3
