// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/warning.hpp"

#include <fmt/format.h>

#include <ostream>

#include "common/program/program.hpp"

namespace fastjoint::program {

void warn(std::ostream& log, const std::string& program, const Warning& warning) {
  log << fmt::format("{}: warning [{}]: {}\n", program, warning.code, message_line(warning.text));
}

}  // namespace fastjoint::program
