// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/samples.hpp"

#include <limits>
#include <utility>

#include "common/errors.hpp"
#include "common/linalg/processor.hpp"

namespace fastjoint::stage3 {

Samples::Samples(const Study& study, std::uint64_t seed, const StudySolver& solver)
    : study_(study), seed_(seed), solver_(solver), middle_(middle_values(study.scene)) {
  find_slopes();
}

SampleNumbers Samples::of_values(const std::vector<double>& values) {
  auto sampled = take();
  SampleNumbers result;
  try {
    result = solver_.solve(sampled->scene(values), away(values));
  } catch (const InputError&) {
    result = solver_.nothing(SampleStatus::refused);
  }
  give(std::move(sampled));
  return result;
}

void Samples::solve_block(const StudyBlocks& blocks, int block) {
  const std::uint64_t first = blocks.first(block);
  const Index n = Index(blocks.end(block) - first);
  Eigen::VectorXi status(n);
  formats::StudyRows values(n, solver_.outputs().size());
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

void Samples::find_slopes() {
  const Index v = std::ssize(middle_);
  slopes_.resize(solver_.outputs().size(), v);
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

VectorXd Samples::away(const std::vector<double>& values) const {
  if (c_slopes_.size() == 0) return {};
  return c_slopes_ *
         (VectorXd::Map(values.data(), std::ssize(values)) - VectorXd::Map(middle_.data(), std::ssize(middle_)));
}

std::unique_ptr<SampledJoint> Samples::take() {
  const std::lock_guard lock(mutex_);
  if (spare_.empty()) return std::make_unique<SampledJoint>(study_.joint_text, study_.scene, study_.joint);
  auto result = std::move(spare_.back());
  spare_.pop_back();
  return result;
}

void Samples::give(std::unique_ptr<SampledJoint> sampled) {
  const std::lock_guard lock(mutex_);
  spare_.push_back(std::move(sampled));
}

}  // namespace fastjoint::stage3
