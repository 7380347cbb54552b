// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gmock/gmock.h>

#include <string>

#include "common/program/warning.hpp"

namespace fastjoint::test {

/// Matches a warning of this code whose sentence holds `words`.
inline testing::Matcher<program::Warning> is_warning(const char* code, const std::string& words) {
  return testing::AllOf(testing::Field(&program::Warning::code, testing::StrEq(code)),
                        testing::Field(&program::Warning::text, testing::HasSubstr(words)));
}

}  // namespace fastjoint::test
