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

/// Number of samples for the rank correlations of a given number of results: their error is 1 over its square root.
std::uint64_t max_ranked(std::size_t n_numbers) {
  constexpr std::uint64_t max_samples = 100000, min_samples = 10000, of_all = 20000000;
  return std::clamp(of_all / n_numbers, min_samples, max_samples);
}

/// Results of one kind: columns of the samples, or the largest of some columns.
struct Kind {
  const char* name;
  const char* meaning;
  std::string unit;
  std::vector<std::string> of;
  Index first, n;
  bool is_largest;
  double limit = infinite;
};

std::vector<Kind> kinds_of(const StudyContext& a) {
  const std::string force = unit(a.units, 0, 1), stress = unit(a.units, -2, 1), length = unit(a.units, 1, 0);
  const Index f = std::ssize(a.names.force), r = std::ssize(a.names.peak), d = std::ssize(a.names.displacement);
  const Index t = std::ssize(a.names.crack);
  const double max_force = a.study.max_force.value_or(infinite), max_peak = a.study.max_peak.value_or(infinite);
  std::vector<Kind> kinds{
      {"force", "load that each fastener transfers", force, a.names.force, 0, f, false, max_force},
      {"largest_force", "largest transferred load of all", force, {"largest force"}, 0, f, true, max_force}};
  if (r > 0) {
    kinds.push_back({"peak", "largest hoop stress at each hole", stress, a.names.peak, f, r, false, max_peak});
    kinds.push_back({"largest_peak", "largest hoop stress of all", stress, {"largest peak"}, f, r, true, max_peak});
  }
  if (d > 0)
    kinds.push_back(
        {"displacement", "displacement of each rigid external", length, a.names.displacement, f + r, d, false});
  if (t > 0) {
    const std::string intensity = unit(a.units, -1.5, 1);
    const Index K_I = f + r + d;
    const double max_K_I = a.study.max_K_I.value_or(infinite);
    kinds.push_back({"K_I", "K_I of each crack tip", intensity, a.names.crack, K_I, t, false, max_K_I});
    kinds.push_back({"largest_K_I", "largest K_I of all", intensity, {"largest K_I"}, K_I, t, true, max_K_I});
    kinds.push_back({"K_II", "K_II of each crack tip", intensity, a.names.crack, K_I + t, t, false});
  }
  return kinds;
}

/// Values of a kind in the row of a sample.
VectorXd of_kind(const Kind& kind, const Eigen::Ref<const Eigen::RowVectorXd>& row) {
  const auto part = row.segment(kind.first, kind.n);
  return kind.is_largest ? VectorXd::Constant(1, part.maxCoeff()) : VectorXd(part.transpose());
}

/// Statistics of one number.
struct Gathered {
  Moments moments;
  std::uint64_t above = 0, governs = 0, negative = 0;
  std::vector<double> ranked{};
};

/// Calls each(sample, row) for all solved samples, in their order.
template <class Each>
void for_each_solved(const StudyBlocks& blocks, Each each) {
  for (int block = 0; block < blocks.n_blocks(); ++block) {
    const auto its = blocks.read(block);
    for (Index i = 0; i < its.status.size(); ++i)
      if (its.status[i] == 0) each(blocks.first(block) + i, its.values.row(i));
  }
}

/// Sensitivities of a number; for the largest of some they are those of the one that is largest in the middle.
Eigen::RowVectorXd sensitivity_of(const StudyContext& a, const Kind& kind, Index i) {
  Index at = kind.first + i;
  if (kind.is_largest) {
    a.middle.all.segment(kind.first, kind.n).maxCoeff(&at);
    at += kind.first;
  }
  return a.sensitivity.row(at);
}

class Statistics {
 public:
  Statistics(const StudyContext& context, const StudyBlocks& blocks)
      : a_(context), blocks_(blocks), kinds_(kinds_of(context)), variables_(context.study.variables.size()) {
    for (const auto& kind : kinds_) all_.emplace_back(kind.of.size());
  }

  formats::StudyResult make() {
    gather_variables();
    gather();
    for (std::size_t g = 0; g < kinds_.size(); ++g) make_group(g);
    select();
    return std::move(result_);
  }

 private:
  void gather_variables() {
    const Index v = std::ssize(variables_);
    result_.middle.resize(v), result_.mean.resize(v), result_.deviation.resize(v);
    result_.n_samples = a_.study.n_samples;
    for (std::uint64_t sample = 0; sample < a_.study.n_samples; ++sample) {
      const auto values = sample_values(a_.study, a_.seed, sample);
      for (Index i = 0; i < v; ++i) variables_[i].moments.add(values[i]);
    }
    for (Index i = 0; i < v; ++i) {
      const Variable& variable = a_.study.variables[i];
      result_.variable.push_back(variable.name);
      result_.place.push_back(fmt::format("{}", fmt::join(variable.places, " ")));
      result_.middle[i] = middle_of(variable);
      result_.mean[i] = variables_[i].moments.mean();
      result_.deviation[i] = variables_[i].moments.deviation();
    }
  }

  void gather() {
    result_.n_status = Eigen::VectorXi::Zero(4);
    for (int block = 0; block < blocks_.n_blocks(); ++block)
      for (const int status : blocks_.read(block).status) ++result_.n_status[status];
    solved_ = result_.n_status[0];
    failed_ = a_.study.n_samples - solved_;
    std::size_t n_numbers = variables_.size();
    for (const auto& kind : kinds_) n_numbers += kind.of.size();
    std::uint64_t ranked = 0;
    for_each_solved(blocks_, [&](std::uint64_t sample, const auto& row) {
      const bool is_ranked = ranked++ < max_ranked(n_numbers);
      for (std::size_t g = 0; g < kinds_.size(); ++g) {
        const VectorXd values = of_kind(kinds_[g], row);
        for (Index i = 0; i < values.size(); ++i) {
          all_[g][i].moments.add(values[i]);
          all_[g][i].above += values[i] > kinds_[g].limit ? 1 : 0;
          all_[g][i].negative += values[i] < 0 ? 1 : 0;
          if (is_ranked) all_[g][i].ranked.push_back(values[i]);
        }
        Index at = 0;
        values.maxCoeff(&at);
        ++all_[g][at].governs;
      }
      if (!is_ranked) return;
      const auto values = sample_values(a_.study, a_.seed, sample);
      for (std::size_t i = 0; i < values.size(); ++i) variables_[i].ranked.push_back(values[i]);
    });
    for (auto& each : variables_) each.ranked = ranks_of(each.ranked);
  }

  void make_group(std::size_t g) {
    const Kind& kind = kinds_[g];
    const Index n = std::ssize(kind.of), v = std::ssize(variables_);
    formats::StudyGroup& group = result_.groups.emplace_back();
    group.name = kind.name, group.unit = kind.unit, group.of = kind.of;
    group.limit = kind.limit;
    for (VectorXd* each : {&group.middle, &group.mean, &group.deviation, &group.by_sensitivities, &group.exceeds,
                           &group.exceeds_low, &group.exceeds_high, &group.governs})
      each->resize(n);
    if (group.name == "K_I") group.closed.resize(n);
    group.sensitivity.resize(n, v), group.correlation.resize(n, v);
    const bool has_middle = a_.middle.status == SampleStatus::solved;
    group.middle = has_middle ? of_kind(kind, a_.middle.all.transpose()) : VectorXd::Constant(n, infinite);
    for (Index i = 0; i < n; ++i) {
      Gathered& each = all_[g][i];
      group.mean[i] = each.moments.mean(), group.deviation[i] = each.moments.deviation();
      group.sensitivity.row(i) = has_middle ? sensitivity_of(a_, kind, i) : Eigen::RowVectorXd::Constant(v, infinite);
      const Eigen::RowVectorXd slope = group.sensitivity.row(i), deviation = result_.deviation.transpose();
      group.by_sensitivities[i] =  // a deviation may be infinite, also of a variable without influence
          slope.allFinite() ? (slope.array() == 0).select(0, slope.cwiseProduct(deviation)).norm() : infinite;
      const auto ranks = ranks_of(each.ranked);
      each.ranked.clear();
      for (Index k = 0; k < v; ++k) group.correlation(i, k) = rank_correlation(ranks, variables_[k].ranked);
      group.governs[i] = solved_ > 0 ? double(each.governs) / double(solved_) : 0;
      if (group.closed.size() > 0) group.closed[i] = solved_ > 0 ? double(each.negative) / double(solved_) : 0;
      Proportion fraction = proportion(each.above, solved_, failed_);
      if (is_grid() || std::isinf(kind.limit)) fraction.low = fraction.high = fraction.value;
      group.exceeds[i] = fraction.value, group.exceeds_low[i] = fraction.low, group.exceeds_high[i] = fraction.high;
    }
  }

  /// Finds the quantiles of all numbers, and their limits.
  void select() {
    constexpr Index n = std::ssize(quantile_levels);
    for (auto& group : result_.groups) {
      group.quantile = MatrixXd::Constant(std::ssize(group.of), n, infinite);
      group.low = -group.quantile, group.high = group.quantile;
    }
    if (solved_ == 0) return;
    std::vector<std::uint64_t> ranks;
    std::vector<QuantileRanks> of_level;
    for (const double fraction : quantile_levels) {
      const auto& its = of_level.emplace_back(quantile_ranks(fraction, solved_, failed_));
      for (const std::uint64_t rank : {its.at, its.low, its.high})
        ranks.push_back(std::clamp<std::uint64_t>(rank, 1, solved_));
    }
    std::vector<std::vector<Selection>> selections;
    for (const auto& kind : kinds_) selections.emplace_back(kind.of.size(), Selection(ranks));
    for (int pass = 0; pass < Selection::n_passes; ++pass) {
      for_each_solved(blocks_, [&](std::uint64_t, const auto& row) {
        for (std::size_t g = 0; g < kinds_.size(); ++g) {
          const VectorXd values = of_kind(kinds_[g], row);
          for (Index i = 0; i < values.size(); ++i) selections[g][i].add(values[i]);
        }
      });
      for (auto& of_group : selections)
        for (auto& each : of_group) each.next();
    }
    for (std::size_t g = 0; g < kinds_.size(); ++g)
      for (Index i = 0; i < std::ssize(kinds_[g].of); ++i) {
        const auto found = selections[g][i].found();
        for (Index k = 0; k < n; ++k) {
          result_.groups[g].quantile(i, k) = found[3 * k];
          if (is_grid()) continue;  // a grid is not random and has no confidence limits
          if (of_level[k].low >= 1) result_.groups[g].low(i, k) = found[3 * k + 1];
          if (of_level[k].high <= solved_) result_.groups[g].high(i, k) = found[3 * k + 2];
        }
      }
  }

  [[nodiscard]] bool is_grid() const { return a_.study.sampling == Sampling::grid; }

  const StudyContext& a_;
  const StudyBlocks& blocks_;
  std::vector<Kind> kinds_;
  std::vector<std::vector<Gathered>> all_;  ///< of each kind
  std::vector<Gathered> variables_;
  std::uint64_t solved_ = 0, failed_ = 0;
  formats::StudyResult result_;
};

}  // namespace

double statistics_need(const StudyScene& study, const StudyNames& names, std::uint64_t block) {
  constexpr double copies = 4;  // of a block: its file, its rows, those of a kind and what is written
  constexpr double max_largest = 3, n_ranks = 3 * quantile_levels.size(),
                   of_rank = sizeof(double) << unsigned{Selection::bits_of_pass};
  const double v = double(study.variables.size()), named = double(names.size()), n = named + max_largest;
  const double ranked = double(std::min(study.n_samples, max_ranked(std::size_t(n + v))));
  return sizeof(double) * (n * (ranked + copies * v) + v * ranked + copies * double(block) * (named + v)) +
         n * n_ranks * of_rank;
}

formats::StudyResult study_statistics(const StudyContext& context, const StudyBlocks& blocks) {
  return Statistics(context, blocks).make();
}

void write_samples(h5::Writer& file, const StudyContext& a, const StudyBlocks& blocks) {
  const Index n = Index(a.study.n_samples), v = std::ssize(a.study.variables);
  const auto kinds = kinds_of(a);
  file.make_rows<int>("samples/status", {n}, "1", "0 solved, 1 refused, 2 not solved, 3 out of balance");
  file.make_rows<double>("samples/variable", {n, v}, "1", "value of each variable");
  for (const auto& kind : kinds) {
    h5::Shape shape{n};
    if (!kind.is_largest) shape.push_back(kind.n);
    file.make_rows<double>(std::string("samples/") + kind.name, shape, kind.unit,
                           std::string(kind.meaning) + "; NaN where the sample was not solved");
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
    for (const auto& kind : kinds) {
      formats::StudyRows rows(k, kind.is_largest ? 1 : kind.n);
      for (Index i = 0; i < k; ++i)
        rows.row(i) = its.status[i] == 0
                          ? Eigen::RowVectorXd(of_kind(kind, its.values.row(i)).transpose())
                          : Eigen::RowVectorXd::Constant(rows.cols(), std::numeric_limits<double>::quiet_NaN());
      file.rows(std::string("samples/") + kind.name, first, std::span<const double>(rows.data(), rows.size()));
    }
  }
}

}  // namespace fastjoint::stage3
