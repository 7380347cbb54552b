// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/samples.hpp"

#include <utility>

#include "common/errors.hpp"
#include "common/infinite.hpp"
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
  formats::StudyRows values = formats::StudyRows::Constant(n, solver_.outputs().size(), infinite);
  linalg::for_each_index(n, [&](std::size_t i) {
    const auto numbers = of_values(sample_values(study_.scene, seed_, first + i));
    status[Index(i)] = int(numbers.status);
    if (numbers.status == SampleStatus::solved) values.row(Index(i)) = numbers.all.transpose();
  });
  blocks.write(block, std::move(status), std::move(values));
}

void Samples::find_slopes() {
  const Index v = std::ssize(middle_);
  slopes_ = MatrixXd::Zero(solver_.outputs().size(), v);
  MatrixXd c_slopes = MatrixXd::Zero(solver_.middle().c.size(), v);
  linalg::for_each_index(v, [&](std::size_t i) {
    constexpr double part = 1e-3;
    const double step = part * spread_of(study_.scene.variables[i]);
    if (step == 0) return;
    auto values = middle_;
    values[i] += step;
    const auto above = of_values(values);
    values[i] -= 2 * step;
    const auto below = of_values(values);
    if (above.status != SampleStatus::solved || below.status != SampleStatus::solved) {
      slopes_.col(Index(i)).setConstant(infinite);
      return;
    }
    slopes_.col(Index(i)) = (above.all - below.all) / (2 * step);
    if (c_slopes.rows() > 0) c_slopes.col(Index(i)) = (above.c - below.c) / (2 * step);
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
