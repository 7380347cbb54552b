// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/formats/study_block.hpp"

namespace fastjoint::formats {
namespace {

const h5::Format block_format{"study-block", 1, 0};

template <class File, class Block>
void block_datasets(File& file, Block& a) {
  file.attribute("generator", a.origin.generator);
  file.attribute("joint", a.origin.joint);
  file.attribute("study", a.origin.study);
  file.attribute("seed", a.origin.seed);
  file.attribute("block", a.number);
  file.attribute("block_size", a.size);
  file("files/name", a.origin.file, {h5::any}, "1",
       "files that the joint and the study name, and the polynomial degree");
  file("files/digest", a.origin.digest, {Eigen::Index(a.origin.file.size())}, "1", "digest of each file; the degree");
  file("status", a.status, {h5::some}, "1",
       "what became of each sample: 0 solved, 1 refused, 2 not solved, 3 out of balance", h5::integers(0, 3));
  file("values", a.values, {Eigen::Index(a.status.size()), File::reads ? h5::some : Eigen::Index(a.values.cols())}, "1",
       "forces, peaks and displacements of each sample, infinite of one that is not solved", h5::infinite_too);
}

}  // namespace

void write(const std::string& path, const StudyBlock& block) {
  h5::Writer file(path, block_format);
  block_datasets(file, block);
  file.commit();
}

StudyBlock read_study_block(const std::string& path) {
  h5::Reader file(path, block_format);
  StudyBlock block;
  block_datasets(file, block);
  return block;
}

}  // namespace fastjoint::formats
