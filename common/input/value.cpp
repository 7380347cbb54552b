// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "common/errors.hpp"

namespace fastjoint::input {
namespace {

using nlohmann::json;

/// Maximum nesting of arrays and objects: far above any scene, far below the depth at which printing overflows the
/// stack.
constexpr int max_depth = 100;

/// Characters that would end strings in other files, or lines of the summary.
bool is_control(unsigned char c) { return c < 0x20 || c == 0x7f; }

/// Parser callback that checks strings, the depth and duplicate keys, of which the parser would silently keep the last.
struct Watch {
  const std::string& file;
  std::vector<std::set<std::string>> open = {};
  std::string key = {};  ///< last key of the outermost object

  bool operator()(int depth, json::parse_event_t event, const json& value) {
    if (event == json::parse_event_t::key && depth == 1) key = value.get<std::string>();
    const bool opens = event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= max_depth)
      throw InputError(fmt::format("{}: /{}: arrays and objects are nested more than {} deep; allowed: at most {}",
                                   file, key, max_depth, max_depth));
    if (value.is_string() && std::ranges::any_of(value.get_ref<const std::string&>(), is_control))
      throw InputError(
          fmt::format("{}: the string {} holds a control character, such as the end of a line; allowed: any "
                      "other character",
                      file, value.dump()));
    if (event == json::parse_event_t::object_start) open.emplace_back();
    if (event == json::parse_event_t::object_end) open.pop_back();
    if (event == json::parse_event_t::key && !open.back().insert(value.get<std::string>()).second)
      throw InputError(fmt::format("{}: key \"{}\" stands twice in one object; each key may stand once", file,
                                   value.get<std::string>()));
    return true;
  }
};

std::string line_and_column(const std::string& text, std::size_t byte) {
  const std::string before = text.substr(0, byte == 0 ? 0 : byte - 1);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  return fmt::format("line {}, column {}", line, before.size() - before.rfind('\n'));  // npos wraps to column 1
}

/// Messages of the parser for common mistakes, with an explanation of each.
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

/// Explains the mistake in the text; for unknown ones returns the parser's message without its numbers.
std::string reason(const std::string& text, const std::string& what) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return "the file is empty";
  for (const auto& [words, sentence] : advice)
    if (what.find(words) != std::string::npos) return sentence;
  const auto at = what.find(" - ");
  return at == std::string::npos ? what : what.substr(at + 3);
}

std::string words(const Range& range) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  std::string text = "a number";
  if (low) text += fmt::format(" {} {}", range.low_allowed ? ">=" : ">", range.low);
  if (low && high) text += " and";
  if (high) text += fmt::format(" {} {}", range.high_allowed ? "<=" : "<", range.high);
  return text;
}

}  // namespace

std::string read_text_file(const std::string& path) {
  if (std::error_code none; std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
    throw FileError(fmt::format("{}: is not a regular file", path));
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  return std::move(text).str();
}

void check_is_text(const std::string& file, const std::string& text) {
  constexpr std::size_t mark_size = 4;  // an encoding shows in the first bytes
  const auto zero = text.find('\0');
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff") || zero < mark_size)
    throw InputError(fmt::format("{}: is encoded in UTF-16; save it as UTF-8", file));
  if (zero != std::string::npos)
    throw InputError(fmt::format("{}: a byte of value 0 at {}; allowed: text", file, line_and_column(text, zero + 1)));
}

Document parse(const std::string& file, const std::string& text) {
  check_is_text(file, text);
  try {
    Watch watch{file};
    auto root = std::make_shared<json>(json::parse(text, std::ref(watch), true, true));
    return {file, text, std::move(root)};
  } catch (const json::parse_error& e) {
    throw InputError(
        fmt::format("{}: not valid JSON at {}: {}", file, line_and_column(text, e.byte), reason(text, e.what())));
  } catch (const json::exception& e) {  // a number above the range of double
    const std::string what = e.what();
    throw InputError(fmt::format("{}: not valid JSON: {} is too large; allowed: numbers up to 1.8e308", file,
                                 what.substr(what.find('\''))));
  }
}

Value::Value(const Document& document) : file_(document.file), root_(document.root), json_(root_.get()) {}

Value::Value(const Value& parent, const json& value, const std::string& key)
    : file_(parent.file_),
      pointer_(parent.pointer_ + (json::json_pointer() / key).to_string()),
      root_(parent.root_),
      json_(&value) {}

bool Value::is_object() const { return json_->is_object(); }
bool Value::is_array() const { return json_->is_array(); }
bool Value::is_number() const { return json_->is_number(); }
bool Value::is_string() const { return json_->is_string(); }

std::string Value::shown() const {
  constexpr std::size_t max_size = 60;
  std::string text = json_->dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > max_size) text = text.substr(0, max_size) + "...";
  return text;
}

void Value::fail(const std::string& found, const std::string& allowed) const {
  throw InputError(fmt::format("{}: {}: {}; allowed: {}", file_, pointer_.empty() ? "/" : pointer_, found, allowed));
}

void Value::not_allowed(const std::string& allowed) const { fail(shown() + " is not allowed", allowed); }

const Value& Value::only(std::initializer_list<const char*> allowed) const {
  if (!is_object()) not_allowed("an object");
  for (const auto& [key, value] : json_->items())
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end())
      Value(*this, value, key).fail("unknown key", fmt::format("{}", fmt::join(allowed, ", ")));
  return *this;
}

Value Value::at(const char* key) const {
  if (auto value = find(key)) return *value;
  fail(fmt::format("key \"{}\" is missing", key), fmt::format("an object with \"{}\"", key));
}

std::optional<Value> Value::find(const char* key) const {
  if (!is_object()) not_allowed("an object");
  const auto found = json_->find(key);
  if (found == json_->end()) return std::nullopt;
  return Value(*this, *found, key);
}

std::vector<std::pair<std::string, Value>> Value::members() const {
  if (!is_object()) not_allowed("an object");
  std::vector<std::pair<std::string, Value>> result;
  for (const auto& [key, value] : json_->items()) {
    if (key.empty()) fail("a key is empty", "names of at least one character");
    result.emplace_back(key, Value(*this, value, key));
  }
  return result;
}

std::vector<Value> Value::items(std::size_t min, std::size_t max) const {
  if (!is_array()) not_allowed("an array");
  if (json_->size() < min || json_->size() > max)
    fail(fmt::format("array of {}", json_->size()), min == max ? fmt::format("exactly {}", min)
                                                    : max == std::numeric_limits<std::size_t>::max()
                                                        ? fmt::format("at least {}", min)
                                                        : fmt::format("{} to {}", min, max));
  std::vector<Value> result;
  for (std::size_t i = 0; i < json_->size(); ++i) result.push_back(Value(*this, (*json_)[i], std::to_string(i)));
  return result;
}

bool has_allowed_size(double x) { return x == 0 || (std::abs(x) >= smallest_number && std::abs(x) <= largest_number); }

double Value::number(const Range& range) const {
  if (!is_number()) not_allowed(words(range));
  const double x = json_->get<double>();
  const bool above = range.low_allowed ? x >= range.low : x > range.low;
  const bool below = range.high_allowed ? x <= range.high : x < range.high;
  if (!std::isfinite(x) || !above || !below) not_allowed(words(range));
  if (!has_allowed_size(x))
    not_allowed(fmt::format("{} from {} to {}, in other units",
                            range.low >= 0 && !range.low_allowed ? "a number" : "0, or a size", smallest_number,
                            largest_number));
  return x;
}

std::vector<double> Value::numbers(std::size_t min, std::size_t max, const Range& range) const {
  std::vector<double> result;
  for (const auto& item : items(min, max)) result.push_back(item.number(range));
  return result;
}

int Value::integer(int low, int high) const {
  // JSON Schema accepts 8.0 as an integer, so it is one here.
  const double x = is_number() ? json_->get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!(x >= low && x <= high && x == std::floor(x)))
    not_allowed(high == std::numeric_limits<int>::max() && !(x > high)
                    ? fmt::format("an integer >= {}", low)
                    : fmt::format("an integer from {} to {}", low, high));
  return static_cast<int>(x);
}

bool Value::boolean() const {
  if (!json_->is_boolean()) not_allowed("true or false");
  return json_->get<bool>();
}

std::string Value::text() const {
  if (!is_string() || json_->get_ref<const std::string&>().empty()) not_allowed("a string that is not empty");
  return json_->get<std::string>();
}

std::string Value::choice(const std::vector<std::string>& allowed) const {
  if (is_string() && std::find(allowed.begin(), allowed.end(), json_->get_ref<const std::string&>()) != allowed.end())
    return json_->get<std::string>();
  if (allowed.empty()) not_allowed("nothing, since the file names none");
  not_allowed(fmt::format("\"{}\"", fmt::join(allowed, "\", \"")));
}

void check_format(const Value& root, const std::string& format) {
  (void)root.at("format").choice({format});
  (void)root.at("version").integer(1, 1);
  if (const auto schema = root.find("$schema")) (void)schema->text();
}

}  // namespace fastjoint::input
