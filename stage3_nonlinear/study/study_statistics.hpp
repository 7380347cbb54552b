// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "common/formats/study.hpp"
#include "stage3_nonlinear/study/study_blocks.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"
#include "stage3_nonlinear/study/study_solver.hpp"

namespace fastjoint::stage3 {

/// Data of a study other than its samples.
struct StudyContext {
  const StudyScene& study;
  std::uint64_t seed;
  const StudyOutputs& outputs;
  Units units;
  SampleNumbers middle;  ///< results with every variable in its middle
  MatrixXd sensitivity;  ///< (columns, v) derivative of each number by each variable there; infinite if not known
};

/// Bytes that the statistics take. @param block Number of samples of a block.
[[nodiscard]] double statistics_need(const StudyScene& study, const StudyOutputs& outputs);
/// Statistics of all samples; the blocks are read several times, one after another.
[[nodiscard]] formats::StudyResult study_statistics(const StudyContext& context, const StudyBlocks& blocks);

/// Writes the datasets with one row for each sample.
void write_samples(h5::Writer& file, const StudyContext& context, const StudyBlocks& blocks);

}  // namespace fastjoint::stage3
