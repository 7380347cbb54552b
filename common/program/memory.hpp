// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::program {

/// Bytes that this process may still take: what the machine has free, within the limits that the user (ulimit -v) and
/// the control group of the process set. Found once: what the process has taken since is part of what it needs.
[[nodiscard]] double available_memory();
/// Bytes left in a control group of version 1 or 2, as a container sees its own; not a number or infinite where there
/// is no limit. What only caches files is left too: the system takes it back when it is needed.
[[nodiscard]] double left_in_control_group(const std::string& folder);

/// Most memory in bytes that this process has had resident.
[[nodiscard]] double peak_memory();

/// Throws InputError "WHAT takes about NEED of memoryPARTS, ... are available; allowed: ALLOWED" if that is not
/// available.
void require_memory(const std::string& what, double need, const std::string& parts, const std::string& allowed);

/// Throws InputError if there is too little to begin with: HDF5 crashes where its calls find none.
void require_memory_to_start();

/// Bytes in words: "63 MB", "1.2 GB".
[[nodiscard]] std::string bytes_text(double bytes);

/// Tells the allocator to keep what is freed: matrices come and go by the megabyte, and giving their pages back to the
/// system only to have them zeroed again takes a fifth of a run.
void keep_freed_memory();

}  // namespace fastjoint::program
