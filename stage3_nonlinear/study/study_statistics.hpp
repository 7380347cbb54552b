// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/formats/study_result.hpp"
#include "stage3_nonlinear/study/study_blocks.hpp"
#include "stage3_nonlinear/study/study_scene.hpp"
#include "stage3_nonlinear/study/study_solver.hpp"

namespace fastjoint::stage3 {

/// What a study knows besides its samples.
struct StudyContext {
  const StudyScene& study;
  std::uint64_t seed;
  const StudyNames& names;
  Units units;
  SampleNumbers middle;  ///< of the joint with every variable in its middle
  MatrixXd sensitivity;  ///< (columns, v) change of each number with each variable there; infinite if not known
};

/// Statistics of all samples; the blocks are read several times, one after another.
[[nodiscard]] formats::StudyResult study_statistics(const StudyContext& context, const StudyBlocks& blocks);

/// Makes and fills the datasets of one row for each sample.
void write_samples(h5::Writer& file, const StudyContext& context, const StudyBlocks& blocks);

}  // namespace fastjoint::stage3
