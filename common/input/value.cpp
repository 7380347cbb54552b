// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/input/value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/errors.hpp"

namespace fastjoint::input {
namespace {

/// RFC 6901: ~ and / inside a key are escaped.
std::string escaped(const std::string& key) {
  std::string out;
  for (const char c : key) {
    if (c == '~') {
      out += "~0";
    } else if (c == '/') {
      out += "~1";
    } else {
      out += c;
    }
  }
  return out;
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

bool inside(const Range& range, double x) {
  const bool above = range.low_allowed ? x >= range.low : x > range.low;
  const bool below = range.high_allowed ? x <= range.high : x < range.high;
  return above && below;
}

}  // namespace

Value::Value(const Document& document) : file_(document.file), root_(document.root), json_(root_.get()) {}

Value::Value(const Value& parent, const nlohmann::json& json, const std::string& key)
    : file_(parent.file_), pointer_(parent.pointer_ + "/" + escaped(key)), root_(parent.root_), json_(&json) {}

bool Value::is_object() const { return json_->is_object(); }
bool Value::is_array() const { return json_->is_array(); }
bool Value::is_number() const { return json_->is_number(); }
bool Value::is_string() const { return json_->is_string(); }

std::string Value::shown() const {
  constexpr std::size_t longest = 60;
  std::string text = json_->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
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

std::vector<Value> Value::items(std::size_t least, std::size_t most) const {
  if (!is_array()) not_allowed("an array");
  if (json_->size() < least || json_->size() > most)
    fail(fmt::format("array of {}", json_->size()), least == most ? fmt::format("exactly {}", least)
                                                    : most == std::numeric_limits<std::size_t>::max()
                                                        ? fmt::format("at least {}", least)
                                                        : fmt::format("{} to {}", least, most));
  std::vector<Value> result;
  for (std::size_t i = 0; i < json_->size(); ++i) result.push_back(Value(*this, (*json_)[i], std::to_string(i)));
  return result;
}

double Value::number(const Range& range) const {
  if (!is_number()) not_allowed(words(range));
  const double x = json_->get<double>();
  if (!std::isfinite(x) || !inside(range, x)) not_allowed(words(range));
  return x;
}

std::vector<double> Value::numbers(std::size_t least, std::size_t most, const Range& range) const {
  std::vector<double> result;
  for (const auto& item : items(least, most)) result.push_back(item.number(range));
  return result;
}

int Value::integer(int low, int high) const {
  // 8.0 is an integer for JSON Schema, so it is one here.
  const double x = is_number() ? json_->get<double>() : std::numeric_limits<double>::quiet_NaN();
  if (!(x >= low && x <= high && x == std::floor(x)))
    not_allowed(high == std::numeric_limits<int>::max() ? fmt::format("an integer >= {}", low)
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
  not_allowed(fmt::format("\"{}\"", fmt::join(allowed, "\", \"")));
}

void check_format(const Value& root, const std::string& format) {
  (void)root.at("format").choice({format});
  (void)root.at("version").integer(1, 1);
  if (const auto schema = root.find("$schema")) (void)schema->text();
}

}  // namespace fastjoint::input
