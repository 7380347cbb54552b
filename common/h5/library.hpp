// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fastjoint::h5 {

/// First HDF5 call of every program: errors become our exceptions instead of traces on stderr.
void take_over_error_reporting();

}  // namespace fastjoint::h5
