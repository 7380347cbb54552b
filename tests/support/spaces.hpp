// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::test {

/// What INSTANTIATE_TEST_SUITE_P needs of tests that run in each space.
[[nodiscard]] inline auto both_spaces() { return testing::Values(pfem::Space::trunk, pfem::Space::product); }
[[nodiscard]] inline std::string space_tested(const testing::TestParamInfo<pfem::Space>& test) {
  return pfem::name_of(test.param);
}

}  // namespace fastjoint::test
