// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/study.hpp"

namespace fastjoint::formats {
namespace {

const h5::Format block_format{"study-block", 1, 0}, study_format{"study-result", 1, 3};

template <class File, class Origin>
void file_datasets(File& file, Origin& a) {
  file("files/name", a.file, {h5::any}, "1", "files that the joint and the study name, and the polynomial degree");
  file("files/digest", a.digest, {Eigen::Index(a.file.size())}, "1", "digest of each file; the degree");
}

template <class File, class Block>
void block_datasets(File& file, Block& a) {
  file.attribute("generator", a.origin.generator);
  file.attribute("joint", a.origin.joint);
  file.attribute("study", a.origin.study);
  file.attribute("seed", a.origin.seed);
  file.attribute("block", a.number);
  file.attribute("block_size", a.size);
  file_datasets(file, a.origin);
  file("status", a.status, {h5::some}, "1",
       "what became of each sample: 0 solved, 1 refused, 2 not solved, 3 out of balance", h5::integers(0, 3));
  file("values", a.values, {Eigen::Index(a.status.size()), File::reads ? h5::some : Eigen::Index(a.values.cols())}, "1",
       "forces, peaks and displacements of each sample, infinite of one that is not solved", h5::infinite_too);
}

void group_datasets(h5::Writer& file, const StudyGroup& a, Eigen::Index v) {
  const std::string group = "statistics/" + a.name + "/";
  const Eigen::Index n = std::ssize(a.of);
  file(group + "of", a.of, {n}, "1", "fastener, hole, external or crack tip that each number is of");
  file(group + "middle", a.middle, {n}, a.unit,
       "of the joint with every variable in its middle; infinite if not solved", h5::infinite_too);
  file(group + "mean", a.mean, {n}, a.unit, "mean of the samples that were solved", h5::infinite_too);
  file(group + "deviation", a.deviation, {n}, a.unit, "standard deviation of the samples that were solved",
       h5::infinite_too);
  file(group + "by_sensitivities", a.by_sensitivities, {n}, a.unit,
       "standard deviation by the sensitivities in the middle alone: the root of the sum of squares; infinite if not "
       "known",
       h5::infinite_too);
  file(group + "quantile", a.quantile, {n, 4}, a.unit, "quantiles of 5, 50, 95 and 99 %", h5::infinite_too);
  file(group + "quantile_low", a.low, {n, 4}, a.unit,
       "lower limit of their 95 % confidence intervals, for any distribution", h5::infinite_too);
  file(group + "quantile_high", a.high, {n, 4}, a.unit, "upper limit of their 95 % confidence intervals",
       h5::infinite_too);
  file(group + "sensitivity", a.sensitivity, {n, v}, "1",
       "change with each variable in the middle, in the units of both; infinite if not known", h5::infinite_too);
  file(group + "rank_correlation", a.correlation, {n, v}, "1", "Spearman's rank correlation with each variable");
  file(group + "governs", a.governs, {n}, "1", "fraction of the solved samples in which it is the largest");
  if (a.closed.size() > 0)
    file(group + "closed", a.closed, {n}, "1",
         "fraction of the solved samples in which the crack closes at its tip, K_I < 0");
  file(group + "limit", a.limit, {}, a.unit, "limit of STUDY.json, infinite if there is none", h5::infinite_too);
  file(group + "limits", a.limits, {n}, a.unit, "limit of each; infinite if there is none", h5::infinite_too);
  file(group + "exceeds", a.exceeds, {n}, "1", "fraction of the solved samples above the limit");
  file(group + "exceeds_low", a.exceeds_low, {n}, "1", "lower limit of its exact 95 % confidence interval");
  file(group + "exceeds_high", a.exceeds_high, {n}, "1", "upper limit of its exact 95 % confidence interval");
}

}  // namespace

void write(const std::string& path, const StudyBlock& block) {
  h5::Writer file(path, block_format);
  block_datasets(file, block);
  file.commit();
}

StudyBlock read_study_block(const std::string& path) {
  h5::Reader file(path, block_format);
  StudyBlock block;
  block_datasets(file, block);
  return block;
}

void write(const std::string& path, const StudyResult& a, const std::function<void(h5::Writer&)>& samples) {
  h5::Writer file(path, study_format);
  header(file, a.header);
  file("study", a.origin.study, {}, "1", "JSON text of the study");
  file.attribute("seed", a.origin.seed);
  file.attribute("sampling", a.sampling);
  file_datasets(file, a.origin);
  const Eigen::Index v = std::ssize(a.variable);
  file("variables/name", a.variable, {v}, "1", "variables of the study");
  file("variables/place", a.place, {v}, "1", "JSON pointers of each into the joint, parted by spaces");
  file("variables/middle", a.middle, {v}, "1", "value in the middle, in the variable's own unit");
  file("variables/mean", a.mean, {v}, "1", "mean of all samples", h5::infinite_too);
  file("variables/deviation", a.deviation, {v}, "1", "standard deviation of all samples", h5::infinite_too);
  file("statistics/n_status", a.n_status, {4}, "1",
       "number of samples that were 0 solved, 1 refused, 2 not solved, 3 out of balance");
  for (const auto& group : a.groups) group_datasets(file, group, v);
  samples(file);
  file.commit();
}

}  // namespace fastjoint::formats
