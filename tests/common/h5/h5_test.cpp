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

void write_sample(const std::string& path, int major = 1) {
  Writer file(path, "sample", major, 2);
  file.attribute("name", "n\u00e4me");
  file.attribute("complete", 1);
  file.write("group/A", A, {"N/mm", "a matrix"});
  file.write("v", Eigen::VectorXd(Eigen::Vector3d(1, 2, 3)), {"mm", "a vector"});
  file.write("group/deep/i", Eigen::VectorXi(Eigen::Vector2i(7, 8)), {"1", "integers"});
  file.write("I", Eigen::MatrixXi(Eigen::Matrix2i::Identity()), {"1", "integer matrix"});
  file.write("stack", {A, 2 * A}, 2, 3, {"1", "two matrices"});
  file.write("nothing", std::vector<Eigen::MatrixXd>{}, 4, 2, {"1", "no matrices"});
  file.write_transposed("B", A, {"1", "A transposed"});
  file.write("names", std::vector<std::string>{"one", "", "dr\u00fci"}, {"1", "strings"});
  file.write("text", std::string("{}"), {"1", "a text"});
  file.commit();
}

TEST(Hdf5, ReadsBackWhatWasWritten) {
  const test::TemporaryFolder folder;
  write_sample(folder.path("a.h5"));
  const Reader file(folder.path("a.h5"), "sample", 1);
  EXPECT_EQ(file.attribute("name", ""), "n\u00e4me");
  EXPECT_EQ(file.attribute("absent", "otherwise"), "otherwise");
  EXPECT_EQ(file.integer_attribute("complete"), 1);
  EXPECT_EQ(file.matrix("group/A", 2, any, "N/mm"), A);
  EXPECT_EQ(file.vector("v", 3, "mm"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(file.integers("group/deep/i", any), Eigen::Vector2i(7, 8));
  EXPECT_EQ(file.integer_matrix("I", 2, 2), Eigen::MatrixXi(Eigen::Matrix2i::Identity()));
  EXPECT_EQ(file.stack("stack", any, 2, 3, "1").at(1), 2 * A);
  EXPECT_TRUE(file.stack("nothing", any, 4, 2, "1").empty());
  EXPECT_EQ(file.matrix("B", 3, 2, "1"), A.transpose());
  EXPECT_EQ(file.transposed("B", 3, 2, "1"), A);
  EXPECT_EQ(file.strings("names", any), (std::vector<std::string>{"one", "", "dr\u00fci"}));
  EXPECT_EQ(file.text("text"), "{}");
  EXPECT_TRUE(file.has("group/A"));
  EXPECT_FALSE(file.has("group/Z"));
  EXPECT_FALSE(file.has("none/A"));
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
        file.write("x", Eigen::VectorXd(Eigen::Vector2d(1, std::numeric_limits<double>::quiet_NaN())), {"1", ""});
      },
      ThrowsMessage<NumericalError>(HasSubstr("x would hold a NaN")));
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
    EXPECT_NE(message([](const Reader& f) { (void)f.matrix("group/A", 2, 3, "N/mm"); }), "no error") << n << " bytes";
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
  EXPECT_EQ(message([](const Reader& f) { (void)f.matrix("group/A", 2, 3, "N/mm"); }), "no error");
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
  EXPECT_THAT(message([](const Reader& f) { (void)f.vector("absent", any, "1"); }),
              HasSubstr("a.h5:absent: dataset is missing or damaged"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.matrix("group/A", 3, any, "N/mm"); }),
              HasSubstr("group/A: shape is (2, 3), expected (3, any)"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.vector("group/A", 6, "N/mm"); }), HasSubstr("expected (6)"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.matrix("group/A", 2, 3, "N/m"); }),
              HasSubstr("unit is 'N/mm', expected 'N/m'"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.integers("v", 3); }), HasSubstr("type is not integer"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.vector("group/deep/i", 2, "1"); }),
              HasSubstr("type is not floating point"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.strings("v", 3); }), HasSubstr("type is not string"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.integer_attribute("nothing"); }),
              HasSubstr("'nothing' is missing"));
  EXPECT_THAT(message([](const Reader& f) { (void)f.integer_attribute("version"); }),
              HasSubstr("attribute 'version' is missing or not one integer"));
}

}  // namespace
}  // namespace fastjoint::h5
