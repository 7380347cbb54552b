// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/program/progress.hpp"

namespace fastjoint::program {

/// One option of a program: used for parsing, for --help and by the test of the table in docs/programs.md.
struct Option {
  std::string name;   ///< with its dashes, "--p"
  std::string value;  ///< what --help calls its value, empty for a flag
  std::string help;   ///< one line
};

/// Command line of a program, in addition to `INPUT -o OUTPUT --timings FILE --quiet --help --version`, which all have.
struct Command {
  std::string name;
  std::string summary;
  std::string input;   ///< "PLATE.json"
  std::string output;  ///< "PLATE.h5"
  std::vector<Option> options;
};

/// The parsed command line.
struct Arguments {
  std::string input, output;
  std::string timings;  ///< path of the file of timings, or empty
  bool quiet = false;
  std::map<std::string, std::string> options;  ///< the given options only

  /// Value of an integer option within [low, high], or `otherwise`. Throws InputError.
  [[nodiscard]] int integer(const std::string& name, int low, int high, int otherwise) const;
  /// Value of an option that is a number within [low, high], or `otherwise`. Throws InputError.
  [[nodiscard]] double number(const std::string& name, double low, double high, double otherwise) const;
  /// True if a flag was given.
  [[nodiscard]] bool flag(const std::string& name) const { return options.contains(name); }
  /// Value of an option or "".
  [[nodiscard]] std::string text(const std::string& name) const;
};

/// Main function of a program: it names its phases and prints its summary unless `quiet` is set.
using Body = std::function<void(const Arguments&, Timings&)>;

/// Runs a program: parses the arguments, checks that the outputs can be written, runs `body`, adds time and memory to
/// its summary, reports an exception as one line on stderr, and ends the process with the documented exit status (0
/// done, 1 internal error, 2 wrong usage or input, 3 file, 4 numerical failure).
[[noreturn]] void run(const Command& command, int argc, char** argv, const Body& body);

/// Throws InputError if the file of an option is the same as another file of the run, `other`, described by `what`.
void check_spare(const char* option, const std::string& path, const std::string& other, const std::string& what);

/// Escapes line breaks and other control characters, which names in the input may contain, as in JSON.
[[nodiscard]] std::string one_line(const std::string& text);

/// The same of a message that may quote long input, without the middle of a very long one.
[[nodiscard]] std::string message_line(const std::string& message);

/// "1 piece", "2 pieces".
template <class Integer>
[[nodiscard]] std::string counted(Integer n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

/// "a, b, c"; of more names than the most, one fewer "and 3 more".
[[nodiscard]] std::string listed(std::vector<std::string> names, std::size_t most = 6);

/// Name and version that every file carries: "stage1_plate 1.0.0".
[[nodiscard]] std::string generator(const std::string& program);

}  // namespace fastjoint::program
