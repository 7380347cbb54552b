// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <exception>

namespace fastjoint::stage3 {

/// Runs what C calls, through which nothing may be thrown: what `body` throws is kept for the caller to throw on.
///
/// @param body () -> bool
/// @return     What the body says; false if it threw.
template <class Body>
[[nodiscard]] bool without_throwing(std::exception_ptr& thrown, Body body) noexcept {
  try {
    return body();
  } catch (...) {
    thrown = std::current_exception();
    return false;
  }
}

}  // namespace fastjoint::stage3
