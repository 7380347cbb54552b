// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/whole_file.hpp"

#include <gmock/gmock.h>

#include "tests/common/h5/sample.hpp"

namespace fastjoint::h5 {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(WrongFile, TruncatedAnywhere) {
  write_sample(path_);
  const std::string whole = test::read_file(path_);
  const std::size_t n_image = whole.rfind("\nfastjoint xxhash ");
  for (std::size_t n = 0; n < n_image; n += whole.size() / 37) {
    folder_.write("a.h5", whole.substr(0, n));
    EXPECT_NE(message([](const Reader& f) {
                read<Eigen::MatrixXd>(f, "group/A", {2, 3}, "N/mm");
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

/// A file that is read piece by piece.
TEST_F(WrongFile, DamagedAnywhereInALargeFile) {
  Writer file(path_, {"sample", 1, 0});
  file("x", Eigen::VectorXd::LinSpaced(100000, 0, 1).eval(), {any}, "1", "");
  file.commit();
  EXPECT_EQ(message(), "no error");
  const std::string whole = test::read_file(path_);
  for (const std::size_t from_end : {100UL, 500000UL, 700000UL}) {
    std::string damaged = whole;
    damaged[whole.size() - from_end] ^= 1;
    folder_.write("a.h5", damaged);
    EXPECT_THAT(message(), HasSubstr("its bytes do not match their digest")) << from_end;
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
  EXPECT_EQ(message([](const Reader& f) { read<Eigen::MatrixXd>(f, "group/A", {2, 3}, "N/mm"); }), "no error");
  EXPECT_EQ(Reader(path_, {"sample", 1, 0}).digest(), "");
}

/// The digest is xxHash's: that of no bytes is in its documentation.
TEST(Digest, IsThatOfTheFile) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(digest(folder.write("empty", "")), "2d06800538d394c2");
  Writer file(folder.path("a.h5"), {"sample", 1, 0});
  const std::string written = file.commit();
  EXPECT_EQ(Reader(folder.path("a.h5"), {"sample", 1, 0}).digest(), written);
  EXPECT_EQ(digest(folder.path("a.h5"), test::read_file(folder.path("a.h5")).rfind("\nfastjoint")), written);
}

}  // namespace
}  // namespace fastjoint::h5
