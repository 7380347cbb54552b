// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/h5/entries.hpp"

namespace fastjoint::h5 {

/// An HDF5 file opened for reading; its seal, kind and major version are checked first.
///
/// Every read checks type class, shape, unit and entries and throws FileError with the file, the dataset, what was
/// found and what was expected. The attribute `unit` of a dataset is optional, and so are datasets without entries.
class Reader {
 public:
  static constexpr bool reads = true;

  Reader(std::string path, const Format& format);
  ~Reader();

  [[nodiscard]] const std::string& path() const;
  /// Digest in the seal of the file; empty if it has none.
  [[nodiscard]] const std::string& digest() const;
  /// Sets whether units are compared; by default they are.
  void compare_units(bool compare);
  [[nodiscard]] bool has(const std::string& dataset) const;

  [[nodiscard]] int integer_attribute(const std::string& name) const;
  /// Root attribute; a missing one leaves the text unchanged.
  void attribute(const std::string& name, std::string& text) const;
  template <std::integral T>
  void attribute(const std::string& name, T& value) const {
    value = integer_attribute(name);
  }

  /// Reads one dataset and resizes the value to it.
  template <class T>
  void operator()(const std::string& name, T&& value, const Shape& expected, const std::string& unit,
                  const std::string& /*meaning*/, const Allowed& allowed = {}) const {
    using Scalar = EntryOf<T>;
    if constexpr (RowMajor<std::remove_cvref_t<T>> || Stack<std::remove_cvref_t<T>>) {  // avoids a copy of large data
      get<Scalar>(name, expected, unit, allowed, [&](const Shape& shape) {
        resize(value, shape);
        return spans<Scalar>(value);
      });
    } else {
      std::vector<Scalar> entries;
      get<Scalar>(name, expected, unit, allowed, [&](const Shape& shape) {
        resize(value, shape);
        entries.resize(std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()));
        return spans<Scalar>(entries);
      });
      auto next = entries.begin();
      for_each_entry(value, [&](auto& entry) { entry = std::move(*next++); });
    }
  }

 private:
  struct Impl;
  /// Allocates memory for the entries of a dataset of a shape, of which each span takes an equal part.
  template <class Scalar>
  using MakeRoom = std::function<std::vector<std::span<Scalar>>(const Shape&)>;
  // Scalar is double, int or std::string.
  template <class Scalar>
  void get(const std::string& name, const Shape& expected, const std::string& unit, const Allowed& allowed,
           const MakeRoom<Scalar>& make_room) const;

  std::unique_ptr<Impl> impl_;
};

}  // namespace fastjoint::h5
