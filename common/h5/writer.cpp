// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/writer.hpp"

#include <fmt/format.h>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/h5/handle.hpp"
#include "common/h5/seal.hpp"
#include "common/h5/whole_file.hpp"

namespace fastjoint::h5 {
namespace {

using Shape = std::vector<hsize_t>;
using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMajorXi = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

hsize_t extent(Eigen::Index n) { return static_cast<hsize_t>(n); }

}  // namespace

struct Writer::Impl {
  std::string path;
  File file;

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}: {} cannot be written: {}", path, what, last_error()));
  }

  Properties properties(hid_t cls) const {
    Properties list(H5Pcreate(cls));
    H5Pset_obj_track_times(list.get(), false);  // equal input, equal bytes
    return list;
  }

  void make_groups(const std::string& dataset) const {
    const auto list = properties(H5P_GROUP_CREATE);
    for (auto end = dataset.find('/'); end != std::string::npos; end = dataset.find('/', end + 1)) {
      const std::string group = dataset.substr(0, end);
      if (H5Lexists(file.get(), group.c_str(), H5P_DEFAULT) > 0) continue;
      if (!Group(H5Gcreate2(file.get(), group.c_str(), H5P_DEFAULT, list.get(), H5P_DEFAULT))) fail(group);
    }
  }

  void text_attribute(hid_t owner, const std::string& name, const std::string& text) const {
    const auto type = utf8_string();
    const Space space(H5Screate(H5S_SCALAR));
    const Attribute attribute(H5Acreate2(owner, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT));
    const char* chars = text.c_str();
    if (!attribute || H5Awrite(attribute.get(), type.get(), &chars) < 0) fail("attribute " + name);
  }

  void integer_attribute(const std::string& name, const std::vector<int>& values, bool scalar) const {
    const hsize_t n = values.size();
    const Space space(scalar ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, nullptr));
    const Attribute attribute(
        H5Acreate2(file.get(), name.c_str(), H5T_STD_I32LE, space.get(), H5P_DEFAULT, H5P_DEFAULT));
    if (!attribute || H5Awrite(attribute.get(), H5T_NATIVE_INT, values.data()) < 0) fail("attribute " + name);
  }

  void dataset(const std::string& name, const Space& space, hid_t file_type, hid_t memory_type, const void* data,
               const Meta& meta) const {
    make_groups(name);
    const auto list = properties(H5P_DATASET_CREATE);
    const Dataset set(
        H5Dcreate2(file.get(), name.c_str(), file_type, space.get(), H5P_DEFAULT, list.get(), H5P_DEFAULT));
    if (!set) fail(name);
    const bool empty = H5Sget_simple_extent_npoints(space.get()) == 0;
    if (!empty && H5Dwrite(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) fail(name);
    text_attribute(set.get(), "unit", meta.unit);
    text_attribute(set.get(), "description", meta.description);
  }

  void doubles(const std::string& name, const Shape& shape, const double* data, const Meta& meta) const {
    std::size_t n = 1;
    for (const auto e : shape) n *= e;
    const Eigen::Map<const Eigen::ArrayXd> values(data, n);
    if (values.isNaN().any()) throw NumericalError(fmt::format("{}: {} would hold a NaN", path, name));
    const Space space(H5Screate_simple(count_of(shape), shape.data(), nullptr));
    dataset(name, space, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, data, meta);
  }

  void integers(const std::string& name, const Shape& shape, const int* data, const Meta& meta) const {
    const Space space(H5Screate_simple(count_of(shape), shape.data(), nullptr));
    dataset(name, space, H5T_STD_I32LE, H5T_NATIVE_INT, data, meta);
  }
};

Writer::Writer(std::string path, const std::string& format, int major, int minor) : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  const Properties access(H5Pcreate(H5P_FILE_ACCESS));
  constexpr std::size_t increment = 1 << 20;
  H5Pset_fapl_core(access.get(), increment, false);
  // The library would first read a file of this name into memory, whole; no file has this one.
  const std::string name = impl_->path + ".in-memory";
  impl_->file = File(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
  if (!impl_->file) impl_->fail("file");
  attribute("format", format);
  impl_->integer_attribute("version", {major, minor}, false);
}

Writer::~Writer() = default;

void Writer::attribute(const std::string& name, const std::string& text) {
  impl_->text_attribute(impl_->file.get(), name, text);
}

void Writer::attribute(const std::string& name, int value) { impl_->integer_attribute(name, {value}, true); }

void Writer::write(const std::string& dataset, const Eigen::VectorXd& v, const Meta& meta) {
  impl_->doubles(dataset, {extent(v.size())}, v.data(), meta);
}

void Writer::write(const std::string& dataset, const Eigen::MatrixXd& A, const Meta& meta) {
  const RowMajorXd rows = A;
  impl_->doubles(dataset, {extent(A.rows()), extent(A.cols())}, rows.data(), meta);
}

void Writer::write_transposed(const std::string& dataset, const Eigen::MatrixXd& A, const Meta& meta) {
  impl_->doubles(dataset, {extent(A.cols()), extent(A.rows())}, A.data(), meta);
}

void Writer::write(const std::string& dataset, const Eigen::VectorXi& v, const Meta& meta) {
  impl_->integers(dataset, {extent(v.size())}, v.data(), meta);
}

void Writer::write(const std::string& dataset, const Eigen::MatrixXi& A, const Meta& meta) {
  const RowMajorXi rows = A;
  impl_->integers(dataset, {extent(A.rows()), extent(A.cols())}, rows.data(), meta);
}

void Writer::write(const std::string& dataset, const std::vector<Eigen::MatrixXd>& stack, Eigen::Index rows,
                   Eigen::Index cols, const Meta& meta) {
  RowMajorXd flat(stack.size(), rows * cols);
  for (Eigen::Index i = 0; i < flat.rows(); ++i) {
    const RowMajorXd A = stack[i];
    flat.row(i) = A.reshaped<Eigen::RowMajor>().transpose();
  }
  impl_->doubles(dataset, {stack.size(), extent(rows), extent(cols)}, flat.data(), meta);
}

void Writer::write(const std::string& dataset, const std::vector<std::string>& strings, const Meta& meta) {
  std::vector<const char*> chars;
  chars.reserve(strings.size());
  for (const auto& s : strings) chars.push_back(s.c_str());
  const hsize_t n = strings.size();
  const auto type = utf8_string();
  impl_->dataset(dataset, Space(H5Screate_simple(1, &n, nullptr)), type.get(), type.get(), chars.data(), meta);
}

void Writer::write(const std::string& dataset, const std::string& text, const Meta& meta) {
  const char* chars = text.c_str();
  const auto type = utf8_string();
  impl_->dataset(dataset, Space(H5Screate(H5S_SCALAR)), type.get(), type.get(), &chars, meta);
}

std::string Writer::commit() {
  if (H5Fflush(impl_->file.get(), H5F_SCOPE_GLOBAL) < 0) impl_->fail("file");
  const ssize_t n_bytes = H5Fget_file_image(impl_->file.get(), nullptr, 0);
  if (n_bytes <= 0) impl_->fail("file");
  std::string image;
  constexpr std::size_t room_for_seal = 64;
  image.reserve(n_bytes + room_for_seal);
  image.resize(n_bytes);
  if (H5Fget_file_image(impl_->file.get(), image.data(), image.size()) < 0) impl_->fail("file");
  std::string found = digest(image);
  image += seal(found);
  write_whole_file(impl_->path, image);
  return found;
}

}  // namespace fastjoint::h5
