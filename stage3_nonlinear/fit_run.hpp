// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>

#include "common/program/timings.hpp"

namespace fastjoint::stage3 {

struct FitOptions {
  std::string data;     ///< path of the points (test_points.hpp)
  std::string law;      ///< "power" or "cubic"
  std::string drawing;  ///< path of an SVG file to write, or empty
  bool quiet = false;   ///< print no summary
};

/// Fits a law to the points of a test: constants with their uncertainties and a piece of JSON for "laws" on `out`,
/// warnings on `log`; phases "read", "solve", "write". Throws InputError, FileError, NumericalError.
void run_fit(const FitOptions& options, std::ostream& out, std::ostream& log, program::Timings& timings);

}  // namespace fastjoint::stage3
