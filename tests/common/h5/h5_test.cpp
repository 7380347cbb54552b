// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <hdf5.h>

#include <filesystem>
#include <functional>
#include <limits>

#include "common/errors.hpp"
#include "common/h5/reader.hpp"
#include "common/h5/seal.hpp"
#include "common/h5/writer.hpp"
#include "tests/support/files.hpp"

namespace fastjoint::h5 {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

const Eigen::MatrixXd A = (Eigen::MatrixXd(2, 3) << 1, 2, 3, 4, 5, 6).finished();

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
  std::vector<Eigen::Matrix2d> fixed;
  std::vector<std::string> names;
  std::string text;
  double number = 0;
  std::optional<Eigen::VectorXd> given, absent;
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
  file("fixed", a.fixed, {any, 2, 2}, "1", "matrices of fixed size");
  file("B", a.transpose.transpose(), {3, 2}, "1", "A transposed");
  file("folded", a.folded, {2, 3, 1}, "1", "a matrix of three extents");
  file("names", a.names, {any}, "1", "strings");
  file("text", a.text, {}, "1", "a text");
  file("number", a.number, {1}, "1", "a number");
  if (auto* given = file.part("given", a.given)) file("given", *given, {any}, "1", "there");
  if (auto* absent = file.part("absent", a.absent)) file("absent", *absent, {any}, "1", "not there");
  file("item/number", Column{a.items, &Sample::Item::number}, {any}, "1", "a member");
  file("item/range", Column{a.items, [](auto& item) { return std::tie(item.from, item.to); }}, {2, 2}, "1", "two");
  file("item/place", Column{a.items, &Sample::Item::place}, {2, 2}, "1", "a vector in each");
  file("item/name", Column{a.items, &Sample::Item::name}, {2}, "1", "a text in each");
}

Sample sample() {
  Sample a;
  a.name = "n\u00e4me";
  a.complete = true;
  a.matrix = a.transpose = A;
  a.folded = 3 * A;
  a.vector = A.row(1);
  a.integers = Eigen::VectorXi::LinSpaced(2, 7, 8);
  a.integer_matrix = (Eigen::Matrix2i() << 1, 2, 3, 4).finished();
  a.stack = {A, 2 * A};
  a.fixed = {A.leftCols(2), A.rightCols(2)};
  a.names = {"one", "", "dr\u00fci"};
  a.text = "{}";
  a.number = 0.25;
  a.given = A.row(0);
  a.items = {{1, 2, 3, {4, 5}, "six"}, {7, 8, 9, {10, 11}, ""}};
  return a;
}

void write_sample(const std::string& path, int major = 1) {
  Writer file(path, "sample", major, 2);
  const Sample a = sample();
  datasets(file, a);
  file.commit();
}

TEST(Hdf5, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  Reader file(folder.path("a.h5"), "sample", 1);
  Sample a;
  datasets(file, a);
  EXPECT_TRUE(a == sample());
  EXPECT_EQ(a.items, sample().items);
  EXPECT_EQ(file.text_attribute("absent", "otherwise"), "otherwise");
  Eigen::MatrixXd transposed, folded;
  file("B", transposed, {3, 2}, "1", "");
  EXPECT_EQ(transposed, A.transpose());
  file("item/range", folded, {2, 2}, "1", "");
  EXPECT_EQ(folded, (Eigen::Matrix2d() << 2, 3, 8, 9).finished()) << "the last index is the innermost";
  EXPECT_TRUE(file.has("group/A"));
  EXPECT_FALSE(file.has("group/Z"));
  EXPECT_FALSE(file.has("none/A"));
}

TEST(Hdf5, WhatIsMissingIsWhatStandsInForIt) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  const Reader file(folder.path("a.h5"), "sample", 1);
  Eigen::MatrixXd matrix;
  file("none", matrix, {2, 3}, "1", "", or_else(infinite));
  EXPECT_EQ(matrix, Eigen::MatrixXd::Constant(2, 3, infinite));
  file("none", matrix, {0, 3}, "1", "");
  EXPECT_EQ(matrix.rows(), 0);
  EXPECT_EQ(matrix.cols(), 3);
  std::vector<std::string> texts;
  file("none", texts, {2}, "1", "", or_else("x"));
  EXPECT_EQ(texts, (std::vector<std::string>{"x", "x"}));
  file("none", texts, {any}, "1", "", or_else("x"));
  EXPECT_TRUE(texts.empty());
}

TEST(Hdf5, EqualCallsGiveEqualBytes) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  write_sample(folder.path("b.h5"));
  EXPECT_EQ(test::read_file(folder.path("a.h5")), test::read_file(folder.path("b.h5")));
}

TEST(Hdf5, LeaksNoHandle) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  { EXPECT_THROW(Reader(folder.path("a.h5"), "other", 1), FileError); }
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

TEST(Hdf5, ANaNIsNeverWritten) {
  const test::TemporaryFolder folder;
  Writer file(folder.path("a.h5"), "sample", 1, 0);
  EXPECT_THAT(
      [&] {
        file("x", std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}, {any}, "1", "");
      },
      ThrowsMessage<NumericalError>(HasSubstr("x would hold a NaN")));
}

using Eigen::MatrixXd, Eigen::VectorXd, Eigen::VectorXi;
using Stack = std::vector<MatrixXd>;

template <class Value>
void read(const Reader& file, const std::string& name, const Shape& shape, const std::string& unit = "1") {
  Value value;
  file(name, value, shape, unit, "");
}

class WrongFile : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string path_ = folder_.path("a.h5");

  std::string message(
      const std::function<void(const Reader&)>& read = [](const Reader&) {}, const std::string& format = "sample",
      int major = 1) {
    try {
      read(Reader(path_, format, major));
    } catch (const FileError& e) {
      return e.what();
    }
    return "no error";
  }
};

TEST_F(WrongFile, Kinds) {
  EXPECT_THAT(message(), HasSubstr("a.h5: cannot be opened: No such file or directory"));
  path_ = folder_.write("a.h5", "not HDF5");
  EXPECT_THAT(message(), HasSubstr("a.h5: is not an HDF5 file (expected a 'sample' file)"));
  path_ = folder_.write("a.h5", "");
  EXPECT_THAT(message(), HasSubstr("is not an HDF5 file"));
  write_sample(path_);
  EXPECT_THAT(message([](const Reader&) {}, "plate"), HasSubstr("a.h5: is a 'sample' file, expected 'plate'"));
  path_ = folder_.path(".");
  EXPECT_THAT(message(), HasSubstr("is not a regular file"));
}

TEST_F(WrongFile, Versions) {
  write_sample(path_, 2);
  EXPECT_THAT(message(), HasSubstr("a.h5: format version 2.2, this program reads 1.x; use a newer program"));
  EXPECT_THAT(message([](const Reader&) {}, "sample", 3), HasSubstr("run the earlier stage again"));
}

TEST_F(WrongFile, TruncatedAnywhere) {
  write_sample(path_);
  const std::string whole = test::read_file(path_);
  const std::size_t n_image = whole.rfind("\nfastjoint xxhash ");
  for (std::size_t n = 0; n < n_image; n += whole.size() / 37) {
    folder_.write("a.h5", whole.substr(0, n));
    EXPECT_NE(message([](const Reader& f) {
                read<MatrixXd>(f, "group/A", {2, 3}, "N/mm");
              }),
              "no error")
        << n << " bytes";
  }
}

/// Single bits flipped all over the file, HDF5's own structures included, where the library would crash.
TEST_F(WrongFile, DamagedAnywhere) {
  write_sample(path_);
  const std::string whole = test::read_file(path_);
  const std::size_t n_image = whole.rfind("\nfastjoint xxhash ");
  ASSERT_NE(n_image, std::string::npos);
  for (std::size_t i = 0; i < n_image; i += 7) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << i % 8));
    folder_.write("a.h5", damaged);
    ASSERT_THAT(message(), HasSubstr("a.h5: is damaged: its bytes do not match their digest")) << "byte " << i;
  }
}

/// Changes that a digest of eight-byte words by multiplication does not spread: pairs of flips of the same high bit.
TEST_F(WrongFile, DamagedByPairsOfHighBits) {
  write_sample(path_);
  const std::string whole = test::read_file(path_);
  constexpr std::size_t word = 8;
  for (const char flip : {'\x80', '\x40'})
    for (std::size_t first = word - 1; first < 20 * word; first += word)
      for (std::size_t second = first + word; second < 40 * word; second += 7 * word) {
        std::string damaged = whole;
        damaged[first] = static_cast<char>(damaged[first] ^ flip);
        damaged[second] = static_cast<char>(damaged[second] ^ flip);
        folder_.write("a.h5", damaged);
        ASSERT_THAT(message(), HasSubstr("its bytes do not match their digest")) << first << ", " << second;
      }
}

TEST_F(WrongFile, SealedByAnEarlierVersionIsRefused) {
  write_sample(path_);
  std::string whole = test::read_file(path_);
  whole.replace(whole.rfind("xxhash"), 6, "digest");
  folder_.write("a.h5", whole);
  EXPECT_THAT(message(), AllOf(HasSubstr("has the digest of an earlier version"), HasSubstr("h5repack"),
                               HasSubstr("a.h5 NEW.h5")));
}

TEST_F(WrongFile, WithADamagedSealIsRefused) {
  write_sample(path_);
  const std::string whole = test::read_file(path_), mark = "\nfastjoint xxhash ";
  const std::size_t at = whole.rfind(mark);
  std::vector<std::string> damaged = {whole + "x", whole + whole.substr(at)};
  for (std::size_t cut = 1; cut <= 24; ++cut) damaged.push_back(whole.substr(0, whole.size() - cut));
  for (std::size_t i = 0; i < mark.size(); ++i) {
    damaged.push_back(whole);
    damaged.back()[at + i] ^= 1;
  }
  for (std::size_t i = 0; i < damaged.size(); ++i) {
    folder_.write("a.h5", damaged[i]);
    EXPECT_THAT(message(), HasSubstr("a.h5: is damaged")) << i;
  }
}

TEST_F(WrongFile, WithoutSealItIsTakenAsItIs) {
  write_sample(path_);
  const std::string whole = test::read_file(path_);
  folder_.write("a.h5", whole.substr(0, whole.rfind("\nfastjoint xxhash ")));
  EXPECT_EQ(message([](const Reader& f) { read<MatrixXd>(f, "group/A", {2, 3}, "N/mm"); }), "no error");
  EXPECT_EQ(Reader(path_, "sample", 1).digest(), "");
}

/// The digest is xxHash's: that of no bytes is in its documentation.
TEST(Digest, IsThatOfTheFile) {
  EXPECT_EQ(digest(""), "2d06800538d394c2");
  const test::TemporaryFolder folder;
  Writer file(folder.path("a.h5"), "sample", 1, 0);
  const std::string written = file.commit();
  EXPECT_EQ(Reader(folder.path("a.h5"), "sample", 1).digest(), written);
  const std::string whole = test::read_file(folder.path("a.h5"));
  EXPECT_EQ(digest(whole.substr(0, whole.rfind("\nfastjoint"))), written);
}

TEST_F(WrongFile, ShapesUnitsTypes) {
  write_sample(path_);
  EXPECT_THAT(message([](const Reader& f) { read<VectorXd>(f, "absent", {any}); }),
              HasSubstr("a.h5:absent: dataset is missing or damaged"));
  EXPECT_THAT(message([](const Reader& f) {
                read<MatrixXd>(f, "group/A", {3, any}, "N/mm");
              }),
              HasSubstr("group/A: shape is (2, 3), expected (3, any)"));
  EXPECT_THAT(message([](const Reader& f) { read<VectorXd>(f, "group/A", {6}, "N/mm"); }), HasSubstr("expected (6)"));
  EXPECT_THAT(message([](const Reader& f) {
                read<Stack>(f, "nothing", {some, 4, 2});
              }),
              HasSubstr("nothing: shape is (0, 4, 2), expected (at least 1, 4, 2)"));
  EXPECT_THAT(message([](const Reader& f) {
                read<MatrixXd>(f, "group/A", {2, 3}, "N/m");
              }),
              HasSubstr("unit is 'N/mm', expected 'N/m'"));
  EXPECT_THAT(message([](const Reader& f) { read<VectorXi>(f, "v", {3}); }), HasSubstr("type is not integer"));
  EXPECT_THAT(message([](const Reader& f) { read<VectorXd>(f, "group/deep/i", {2}); }),
              HasSubstr("type is not floating point"));
  EXPECT_THAT(message([](const Reader& f) { read<std::vector<std::string>>(f, "v", {3}); }),
              HasSubstr("type is not string"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.integer_attribute("nothing"); }),
              HasSubstr("'nothing' is missing"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.integer_attribute("version"); }),
              HasSubstr("attribute 'version' is missing or not one integer"));
}

TEST_F(WrongFile, UnitsAreNotComparedWhenToldSo) {
  write_sample(path_);
  Reader file(path_, "sample", 1);
  file.compare_units(false);
  EXPECT_NO_THROW(read<MatrixXd>(file, "group/A", {2, 3}, "N/m"));
}

TEST_F(WrongFile, EntriesThatAreNotAllowed) {
  Writer file(path_, "sample", 1, 0);
  file("x", std::vector<double>{1, infinite, -1}, {any}, "1", "");
  file("i", std::vector<int>{2, 4, 4}, {any}, "1", "");
  file("words", std::vector<std::string>{"x", "z"}, {any}, "1", "");
  file.commit();
  const auto refused = [&](auto value, const char* name, const Allowed& allowed) {
    return message([&](const Reader& f) { f(name, value, {any}, "1", "", allowed); });
  };
  const Eigen::VectorXd x;
  const Eigen::VectorXi i;
  const std::vector<std::string> words;
  EXPECT_THAT(refused(x, "x", {}), HasSubstr("a.h5:x: holds inf, expected finite numbers"));
  EXPECT_EQ(refused(x, "x", infinite_too), "no error");
  EXPECT_THAT(refused(x, "x", not_negative), HasSubstr("x: holds -1, expected numbers >= 0"));
  EXPECT_EQ(refused(i, "i", integers(2, 4)), "no error");
  EXPECT_THAT(refused(i, "i", index_into(4)), HasSubstr("i: holds 4, expected integers from 0 to 3"));
  EXPECT_THAT(refused(i, "i", integers(3, 4)), HasSubstr("i: holds 2, expected integers from 3 to 4"));
  EXPECT_EQ(refused(i, "i", {.step = 0}), "no error");
  EXPECT_THAT(refused(i, "i", {.text = "others", .step = 1}), HasSubstr("i: holds 4, 4, expected others"));
  EXPECT_THAT(refused(words, "words", one_of({"x", "y"})), HasSubstr("words: holds \"z\", expected one of x, y"));
  EXPECT_THAT(refused(words, "words", {.text = "none", .words = {{}}}), HasSubstr("holds \"x\", expected none"));
  EXPECT_THAT(message([](const Reader& f) {
                f.check("later", std::vector<int>{0, 5}, index_into(5));
              }),
              HasSubstr("a.h5:later: holds 5, expected integers from 0 to 4"));
}

TEST_F(WrongFile, EntriesThatDoNotMakeTheShapeAreNotWritten) {
  Writer file(path_, "sample", 1, 0);
  EXPECT_THAT(
      [&] {
        file("A", A, {3, 3}, "1", "");
      },
      ThrowsMessage<std::logic_error>(HasSubstr("a.h5:A: 6 entries do not make the shape (3, 3)")));
}

}  // namespace
}  // namespace fastjoint::h5
