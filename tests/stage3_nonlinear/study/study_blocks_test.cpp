// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/study/study_blocks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/errors.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::stage3::study_test {
namespace {

using testing::HasSubstr;

/// Two runs of one study are no danger to its results, but the slower one finds its blocks gone.
TEST(StudyBlocks, OneThatAnotherRunHasRemovedIsNoDamagedOne) {
  const test::TemporaryFolder folder;
  const StudyBlocks blocks(folder.path("study.h5"), {}, 20, 2);
  blocks.write(0, Eigen::VectorXi::Zero(16), formats::StudyRows::Ones(16, 2));
  EXPECT_EQ(blocks.read(0).values.sum(), 32);
  blocks.remove();
  EXPECT_THAT([&] { (void)blocks.read(0); },
              testing::ThrowsMessage<FileError>(HasSubstr("another run may have made the same study meanwhile")));
}

}  // namespace
}  // namespace fastjoint::stage3::study_test
