// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <concepts>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace fastjoint::h5 {

/// A kind of file and its version: readers take any minor version of their major one.
struct Format {
  std::string name;
  int major, minor;
};

/// Extents of a dataset.
using Shape = std::vector<Eigen::Index>;
/// Placeholders for the first extent of an expected shape: any extent, or any extent but 0.
inline constexpr Eigen::Index any = -1, some = -2;

/// A dataset made of one member of every item of a list.
///
/// @tparam Member A pointer to the member, or a function from an item to a reference, or to a std::tie of some.
template <class List, class Member>
struct Column {
  List& list;
  Member member;
};
template <class List, class Member>
Column(List&, Member) -> Column<List, Member>;

// Types of values that can be datasets: a number, a text, an Eigen matrix, vector or transpose of one, a Column, tuples
// of entries, and lists of all these.
template <class T>
concept Entry = std::is_arithmetic_v<T> || std::same_as<T, std::string>;
template <class T>
concept Matrix = requires(const T& a) {
  a.rows();
};
template <class T>
concept RowMajor = Matrix<T> &&(bool(T::IsRowMajor) || bool(T::IsVectorAtCompileTime));
template <class T>
concept Stack = !Matrix<T> && std::ranges::range<T> && RowMajor<std::ranges::range_value_t<T>> &&
                std::ranges::range_value_t<T>::SizeAtCompileTime == Eigen::Dynamic;
template <class T>
concept ColumnOfList = requires(const T& a) {
  a.member;
};
template <class T>
concept Tuple = requires {
  std::tuple_size<T>::value;
};

/// Calls each(entry) in the order of the file, where the last index varies fastest.
template <class T, class Each>
void for_each_entry(T&& value, const Each& each) {
  using Value = std::remove_cvref_t<T>;
  if constexpr (Entry<Value>) {
    each(value);
  } else if constexpr (Matrix<Value>) {
    for (Eigen::Index i = 0; i < value.rows(); ++i)
      for (Eigen::Index j = 0; j < value.cols(); ++j) each(value(i, j));
  } else if constexpr (ColumnOfList<Value>) {
    for (auto& item : value.list) for_each_entry(std::invoke(value.member, item), each);
  } else if constexpr (Tuple<Value>) {
    std::apply([&](auto&... entry) { (each(entry), ...); }, value);
  } else {
    for (auto& item : value) for_each_entry(item, each);
  }
}

template <class T>
auto entry_of() {
  if constexpr (Entry<T>) {
    return T();
  } else if constexpr (Matrix<T>) {
    return typename T::Scalar();
  } else if constexpr (ColumnOfList<T>) {
    using Item = decltype(*std::begin(std::declval<T>().list));
    return entry_of<std::remove_cvref_t<std::invoke_result_t<decltype(T::member), Item>>>();
  } else if constexpr (Tuple<T>) {
    return entry_of<std::remove_cvref_t<std::tuple_element_t<0, T>>>();
  } else {
    return entry_of<typename T::value_type>();
  }
}
/// Type of the entries of a value: double, int or std::string.
template <class T>
using EntryOf = decltype(entry_of<std::remove_cvref_t<T>>());

/// The memory of a value with the layout of the file: a row-major matrix, a list of such (one span for each), or a list
/// of numbers or texts.
template <class Scalar, class T>
std::vector<std::span<Scalar>> spans(T& value) {
  if constexpr (Stack<T>) {
    std::vector<std::span<Scalar>> result;
    for (auto& item : value) result.emplace_back(item.data(), item.size());
    return result;
  } else {
    return {{value.data(), static_cast<std::size_t>(value.size())}};
  }
}

/// First extent of a value.
template <class T>
Eigen::Index first_extent(const T& value) {
  if constexpr (Matrix<T>)
    return value.rows();
  else if constexpr (ColumnOfList<T>)
    return std::ssize(value.list);
  else if constexpr (Entry<T>)
    return 1;
  else
    return std::ssize(value);
}

/// Resizes a value to the extents of a dataset from the k-th on; in a matrix, all extents after its first become
/// columns.
template <class T>
void resize(T&& value, const Shape& shape, std::size_t k = 0) {
  using Value = std::remove_cvref_t<T>;
  if constexpr (Matrix<Value>) {
    Eigen::Index cols = 1;
    for (std::size_t i = k + 1; i < shape.size(); ++i) cols *= shape[i];
    value.resize(shape[k], cols);
  } else if constexpr (ColumnOfList<Value>) {
    value.list.resize(shape[k]);
    for (auto& item : value.list) resize(std::invoke(value.member, item), shape, k + 1);
  } else if constexpr (!Entry<Value> && !Tuple<Value>) {
    value.resize(shape[k]);
    for (auto& item : value) resize(item, shape, k + 1);
  }
}

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// The entries that a reader accepts in a dataset, and the default entry of a dataset that a file omits.
struct Allowed {
  std::string text = "finite numbers";  ///< description for messages
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
  double step = -infinite;                          ///< minimum difference between a number and the one before
  std::optional<std::vector<std::string>> words{};  ///< allowed texts; any text if empty
  std::optional<double> number{};                   ///< default for numbers
  std::optional<std::string> word{};                ///< default for texts
  bool may_be_nan = false;                          ///< for what is not known

  [[nodiscard]] Allowed or_else(double default_number) const {
    Allowed result = *this;
    result.number = default_number;
    return result;
  }
};

inline const Allowed infinite_too{.text = "numbers", .low = -infinite, .high = infinite};
inline const Allowed nan_too{.text = "finite numbers or NaN", .may_be_nan = true};
inline const Allowed not_negative{.text = "numbers >= 0", .low = 0, .high = infinite};
inline const Allowed positive{.text = "numbers > 0", .low = std::numeric_limits<double>::min()};

[[nodiscard]] inline Allowed or_else(double number) { return {.number = number}; }
[[nodiscard]] inline Allowed or_else(const std::string& word) { return {.word = word}; }
[[nodiscard]] inline Allowed one_of(const std::vector<std::string>& words) {
  return {.text = fmt::format("one of {}", fmt::join(words, ", ")), .words = words};
}
[[nodiscard]] inline Allowed integers(Eigen::Index low, Eigen::Index high) {
  return {.text = fmt::format("integers from {} to {}", low, high),
          .low = static_cast<double>(low),
          .high = static_cast<double>(high)};
}
/// Indices into a list of n items.
[[nodiscard]] inline Allowed index_into(Eigen::Index n) { return integers(0, n - 1); }

}  // namespace fastjoint::h5
