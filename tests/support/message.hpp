// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "common/errors.hpp"

namespace fastjoint::test {

/// What the InputError says that a call throws.
template <class Call>
[[nodiscard]] std::string message_of(Call call) {
  try {
    (void)call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace fastjoint::test
