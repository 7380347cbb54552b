// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/program/progress.hpp"

namespace fastjoint::program {

/// One row of a program's options: used for parsing, for --help and by the test of the table in docs/programs.md.
struct Option {
  std::string name;   ///< with its dashes, "--p"
  std::string value;  ///< what stands for the value in --help, empty for a flag
  std::string help;   ///< one line
};

/// The words in which the three programs differ; `INPUT -o OUTPUT --timings FILE --quiet --help --version` all have.
struct Command {
  std::string name;
  std::string summary;
  std::string input;   ///< "PLATE.json"
  std::string output;  ///< "PLATE.h5"
  std::vector<Option> options;
};

/// The user's words, parsed.
struct Arguments {
  std::string input, output;
  std::string timings;  ///< path of the file of times, or empty
  bool quiet = false;
  std::map<std::string, std::string> options;  ///< only those that were given

  /// Value of an integer option within [low, high], or `otherwise`. Throws InputError.
  [[nodiscard]] int integer(const std::string& name, int low, int high, int otherwise) const;
  /// Value of an option that is a number within [low, high], or `otherwise`. Throws InputError.
  [[nodiscard]] double number(const std::string& name, double low, double high, double otherwise) const;
  /// Tells if a flag was given.
  [[nodiscard]] bool flag(const std::string& name) const { return options.contains(name); }
  /// Value of an option or "".
  [[nodiscard]] std::string text(const std::string& name) const;
};

/// The work of a program on its arguments. It names its phases and prints its summary unless told to be quiet.
using Body = std::function<void(const Arguments&, Timings&)>;

/// Whole life of a program: parses, checks that the outputs can be written, runs `body`, ends its summary with what the
/// run took, turns what is thrown into one line on stderr, and ends the process with the exit status of the contract (0
/// done, 1 internal error, 2 wrong usage or input, 3 file, 4 numerical failure).
[[noreturn]] void run(const Command& command, int argc, char** argv, const Body& body);

/// Throws InputError if the file that an option names is another one that the run reads or writes, `what`.
void check_spare(const char* option, const std::string& path, const std::string& other, const std::string& what);

/// The text with line breaks and other control characters, which names in the input may hold, as JSON escapes them.
[[nodiscard]] std::string one_line(const std::string& text);

/// "1 piece", "2 pieces".
template <class Integer>
[[nodiscard]] std::string counted(Integer n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

/// Name and version that every file carries: "stage1_plate 1.0.0".
[[nodiscard]] std::string generator(const std::string& program);

}  // namespace fastjoint::program
