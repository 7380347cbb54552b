// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_statistics.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "stage3_nonlinear/study/statistics.hpp"

namespace fastjoint::stage3 {
namespace {

constexpr std::uint64_t max_at_once = 32'000'000;  ///< numbers of samples in memory, 256 MB

/// Number of samples for the rank correlations of a given number of results: their error is 1 over its square root.
std::uint64_t max_ranked(std::size_t n_numbers) {
  constexpr std::uint64_t max_samples = 100000, min_samples = 10000, of_all = 20000000;
  return std::clamp(of_all / n_numbers, min_samples, max_samples);
}

/// Numbers whose statistics stand in one group of STUDY.h5: those of a kind of outputs, or the largest of all of them.
struct Group {
  std::string name, meaning;
  std::vector<std::string> of;
  const OutputKind* kind;
  bool is_largest;
};

std::vector<Group> groups_of(const StudyOutputs& outputs) {
  std::vector<Group> groups;
  for (const auto& kind : outputs.kinds()) {
    const auto& [name, asked, meaning, largest, is_magnitude] = kind.output;
    groups.push_back({name, meaning, kind.of, &kind, false});
    if (largest != nullptr)
      groups.push_back({std::string("largest_") + name, largest, {std::string("largest ") + name}, &kind, true});
  }
  return groups;
}

/// Values of a group in the row of a sample.
VectorXd of_group(const Group& group, const Eigen::Ref<const Eigen::RowVectorXd>& row) {
  const auto part = row.segment(group.kind->first, std::ssize(group.kind->of));
  return group.is_largest ? VectorXd::Constant(1, part.maxCoeff()) : VectorXd(part.transpose());
}

/// Calls each(sample, row) for all solved samples, in their order.
template <class Each>
void for_each_solved(const StudyBlocks& blocks, Each each) {
  for (int block = 0; block < blocks.n_blocks(); ++block) {
    const auto its = blocks.read(block);
    for (Index i = 0; i < its.status.size(); ++i)
      if (its.status[i] == 0) each(blocks.first(block) + i, its.values.row(i));
  }
}

class Statistics {
 public:
  Statistics(const StudyContext& context, const StudyBlocks& blocks)
      : a_(context), blocks_(blocks), groups_(groups_of(context.outputs)) {
    std::size_t n_numbers = a_.study.variables.size();
    for (const auto& group : groups_) n_numbers += group.of.size();
    n_ranked_ = max_ranked(n_numbers);
  }

  formats::StudyResult make() {
    result_.n_samples = a_.study.n_samples;
    result_.n_status = Eigen::VectorXi::Zero(4);
    for (int block = 0; block < blocks_.n_blocks(); ++block)
      for (const int status : blocks_.read(block).status) ++result_.n_status[status];
    solved_ = result_.n_status[0];
    failed_ = a_.study.n_samples - solved_;
    for (const double fraction : quantile_levels) quantiles_.push_back(quantile_ranks(fraction, solved_, failed_));
    gather_variables();
    for (const auto& group : groups_) gather(group);
    return std::move(result_);
  }

 private:
  void gather_variables() {
    const Index v = std::ssize(a_.study.variables);
    result_.middle.resize(v), result_.mean.resize(v), result_.deviation.resize(v);
    std::vector<std::vector<double>> all(v), ranked(v);
    for (std::uint64_t sample = 0; sample < a_.study.n_samples; ++sample) {
      const auto values = sample_values(a_.study, a_.seed, sample);
      for (Index i = 0; i < v; ++i) all[i].push_back(values[i]);
    }
    for_each_solved(blocks_, [&](std::uint64_t sample, const auto&) {
      for (Index i = 0; i < v; ++i)
        if (ranked[i].size() < n_ranked_) ranked[i].push_back(all[i][sample]);
    });
    for (Index i = 0; i < v; ++i) {
      const Variable& variable = a_.study.variables[i];
      result_.variable.push_back(variable.name);
      result_.place.push_back(fmt::format("{}", fmt::join(variable.places, " ")));
      result_.middle[i] = middle_of(variable);
      const auto [mean, deviation] = moments_of(all[i]);
      result_.mean[i] = mean, result_.deviation[i] = deviation;
      variable_ranks_.push_back(ranks_of(ranked[i]));
    }
  }

  void gather(const Group& its) {
    const Index n = std::ssize(its.of), v = std::ssize(a_.study.variables), levels = std::ssize(quantile_levels);
    formats::StudyGroup& group = result_.groups.emplace_back();
    group.name = its.name, group.unit = unit_of(its.kind->dimension, a_.units), group.of = its.of;
    const std::vector<double>& limits = its.kind->limit;
    const bool is_one = std::ranges::adjacent_find(limits, std::ranges::not_equal_to()) == limits.end();
    group.limit = is_one ? limits[0] : infinite;
    group.limits = its.is_largest ? VectorXd::Constant(1, group.limit) : VectorXd(VectorXd::Map(limits.data(), n));
    for (VectorXd* each : {&group.middle, &group.mean, &group.deviation, &group.by_sensitivities, &group.exceeds,
                           &group.exceeds_low, &group.exceeds_high})
      each->resize(n);
    group.governs = VectorXd::Zero(n);
    if (group.name == "K_I") group.closed.resize(n);
    group.sensitivity.resize(n, v), group.correlation.resize(n, v);
    group.quantile = MatrixXd::Constant(n, levels, infinite);
    group.low = -group.quantile, group.high = group.quantile;
    const bool has_middle = a_.middle.status == SampleStatus::solved;
    group.middle = has_middle ? of_group(its, a_.middle.all.transpose()) : VectorXd::Constant(n, infinite);
    const auto at_once = Index(std::max<std::uint64_t>(1, max_at_once / std::max<std::uint64_t>(solved_, 1)));
    for (Index first = 0; first < n; first += at_once) {
      std::vector<std::vector<double>> columns(std::min(at_once, n - first));
      for (auto& column : columns) column.reserve(solved_);
      for_each_solved(blocks_, [&](std::uint64_t, const auto& row) {
        const VectorXd values = of_group(its, row);
        for (std::size_t i = 0; i < columns.size(); ++i) columns[i].push_back(values[first + Index(i)]);
        Index largest = 0;
        if (first == 0) values.maxCoeff(&largest), ++group.governs[largest];
      });
      for (std::size_t i = 0; i < columns.size(); ++i) describe(its, first + Index(i), columns[i], group);
    }
    group.governs /= double(std::max<std::uint64_t>(solved_, 1));
  }

  /// Statistics of the i-th number of a group. @param values Of the solved samples; are sorted.
  void describe(const Group& its, Index i, std::vector<double>& values, formats::StudyGroup& group) const {
    const auto [mean, of_samples] = moments_of(values);
    group.mean[i] = mean, group.deviation[i] = of_samples;
    const auto n_ranked = std::ptrdiff_t(std::min<std::uint64_t>(values.size(), n_ranked_));
    const auto ranks = ranks_of({values.begin(), values.begin() + n_ranked});
    group.sensitivity.row(i) = sensitivity_of(its, i);
    const Eigen::RowVectorXd slope = group.sensitivity.row(i), deviation = result_.deviation.transpose();
    group.by_sensitivities[i] =  // a deviation may be infinite, also of a variable without influence
        slope.allFinite() ? (slope.array() == 0).select(0, slope.cwiseProduct(deviation)).norm() : infinite;
    for (Index k = 0; k < group.correlation.cols(); ++k)
      group.correlation(i, k) = rank_correlation(ranks, variable_ranks_[k]);
    std::ranges::sort(values);
    const auto above = std::uint64_t(values.end() - std::ranges::upper_bound(values, group.limits[i]));
    if (group.closed.size() > 0)
      group.closed[i] =
          double(std::ranges::lower_bound(values, 0.0) - values.begin()) / double(std::max<std::uint64_t>(solved_, 1));
    Proportion fraction = proportion(above, solved_, failed_);
    if (is_grid() || std::isinf(group.limits[i])) fraction.low = fraction.high = fraction.value;
    group.exceeds[i] = fraction.value, group.exceeds_low[i] = fraction.low, group.exceeds_high[i] = fraction.high;
    if (solved_ == 0) return;
    for (std::size_t k = 0; k < quantiles_.size(); ++k) {
      const auto& [at, low, high] = quantiles_[k];
      group.quantile(i, Index(k)) = values[at - 1];
      if (is_grid()) continue;  // a grid is not random and has no confidence limits
      if (low >= 1) group.low(i, Index(k)) = values[low - 1];
      if (high <= solved_) group.high(i, Index(k)) = values[high - 1];
    }
  }

  /// Sensitivities of a number; for the largest of some they are those of the one that is largest in the middle.
  [[nodiscard]] Eigen::RowVectorXd sensitivity_of(const Group& group, Index i) const {
    const auto& [output, dimension, of, first, its_limits] = *group.kind;
    if (a_.middle.status != SampleStatus::solved)
      return Eigen::RowVectorXd::Constant(std::ssize(a_.study.variables), infinite);
    if (group.is_largest) a_.middle.all.segment(first, std::ssize(of)).maxCoeff(&i);
    return a_.sensitivity.row(first + i);
  }

  [[nodiscard]] bool is_grid() const { return a_.study.sampling == Sampling::grid; }

  const StudyContext& a_;
  const StudyBlocks& blocks_;
  std::vector<Group> groups_;
  std::uint64_t n_ranked_, solved_ = 0, failed_ = 0;
  std::vector<QuantileRanks> quantiles_{};
  std::vector<std::vector<double>> variable_ranks_{};
  formats::StudyResult result_{};
};

}  // namespace

double statistics_need(const StudyScene& study, const StudyOutputs& outputs) {
  const double v = double(study.variables.size()), n = double(study.n_samples), all = double(outputs.size());
  constexpr double ranks = 3, copies = 4,
                   of_block = 8192;  // of a column; of a block: its file, rows and what is written
  const double at_once = std::max(n, std::min(all * n, double(max_at_once)));
  return sizeof(double) * (at_once + (v + ranks) * n + copies * (v * all + std::min(n, of_block) * (all + v)));
}

formats::StudyResult study_statistics(const StudyContext& context, const StudyBlocks& blocks) {
  return Statistics(context, blocks).make();
}

void write_samples(h5::Writer& file, const StudyContext& a, const StudyBlocks& blocks) {
  const Index n = Index(a.study.n_samples), v = std::ssize(a.study.variables);
  const auto groups = groups_of(a.outputs);
  file.make_rows<int>("samples/status", {n}, "1", "0 solved, 1 refused, 2 not solved, 3 out of balance");
  file.make_rows<double>("samples/variable", {n, v}, "1", "value of each variable");
  for (const auto& group : groups) {
    h5::Shape shape{n};
    if (!group.is_largest) shape.push_back(std::ssize(group.of));
    file.make_rows<double>("samples/" + group.name, shape, unit_of(group.kind->dimension, a.units),
                           group.meaning + "; NaN where the sample was not solved");
  }
  for (int block = 0; block < blocks.n_blocks(); ++block) {
    const auto its = blocks.read(block);
    const std::uint64_t first = blocks.first(block);
    const Index k = its.status.size();
    file.rows("samples/status", first, std::span<const int>(its.status.data(), k));
    formats::StudyRows variables(k, v);
    for (Index i = 0; i < k; ++i)
      variables.row(i) = VectorXd::Map(sample_values(a.study, a.seed, first + i).data(), v).transpose();
    file.rows("samples/variable", first, std::span<const double>(variables.data(), variables.size()));
    for (const auto& group : groups) {
      formats::StudyRows rows(k, std::ssize(group.of));
      for (Index i = 0; i < k; ++i)
        rows.row(i) = its.status[i] == 0
                          ? Eigen::RowVectorXd(of_group(group, its.values.row(i)).transpose())
                          : Eigen::RowVectorXd::Constant(rows.cols(), std::numeric_limits<double>::quiet_NaN());
      file.rows("samples/" + group.name, first, std::span<const double>(rows.data(), rows.size()));
    }
  }
}

}  // namespace fastjoint::stage3
