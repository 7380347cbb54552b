// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>

#include "common/errors.hpp"
#include "common/h5/whole_file.hpp"
#include "common/linalg/processor.hpp"
#include "common/program/memory.hpp"
#include "common/program/progress.hpp"
#include "common/program/warning.hpp"

namespace fastjoint::program {
namespace {

enum Status { done = 0, internal_error = 1, invalid_input = 2, bad_file = 3, numerical_failure = 4 };

void require_path(const std::string& option, const std::string& path) {
  if (path.empty()) throw InputError(fmt::format("{}: '' is not allowed; allowed: a path", option));
  if (path[0] == '-')  // an option whose path was forgotten takes the next option for one
    throw InputError(fmt::format("{}: '{}' is not allowed; allowed: a path, such as './{}'", option, path, path));
}

/// Empty after --help or --version.
std::optional<Arguments> parse(const Command& command, int argc, char** argv) {
  Arguments arguments;
  CLI::App app(command.summary, command.name);
  app.set_version_flag("--version", generator(command.name));
  app.add_option(command.input, arguments.input, "file to read")->required()->option_text(" ");
  app.add_option("-o,--output", arguments.output, "file to write")->required()->option_text(command.output);
  for (const auto& [name, value, help] : command.options)
    (value.empty() ? app.add_flag(name, help) : app.add_option(name, help))->option_text(value.empty() ? " " : value);
  app.add_option("--timings", arguments.timings, "also write what each phase took, as JSON")->option_text("FILE");
  app.add_flag("--quiet", arguments.quiet, "print no summary and no progress");
  app.footer("Exit status: 0 done, 1 internal error, 2 wrong usage or input, 3 bad file, 4 numerical failure.");
  try {
    app.parse(argc, argv);
    if (arguments.input.empty()) throw CLI::RequiredError(command.input);  // CLI11 takes "" for a name
    if (arguments.output.empty()) throw CLI::RequiredError("--output");
    for (const auto& [name, value, help] : command.options)
      if (app.count(name) > 0 && (!value.empty() || app[name]->as<bool>()))
        arguments.options[name] = app[name]->results().back();
    for (const auto& [name, value, help] : command.options) {
      if (value.empty() || app.count(name) == 0) continue;
      if (arguments.text(name).empty())  // a variable of the shell that is not set
        throw InputError(fmt::format("{}: '' is not allowed; allowed: {}", name, value));
      if (value == "FILE") require_path(name, arguments.text(name));
    }
    require_path("-o", arguments.output);
    if (app.count("--timings") > 0) require_path("--timings", arguments.timings);
    return arguments;
  } catch (const CLI::Success& e) {
    app.exit(e, std::cout);
    return std::nullopt;
  } catch (const CLI::ParseError& e) {
    throw InputError(fmt::format("{}; see --help", e.what()));
  }
}

void check_paths(const Arguments& arguments) {
  check_spare("-o", arguments.output, arguments.input, "the input file");
  check_spare("--timings", arguments.timings, arguments.input, "the input file");
  check_spare("--timings", arguments.timings, arguments.output, "the output file");
  for (const auto* path : {&arguments.output, &arguments.timings})
    if (!path->empty()) h5::check_can_write(*path);
}

void report_times(const Command& command, const Arguments& arguments, Timings& timings) {
  timings.stop();
  if (!arguments.quiet) std::cout << timings.line();
  if (!arguments.timings.empty())
    h5::write_whole_file(arguments.timings, timings.json(command.name, FASTJOINT_VERSION));
}

void work(const Command& command, const Arguments& arguments, const Body& body, Timings& timings) {
  check_paths(arguments);
  linalg::set_threads(1);
  std::optional<Progress> progress;
  if (!arguments.quiet) progress.emplace(command.name, ::isatty(STDERR_FILENO) == 1, std::cerr);
  try {
    body(arguments, timings);
  } catch (const IncompleteResult&) {
    report_times(command, arguments, timings);
    throw;
  }
  report_times(command, arguments, timings);
}

int report(const std::string& program, const char* what, Status status) {
  std::cout.flush();
  std::cerr << program << ": " << (status == internal_error ? "internal error: " : "error: ") << message_line(what)
            << "\n";
  return status;
}

std::string farewell;  // made in advance, since a signal handler may call little more than write

/// Removes unfinished files, reports it and ends the program by the default action of the signal.
void stop(int signal) {
  h5::remove_unfinished();
  if (signal == SIGPIPE || ::write(STDERR_FILENO, farewell.data(), farewell.size()) >= 0)
    ::raise(signal);  // whose action SA_RESETHAND has restored
  constexpr int status_of_signal = 128;
  ::_exit(status_of_signal + signal);  // needed in the first process of a container, which the signal does not end
}

void catch_signals(const std::string& program) {
  ::signal(SIGXFSZ, SIG_IGN);  // a write beyond the limit of file sizes then fails with a reason
  farewell = program + ": error: stopped by a signal; files that it had not finished are as they were before\n";
  struct sigaction action {
  }, before{};
  action.sa_handler = stop;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGXCPU, SIGPIPE})
    if (::sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)  // background jobs ignore it
      ::sigaction(signal, &action, nullptr);
}

/// Opens /dev/null in place of closed standard streams, whose numbers a file that is written would get otherwise.
void fill_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDWR) != stream) std::_Exit(bad_file);
}

int outcome(const Command& command, int argc, char** argv, const Body& body) {
  Timings timings;
  keep_freed_memory();
  catch_signals(command.name);
  try {
    require_memory_to_start();
    if (const auto arguments = parse(command, argc, argv)) work(command, *arguments, body, timings);
    return done;
  } catch (const InputError& e) {
    return report(command.name, e.what(), invalid_input);
  } catch (const FileError& e) {
    return report(command.name, e.what(), bad_file);
  } catch (const NumericalError& e) {
    return report(command.name, e.what(), numerical_failure);
  } catch (const std::filesystem::filesystem_error& e) {
    const std::string what = fmt::format("{}: cannot be read or written: {}", e.path1().string(), e.code().message());
    return report(command.name, what.c_str(), bad_file);
  } catch (const std::bad_alloc&) {
    return report(
        command.name,
        "out of memory: the model is too large for this machine; take fewer holes, a lower --p or fewer increments",
        numerical_failure);
  } catch (const std::exception& e) {
    return report(command.name, e.what(), internal_error);
  }
}

/// @param kind Name of an allowed value in the message: "an integer" or "a number".
template <class Number>
Number number_in(const Arguments& arguments, const std::string& name, Number low, Number high, Number otherwise,
                 const char* kind) {
  if (!arguments.flag(name)) return otherwise;
  const std::string given = arguments.text(name);
  Number value = 0;
  const auto [end, error] = std::from_chars(given.data(), given.data() + given.size(), value);
  if (error != std::errc() || end != given.data() + given.size() || !(value >= low && value <= high))
    throw InputError(fmt::format("{}: '{}' is not allowed; allowed: {} from {} to {}", name, given, kind, low, high));
  return value;
}

}  // namespace

int Arguments::integer(const std::string& name, int low, int high, int otherwise) const {
  return number_in(*this, name, low, high, otherwise, "an integer");
}
double Arguments::number(const std::string& name, double low, double high, double otherwise) const {
  return number_in(*this, name, low, high, otherwise, "a number");
}

std::string Arguments::text(const std::string& name) const {
  const auto found = options.find(name);
  return found == options.end() ? "" : found->second;
}

void check_spare(const char* option, const std::string& path, const std::string& other, const std::string& what) {
  if (h5::same_file(path, other))
    throw InputError(fmt::format("{} {}: is {}; choose another name", option, path, what));
}

std::string one_line(const std::string& text) {
  constexpr char first_printable = ' ', delete_character = 127;
  std::string line;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '\n')
      line += "\\n";
    else if (code < first_printable || code == delete_character)
      line += fmt::format("\\u{:04x}", code);
    else
      line += c;
  }
  return line;
}

std::string message_line(const std::string& message) {
  std::string text = one_line(message);
  constexpr std::size_t half = 1500;
  if (text.size() <= 3 * half) return text;
  const auto is_inside = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
  std::size_t from = half, to = text.size() - half;
  while (from > 0 && is_inside(from)) --from;
  while (to < text.size() && is_inside(to)) ++to;
  return text.substr(0, from) + " ... " + text.substr(to);
}

void warn(std::ostream& log, const std::string& program, const Warning& warning) {
  log << fmt::format("{}: warning [{}]: {}\n", program, warning.code, message_line(warning.text));
}

std::string listed(std::vector<std::string> names, std::size_t most) {
  if (names.size() <= most) return fmt::format("{}", fmt::join(names, ", "));
  const std::size_t more = names.size() - (most - 1);
  names.resize(most - 1);
  return fmt::format("{} and {} more", fmt::join(names, ", "), more);
}

std::string generator(const std::string& program) { return fmt::format("{} {}", program, FASTJOINT_VERSION); }

void run(const Command& command, int argc, char** argv, const Body& body) {
  fill_closed_streams();
  linalg::take_better_kernels(argv);
  int status = outcome(command, argc, argv, body);
  if (!std::cout.flush() && status == done)
    status = report(command.name, "standard output cannot be written; files are complete", bad_file);
  // _Exit skips the exit handlers of libraries: that of OpenBLAS waits for threads without end if memory is short. With
  // std::exit 27 of 91 runs of stage1_plate on examples/lap_joint never ended (ulimit -v 60 to 600 MB, 6 MB apart;
  // those below 230 MB), with _Exit none.
  std::_Exit(status);
}

}  // namespace fastjoint::program
