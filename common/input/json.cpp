// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "common/errors.hpp"

namespace fastjoint::input {
namespace {

using nlohmann::json;

/// Watches the keys of the objects that are open, since the parser would silently keep the last of two, and strings.
class Watch {
 public:
  explicit Watch(const std::string& file) : file_(file) {}

  bool operator()(int /*depth*/, json::parse_event_t event, const json& value) {
    if (value.is_string() && value.get_ref<const std::string&>().find('\0') != std::string::npos)
      throw InputError(
          fmt::format("{}: the string {} holds the character \\u0000, which would end it in other files; "
                      "allowed: any other character",
                      file_, value.dump()));
    if (event == json::parse_event_t::object_start) {
      open_.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      open_.pop_back();
    } else if (event == json::parse_event_t::key) {
      const auto key = value.get<std::string>();
      if (!open_.back().insert(key).second)
        throw InputError(fmt::format("{}: key \"{}\" stands twice in one object; each key may stand once", file_, key));
    }
    return true;
  }

 private:
  const std::string& file_;
  std::vector<std::set<std::string>> open_;
};

std::string line_and_column(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + std::min(byte == 0 ? 0 : byte - 1, text.size());
  const auto line = 1 + std::count(text.begin(), end, '\n');
  const auto newline = std::find(std::make_reverse_iterator(end), text.rend(), '\n');
  const auto column = 1 + std::distance(std::make_reverse_iterator(end), newline);
  return fmt::format("line {}, column {}", line, column);
}

/// Words of the parser for common mistakes, and what to do about each.
constexpr std::array<std::pair<const char*, const char*>, 14> advice{{
    {"unexpected '}'; expected string literal", "there is one comma too many before '}'; remove it"},
    {"unexpected ']'; expected '['", "a value is missing before ']', or there is one comma too many"},
    {"unexpected ','", "there is one comma too many, or a value is missing before it"},
    {"unexpected '}'; expected '['", "a value is missing before '}'"},
    {"unexpected number literal; expected string literal",
     "a number follows a comma where a key must; write decimals with a point, 72.5"},
    {"unexpected end of input", "the text ends too early; a closing bracket or quote is missing"},
    {"unexpected string literal; expected '}'", "a comma is missing before this"},
    {"literal; expected ']'", "a comma is missing before this"},
    {"expected ':'", "a colon is missing between a key and its value"},
    {"expected end of input",
     "something follows the last closing bracket; remove it, or see which bracket closes too early"},
    {"must be escaped", "a text goes over the end of its line; close its double quotes"},
    {"invalid number", "this number is incomplete; write 1 or 1.0, 0.5, 1e-3"},
    {"ill-formed UTF-8", "a character is not UTF-8; save the file as UTF-8"},
    {"invalid literal",
     "this is no value; allowed: a number, a text or key in double quotes, true, false, an object, an array"},
}};

/// What is wrong with the text; else the parser's own words, without its numbers.
std::string reason(const std::string& text, const std::string& what) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return "the file is empty";
  for (const auto& [words, sentence] : advice)
    if (what.find(words) != std::string::npos) return sentence;
  const auto at = what.find(" - ");
  return at == std::string::npos ? what : what.substr(at + 3);
}

}  // namespace

std::string read_text_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!error && std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw FileError(fmt::format("{}: is not a regular file", path));
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  return text.str();
}

Document parse(const std::string& file, const std::string& text) {
  constexpr std::size_t longest_mark = 4;  // of an encoding
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") ||
      text.substr(0, longest_mark).find('\0') != std::string::npos)
    throw InputError(fmt::format("{}: is encoded in UTF-16; save it as UTF-8", file));
  try {
    Watch watch(file);
    auto root = std::make_shared<json>(json::parse(text, std::ref(watch), true, true));
    return {file, text, std::move(root)};
  } catch (const json::parse_error& e) {
    throw InputError(
        fmt::format("{}: not valid JSON at {}: {}", file, line_and_column(text, e.byte), reason(text, e.what())));
  } catch (const json::exception& e) {  // a number that no double holds
    const std::string what = e.what();
    throw InputError(fmt::format("{}: not valid JSON: {} is too large; allowed: numbers up to 1.8e308", file,
                                 what.substr(what.find('\''))));
  }
}

}  // namespace fastjoint::input
