// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <initializer_list>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fastjoint::input {

/// A parsed JSON text. Duplicate keys are rejected; // and /* */ comments are allowed.
struct Document {
  std::string file;  ///< name for messages
  std::string text;  ///< as read
  std::shared_ptr<const nlohmann::json> root;
};

/// Contents of a regular file. Throws FileError with the path and the reason.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Throws InputError if the file holds UTF-16, or bytes of value 0, after which the libraries that read it would stop.
void check_is_text(const std::string& file, const std::string& text);

/// Throws InputError naming the file, line and column of the first mistake.
[[nodiscard]] Document parse(const std::string& file, const std::string& text);

/// An interval of allowed numbers; infinite limits are open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
  bool high_allowed = true;
};
inline constexpr Range any_number{};
inline constexpr Range positive{.low = 0, .low_allowed = false};
inline constexpr Range not_negative{.low = 0};

/// Sizes of numbers other than 0 in any input, in any unit: products of three of them stay within what a double holds.
inline constexpr double smallest_number = 1e-100, largest_number = 1e100;
[[nodiscard]] bool has_allowed_size(double x);

/// A JSON value and its place in the document. Every accessor is strict: a value that is not allowed throws InputError
/// with the file, the JSON pointer, what was found and what is allowed.
class Value {
 public:
  explicit Value(const Document& document);

  [[nodiscard]] bool is_object() const;
  [[nodiscard]] bool is_array() const;
  [[nodiscard]] bool is_number() const;
  [[nodiscard]] bool is_string() const;

  /// Checks that this is an object with no other keys than these.
  const Value& only(std::initializer_list<const char*> allowed) const;
  [[nodiscard]] Value at(const char* key) const;
  [[nodiscard]] std::optional<Value> find(const char* key) const;
  /// Members of an object in the order of their names; keys must not be empty.
  [[nodiscard]] std::vector<std::pair<std::string, Value>> members() const;
  /// Elements of an array of at least `min` and at most `max` elements.
  [[nodiscard]] std::vector<Value> items(std::size_t min = 0,
                                         std::size_t max = std::numeric_limits<std::size_t>::max()) const;

  [[nodiscard]] double number(const Range& range = any_number) const;
  [[nodiscard]] std::vector<double> numbers(std::size_t min, std::size_t max, const Range& range) const;
  [[nodiscard]] int integer(int low, int high) const;
  [[nodiscard]] bool boolean() const;
  /// A string that is not empty.
  [[nodiscard]] std::string text() const;
  /// One of these strings.
  [[nodiscard]] std::string choice(const std::vector<std::string>& allowed) const;

  /// "FILE: POINTER: `found`; allowed: `allowed`"
  [[noreturn]] void fail(const std::string& found, const std::string& allowed) const;
  /// Fails with this value as `found`.
  [[noreturn]] void not_allowed(const std::string& allowed) const;
  [[nodiscard]] const std::string& pointer() const { return pointer_; }
  /// Path of the document, to which paths in it are relative.
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  Value(const Value& parent, const nlohmann::json& value, const std::string& key);
  [[nodiscard]] std::string shown() const;

  std::string file_;
  std::string pointer_;
  std::shared_ptr<const nlohmann::json> root_;
  const nlohmann::json* json_;
};

/// Checks `"format": format, "version": 1`, and that `"$schema"`, if given, is a string.
void check_format(const Value& root, const std::string& format);

}  // namespace fastjoint::input
