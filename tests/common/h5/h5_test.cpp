// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include <hdf5.h>

#include <functional>
#include <limits>

#include "common/errors.hpp"
#include "common/h5/reader.hpp"
#include "common/h5/writer.hpp"
#include "tests/common/h5/sample.hpp"

namespace fastjoint::h5 {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd, Eigen::VectorXi;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Stack = std::vector<MatrixXd>;

TEST(Hdf5, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  Reader file(folder.path("a.h5"), {"sample", 1, 0});
  Sample a;
  datasets(file, a);
  EXPECT_TRUE(a == sample());
  EXPECT_EQ(a.items, sample().items);
  std::string absent = "otherwise";
  file.attribute("absent", absent);
  EXPECT_EQ(absent, "otherwise");
  MatrixXd transposed, folded;
  file("B", transposed, {3, 2}, "1", "");
  EXPECT_EQ(transposed, A.transpose());
  file("item/range", folded, {2, 2}, "1", "");
  Stack columns;
  file("row_stack", columns, {2, 2, 3}, "1", "");
  EXPECT_EQ(columns, (Stack{2 * A, A})) << "row-major in the file, as all are";
  EXPECT_EQ(folded, (Eigen::Matrix2d() << 2, 3, 8, 9).finished()) << "the last index is the innermost";
  EXPECT_TRUE(file.has("group/A"));
  EXPECT_FALSE(file.has("group/Z"));
  EXPECT_FALSE(file.has("none/A"));
}

TEST(Hdf5, WhatIsMissingIsWhatStandsInForIt) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  const Reader file(folder.path("a.h5"), {"sample", 1, 0});
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
  { EXPECT_THROW(Reader(folder.path("a.h5"), {"other", 1, 0}), FileError); }
  EXPECT_EQ(H5Fget_obj_count(static_cast<hid_t>(H5F_OBJ_ALL), H5F_OBJ_ALL), 0);
}

TEST(Hdf5, ANaNIsNeverWritten) {
  const test::TemporaryFolder folder;
  Writer file(folder.path("a.h5"), {"sample", 1, 0});
  EXPECT_THAT(
      [&] {
        file("x", std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}, {any}, "1", "");
      },
      ThrowsMessage<NumericalError>(HasSubstr("x would hold a NaN")));
}

TEST(Hdf5, AnInfiniteNumberIsWrittenOnlyWhereItIsRead) {
  const test::TemporaryFolder folder;
  Writer file(folder.path("a.h5"), {"sample", 1, 0});
  const std::vector<double> x{1, -std::numeric_limits<double>::infinity()};
  file("allowed", x, {any}, "1", "", infinite_too);
  EXPECT_THAT([&] { file("x", x, {any}, "1", ""); },
              ThrowsMessage<NumericalError>(HasSubstr("x would hold a number beyond 1.8e308; the input has")));
}

TEST_F(WrongFile, Kinds) {
  EXPECT_THAT(message(), HasSubstr("a.h5: cannot be opened: No such file or directory"));
  path_ = folder_.write("a.h5", "not HDF5");
  EXPECT_THAT(message(), HasSubstr("a.h5: is not an HDF5 file (expected a 'sample' file)"));
  path_ = folder_.write("a.h5", "");
  EXPECT_THAT(message(), HasSubstr("is not an HDF5 file"));
  write_sample(path_);
  EXPECT_THAT(message([](const Reader&) {}, {"plate", 1, 0}), HasSubstr("a.h5: is a 'sample' file, expected 'plate'"));
  path_ = folder_.path(".");
  EXPECT_THAT(message(), HasSubstr("is not a regular file"));
}

TEST_F(WrongFile, Versions) {
  write_sample(path_, 2);
  EXPECT_THAT(message(), HasSubstr("a.h5: format version 2.2, this program reads 1.x; use a newer program"));
  EXPECT_THAT(message([](const Reader&) {}, {"sample", 3, 0}), HasSubstr("run the earlier stage again"));
}

TEST_F(WrongFile, ShapesUnitsTypes) {
  write_sample(path_);
  EXPECT_THAT(message([](const Reader& f) { read<VectorXd>(f, "absent", {any}); }),
              HasSubstr("a.h5:absent: dataset is missing"));
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
  Reader file(path_, {"sample", 1, 0});
  file.compare_units(false);
  EXPECT_NO_THROW(read<MatrixXd>(file, "group/A", {2, 3}, "N/m"));
}

TEST_F(WrongFile, EntriesThatAreNotAllowed) {
  Writer file(path_, {"sample", 1, 0});
  file("x", std::vector<double>{1, infinite, -1}, {any}, "1", "", infinite_too);
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
}

/// Puts a dataset "v" of three numbers into a file in another way than the writer's.
void replace_v(const std::string& path, const std::function<void(hid_t creation, hid_t file)>& store, hsize_t n = 3) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), creation = H5Pcreate(H5P_DATASET_CREATE);
  H5Ldelete(file, "v", H5P_DEFAULT);
  store(creation, file);
  if (H5Lexists(file, "v", H5P_DEFAULT) == 0) {
    const hid_t space = H5Screate_simple(1, &n, nullptr);
    H5Dclose(H5Dcreate2(file, "v", H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Sclose(space);
  }
  H5Pclose(creation);
  H5Fclose(file);
}

TEST_F(WrongFile, ValuesThatAreNotInTheFile) {
  const auto refused = [&](const std::function<void(hid_t, hid_t)>& store) {
    write_sample(path_);
    replace_v(path_, store);
    return message([](const Reader& f) { read<VectorXd>(f, "v", {some}, "mm"); });
  };
  const std::string elsewhere = folder_.write("other", std::string(24, 'x'));
  const std::string message = "a.h5:v: its values are in another file or dataset";
  EXPECT_THAT(refused([&](hid_t creation, hid_t) { H5Pset_external(creation, elsewhere.c_str(), 0, 24); }),
              HasSubstr(message));
  EXPECT_THAT(refused([&](hid_t creation, hid_t) {  // its own source: to read it never ended
                const hsize_t n = 3;
                const hid_t space = H5Screate_simple(1, &n, nullptr);
                H5Pset_virtual(creation, space, ".", "v", space);
                H5Sclose(space);
              }),
              HasSubstr(message));
  write_sample(folder_.path("b.h5"));
  EXPECT_THAT(refused([](hid_t, hid_t file) { H5Lcreate_external("b.h5", "v", file, "v", H5P_DEFAULT, H5P_DEFAULT); }),
              HasSubstr(message));
}

/// A link on the way to a dataset, be it external or to nothing, is refused where the dataset is optional too.
TEST_F(WrongFile, LinksThatDoNotEndInTheFile) {
  write_sample(folder_.path("b.h5"));
  const auto refused = [&](const std::function<void(hid_t)>& link) {
    write_sample(path_);
    const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    H5Ldelete(file, "group", H5P_DEFAULT);
    link(file);
    H5Fclose(file);
    return message([](const Reader& f) { (void)f.has("group/A"); });
  };
  EXPECT_THAT(refused([](hid_t file) { H5Lcreate_external("b.h5", "group", file, "group", H5P_DEFAULT, H5P_DEFAULT); }),
              HasSubstr("a.h5:group/A: its values are in another file or dataset"));
  const std::string nothing = "a.h5:group/A: \"group\" leads to nothing in this file";
  EXPECT_THAT(refused([](hid_t file) {
                H5Lcreate_external("b.h5", "group", file, "other", H5P_DEFAULT, H5P_DEFAULT);
                H5Lcreate_soft("other", file, "group", H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr(nothing));
  EXPECT_THAT(refused([](hid_t file) { H5Lcreate_soft("group", file, "group", H5P_DEFAULT, H5P_DEFAULT); }),
              HasSubstr(nothing));
  EXPECT_EQ(refused([](hid_t) {}), "no error") << "an optional group that is not there";
}

/// A text of one byte in the file takes 32 in memory.
TEST_F(WrongFile, TextsThatTakeMoreMemoryThanTheFileGives) {
  write_sample(path_);
  const hid_t file = H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, "v", H5P_DEFAULT);
  const hsize_t n = hsize_t{1} << 21;
  const hid_t space = H5Screate_simple(1, &n, nullptr), type = H5Tcopy(H5T_C_S1);
  H5Dclose(H5Dcreate2(file, "v", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Tclose(type);
  H5Sclose(space);
  H5Fclose(file);
  EXPECT_THAT(message([](const Reader& f) { read<std::vector<std::string>>(f, "v", {some}); }),
              HasSubstr("a.h5:v: claims 2.1e+06 bytes, shape (2097152), more than a file of"));
}

/// Nothing is allocated for an extent that the file cannot hold, be its values left out or its header damaged.
TEST_F(WrongFile, ExtentsThatTheFileCannotHold) {
  const auto refused = [&](hsize_t n) {
    write_sample(path_);
    replace_v(
        path_,
        [](hid_t creation, hid_t) {
          const hsize_t chunk = 3;
          H5Pset_chunk(creation, 1, &chunk);
        },
        n);
    return message([](const Reader& f) { read<VectorXd>(f, "v", {some}, "mm"); });
  };
  EXPECT_EQ(refused(1000), "no error") << "zeros, none of which was written";
  for (const int power : {30, 60})
    EXPECT_THAT(refused(hsize_t{1} << power), AllOf(HasSubstr("a.h5:v: claims "), HasSubstr("bytes can hold")));
}

TEST_F(WrongFile, EntriesThatDoNotMakeTheShapeAreNotWritten) {
  Writer file(path_, {"sample", 1, 0});
  EXPECT_THAT(
      [&] {
        file("A", A, {3, 3}, "1", "");
      },
      ThrowsMessage<std::logic_error>(HasSubstr("a.h5:A: 6 entries do not make the shape (3, 3)")));
}

}  // namespace
}  // namespace fastjoint::h5
