// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fastjoint::program {

/// Bytes that this process may still take: what the machine has free, within the limits that the user (ulimit -v) and
/// the control group of the process set.
[[nodiscard]] double available_memory();

/// Tells the allocator to keep what is freed: matrices come and go by the megabyte, and giving their pages back to the
/// system only to have them zeroed again takes a fifth of a run.
void keep_freed_memory();

}  // namespace fastjoint::program
