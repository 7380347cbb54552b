// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
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
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte == 0 ? 0 : byte - 1, text.size()));
  const auto line = 1 + std::count(text.begin(), end, '\n');
  const auto newline = std::find(std::make_reverse_iterator(end), text.rend(), '\n');
  const auto column = 1 + std::distance(std::make_reverse_iterator(end), newline);
  return fmt::format("line {}, column {}", line, column);
}

/// The parser's own words for what it found, without its numbers.
std::string reason(const std::string& what) {
  const auto at = what.find("syntax error");
  return at == std::string::npos ? what : what.substr(at);
}

}  // namespace

Document parse(const std::string& file, const std::string& text) {
  try {
    Watch watch(file);
    auto root = std::make_shared<json>(json::parse(text, std::ref(watch), true, true));
    return {file, text, std::move(root)};
  } catch (const json::parse_error& e) {
    throw InputError(
        fmt::format("{}: not valid JSON at {}: {}", file, line_and_column(text, e.byte), reason(e.what())));
  } catch (const json::exception& e) {  // a number that no double holds
    throw InputError(fmt::format("{}: not valid JSON: {}", file, e.what()));
  }
}

}  // namespace fastjoint::input
