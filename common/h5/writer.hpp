// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "common/h5/entries.hpp"

namespace fastjoint::h5 {

/// An HDF5 file that is written atomically (commit).
///
/// Writer and Reader have the same interface, so that one function template lists the datasets of a format for both.
/// Groups are created as needed. Equal calls give equal bytes. Arrays are row-major in the file: a matrix A is stored
/// with shape (rows, cols). Throws NumericalError for a NaN, and for an infinite number where a reader refuses it;
/// FileError for other failures.
class Writer {
 public:
  static constexpr bool reads = false;

  Writer(const std::string& path, const Format& format);
  ~Writer();

  void attribute(const std::string& name, const std::string& text);
  void attribute(const std::string& name, int value);

  /// Writes one dataset.
  ///
  /// @param shape Extents; `any` and `some` stand for the first extent of the value.
  /// @param unit "1" if dimensionless.
  /// @param meaning One sentence.
  /// @param allowed What a reader accepts; of it the writer checks whether entries may be infinite or NaN.
  template <class T>
  void operator()(const std::string& name, const T& value, Shape shape, const std::string& unit,
                  const std::string& meaning, const Allowed& allowed = {}) {
    using Scalar = EntryOf<T>;
    if (!shape.empty() && shape[0] < 0) shape[0] = first_extent(value);
    if constexpr (RowMajor<T> || Stack<T>) {  // avoids a copy of large data
      put(name, shape, spans<const Scalar>(value), unit, meaning, allowed);
    } else {
      std::vector<Scalar> entries;
      entries.reserve(std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>()));
      for_each_entry(value, [&](const auto& entry) { entries.push_back(entry); });
      put(name, shape, spans<const Scalar>(entries), unit, meaning, allowed);
    }
  }

  /// Creates a dataset of numbers, double or int, to be filled by `rows`, so that it need not fit in memory. Only these
  /// numbers may be NaN.
  template <class Scalar>
  void make_rows(const std::string& name, const Shape& shape, const std::string& unit, const std::string& meaning);
  /// Writes rows of such a dataset, beginning with row `first`; `values` are row-major over all columns.
  template <class Scalar>
  void rows(const std::string& name, std::size_t first, std::span<const Scalar> values);

  /// Puts the file at its path and returns its digest.
  std::string commit();

 private:
  struct Impl;
  // Scalar is double, int or std::string.
  template <class Scalar>
  void put(const std::string& name, const Shape& shape, const std::vector<std::span<const Scalar>>& parts,
           const std::string& unit, const std::string& meaning, const Allowed& allowed);

  std::unique_ptr<Impl> impl_;
};

}  // namespace fastjoint::h5
