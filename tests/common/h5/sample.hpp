// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "common/errors.hpp"
#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::h5 {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

inline const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished();

/// Every kind of value that a dataset can be.
struct Sample {
  struct Item {
    int number;
    double from, to;
    Eigen::Vector2d place;
    std::string name;
    friend bool operator==(const Item&, const Item&) = default;
  };
  std::string name;
  bool complete = false;
  Eigen::MatrixXd matrix, transpose, folded;
  Eigen::VectorXd vector;
  Eigen::VectorXi integers;
  Eigen::MatrixXi integer_matrix;
  std::vector<Eigen::MatrixXd> stack, nothing;
  std::vector<Rows> row_stack, no_rows;
  std::vector<Eigen::Matrix2d> fixed;
  std::vector<std::string> names;
  std::string text;
  double number = 0;
  std::vector<Item> items;
  friend bool operator==(const Sample&, const Sample&) = default;
};

template <class File, class AnySample>
void datasets(File& file, AnySample& a) {
  file.attribute("name", a.name);
  file.attribute("complete", a.complete);
  file("group/A", a.matrix, {2, 3}, "N/mm", "a matrix");
  file("v", a.vector, {some}, "mm", "a vector");
  file("group/deep/i", a.integers, {any}, "1", "integers");
  file("I", a.integer_matrix, {2, 2}, "1", "integer matrix");
  file("stack", a.stack, {any, 2, 3}, "1", "two matrices");
  file("nothing", a.nothing, {any, 4, 2}, "1", "no matrices");
  file("row_stack", a.row_stack, {any, 2, 3}, "1", "two matrices that are row-major");
  file("no_rows", a.no_rows, {any, 4, 2}, "1", "no matrices");
  file("fixed", a.fixed, {any, 2, 2}, "1", "matrices of fixed size");
  file("B", a.transpose.transpose(), {3, 2}, "1", "A transposed");
  file("folded", a.folded, {2, 3, 1}, "1", "a matrix of three extents");
  file("names", a.names, {any}, "1", "strings");
  file("text", a.text, {}, "1", "a text");
  file("number", a.number, {1}, "1", "a number");
  file("item/number", Column{a.items, &Sample::Item::number}, {any}, "1", "a member");
  file("item/range", Column{a.items, [](auto& item) { return std::tie(item.from, item.to); }}, {2, 2}, "1", "two");
  file("item/place", Column{a.items, &Sample::Item::place}, {2, 2}, "1", "a vector in each");
  file("item/name", Column{a.items, &Sample::Item::name}, {2}, "1", "a text in each");
}

inline Sample sample() {
  Sample a;
  a.name = "n\u00e4me";
  a.complete = true;
  a.matrix = a.transpose = A;
  a.folded = 3 * A;
  a.vector = A.row(1);
  a.integers = Eigen::VectorXi::LinSpaced(2, 7, 8);
  a.integer_matrix = (Eigen::Matrix2i() << 1, 2, 3, 4).finished();
  a.stack = {A, 2 * A};
  a.row_stack = {2 * A, A};
  a.fixed = {A.leftCols(2), A.rightCols(2)};
  a.names = {"one", "", "dr\u00fci"};
  a.text = "{}";
  a.number = 0.25;
  a.items = {{1, 2, 3, {4, 5}, "six"}, {7, 8, 9, {10, 11}, ""}};
  return a;
}

inline void write_sample(const std::string& path, int major = 1) {
  Writer file(path, {"sample", major, 2});
  const Sample a = sample();
  datasets(file, a);
  file.commit();
}

/// Reads a dataset and forgets it.
template <class Value>
void read(const Reader& file, const std::string& name, const Shape& shape, const std::string& unit = "1") {
  Value value;
  file(name, value, shape, unit, "");
}

/// A file "a.h5" with something wrong, and what a reader says of it.
class WrongFile : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.path("a.h5");

  std::string message(
      const std::function<void(const Reader&)>& read = [](const Reader&) {}, const Format& format = {"sample", 1, 0}) {
    try {
      read(Reader(path_, format));
    } catch (const FileError& e) {
      return e.what();
    }
    return "no error";
  }
};

}  // namespace fastjoint::h5
