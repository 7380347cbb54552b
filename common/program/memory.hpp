// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::program {

/// Bytes that this process may allocate: the free memory of the machine within the limits of the user (ulimit -v) and
/// of the process's control group. Determined at the first call, so that memory allocated later counts as part of the
/// need.
[[nodiscard]] double available_memory();
/// Free bytes in a control group of version 1 or 2, as seen from inside a container; NaN or infinite without a limit.
/// The file cache counts as free, since the system reclaims it on demand.
[[nodiscard]] double left_in_control_group(const std::string& folder);

/// Peak resident memory of this process in bytes.
[[nodiscard]] double peak_memory();

/// Throws InputError "WHAT takes about NEED of memoryPARTS, ... are available; allowed: ALLOWED" if NEED is not
/// available.
void require_memory(const std::string& what, double need, const std::string& parts, const std::string& allowed);

/// Throws InputError if there is too little memory to start: HDF5 crashes if an allocation in it fails.
void require_memory_to_start();

/// Number of threads, at most `wanted` and at least one, for which the limits of this process have memory.
[[nodiscard]] int threads_that_fit(int wanted);

/// Bytes as text: "63 MB", "1.2 GB".
[[nodiscard]] std::string bytes_text(double bytes);

/// Tells the allocator to keep freed memory: returning the pages of large matrices to the system and getting them
/// zeroed again takes a fifth of a run. The sheet of 900 holes of `scripts/measure/make_panel 30 30` takes stage 1 30 s
/// of processor time with this and 36 s without, and 3.5 GB of memory for 3.15 GB; small sheets are the same.
void keep_freed_memory();

}  // namespace fastjoint::program
