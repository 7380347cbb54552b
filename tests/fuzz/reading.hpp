// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "common/errors.hpp"

namespace fastjoint::fuzz {

/// Reads one input of a fuzzer (libFuzzer of LLVM). Refusals are what readers are for; any other exception leaves the
/// target and is a fall, as are signals, leaks, faults that sanitizers see, and inputs that take longer than allowed.
template <class Reader>
int read(const std::uint8_t* data, std::size_t size, Reader reader) {
  try {
    reader(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const InputError&) {
  } catch (const FileError&) {  // of a file that the input names
  }
  return 0;
}

}  // namespace fastjoint::fuzz
