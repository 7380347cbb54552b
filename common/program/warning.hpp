// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <iosfwd>
#include <string>

namespace fastjoint::program {

/// A warning about a result that is written all the same.
struct Warning {
  const char* code;  ///< its kind in kebab-case, stable when the sentence changes; table in docs/results.md
  std::string text;  ///< one sentence, with file and place
};

/// Prints it on a line of its own: "PROGRAM: warning [CODE]: TEXT".
void warn(std::ostream& log, const std::string& program, const Warning& warning);

}  // namespace fastjoint::program
