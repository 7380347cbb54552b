// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>

#include "common/program/timings.hpp"

namespace fastjoint::stage3 {

/// Options of the command line.
struct RunOptions {
  std::string input;           ///< JOINT.json
  std::string output;          ///< RESULT.h5
  std::string csv;             ///< empty: none
  std::string timings = {};    ///< path of the file of times, written by the caller; empty: none
  int p = 0;                   ///< 0: the highest degree that all plates have
  bool all_stresses = false;   ///< print those of every increment
  bool sensitivities = false;  ///< also write derivatives of the forces
  bool quiet = false;
  std::string generator;  ///< program and version, for the file's header
};

/// The whole stage: reads the joint and its matrices, solves, writes RESULT.h5 and the CSV, prints the summary to `out`
/// and warnings to `log`. Its phases are "read", "solve", "write".
///
/// If an increment does not converge, the files hold those before it, marked incomplete, and IncompleteResult says why.
void run(const RunOptions& options, std::ostream& out, std::ostream& log, program::Timings& timings);

}  // namespace fastjoint::stage3
