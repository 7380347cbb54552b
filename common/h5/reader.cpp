// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numeric>

#include "common/errors.hpp"
#include "common/h5/handle.hpp"
#include "common/h5/seal.hpp"

namespace fastjoint::h5 {
namespace {

namespace fs = std::filesystem;
using Shape = std::vector<Eigen::Index>;
using RowMajorXd = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using RowMajorXi = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Reads a string attribute of either kind (variable or fixed length; h5py writes both).
std::string read_text_attribute(hid_t owner, const char* name) {
  const Attribute attribute(H5Aopen(owner, name, H5P_DEFAULT));
  const Type type(H5Aget_type(attribute.get()));
  const Space space(H5Aget_space(attribute.get()));
  if (H5Tget_class(type.get()) != H5T_STRING || H5Sget_simple_extent_npoints(space.get()) != 1) return {};
  if (H5Tis_variable_str(type.get()) > 0) {
    char* chars = nullptr;
    if (H5Aread(attribute.get(), type.get(), &chars) < 0 || chars == nullptr) return {};
    std::string text(chars);
    H5free_memory(chars);
    return text;
  }
  std::string text(H5Tget_size(type.get()), '\0');
  if (H5Aread(attribute.get(), type.get(), text.data()) < 0) return {};
  text.resize(std::strlen(text.c_str()));
  return text;
}

bool has_attribute(hid_t owner, const char* name) { return H5Aexists(owner, name) > 0; }

std::string shape_text(const Shape& shape) {
  std::vector<std::string> extents;
  for (const auto e : shape) extents.push_back(e == any ? "any" : std::to_string(e));
  return fmt::format("({})", fmt::join(extents, ", "));
}

std::size_t count(const Shape& shape) {
  return std::accumulate(shape.begin(), shape.end(), Eigen::Index{1}, std::multiplies<>());
}

}  // namespace

struct Reader::Impl {
  std::string path, digest;
  File file;

  [[noreturn]] void fail(const std::string& dataset, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", path, dataset, what));
  }

  Dataset open(const std::string& name) const {
    Dataset set(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT));
    if (!set) fail(name, fmt::format("dataset is missing or damaged ({})", last_error()));
    return set;
  }

  Shape shape(const Dataset& set, const std::string& name, const Shape& expected) const {
    const Space space(H5Dget_space(set.get()));
    const int rank = H5Sget_simple_extent_ndims(space.get());
    std::vector<hsize_t> extents(std::max(rank, 0));
    H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
    Shape found(extents.begin(), extents.end());
    bool fits = found.size() == expected.size();
    for (std::size_t i = 0; fits && i < found.size(); ++i) fits = expected[i] == any || found[i] == expected[i];
    if (!fits) fail(name, fmt::format("shape is {}, expected {}", shape_text(found), shape_text(expected)));
    return found;
  }

  void check_class(const Dataset& set, const std::string& name, H5T_class_t expected, const char* word) const {
    const Type type(H5Dget_type(set.get()));
    if (H5Tget_class(type.get()) != expected) fail(name, fmt::format("type is not {}", word));
  }

  void check_unit(const Dataset& set, const std::string& name, const std::string& expected) const {
    if (expected.empty() || !has_attribute(set.get(), "unit")) return;
    const std::string found = read_text_attribute(set.get(), "unit");
    if (found != expected) fail(name, fmt::format("unit is '{}', expected '{}'", found, expected));
  }

  template <class Scalar>
  Shape read(const std::string& name, const Shape& expected, H5T_class_t cls, hid_t memory_type,
             std::vector<Scalar>& values) const {
    const auto set = open(name);
    check_class(set, name, cls, cls == H5T_FLOAT ? "floating point" : "integer");
    Shape found = shape(set, name, expected);
    values.resize(count(found));
    if (!values.empty() && H5Dread(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      fail(name, fmt::format("cannot be read: {}", last_error()));
    return found;
  }

  Shape doubles(const std::string& name, const Shape& expected, const std::string& unit, std::vector<double>& values,
                Infinite infinite = Infinite::refused) const {
    Shape found = read(name, expected, H5T_FLOAT, H5T_NATIVE_DOUBLE, values);
    check_unit(open(name), name, unit);
    for (const double v : values) {
      if (std::isnan(v)) fail(name, "holds a NaN");
      if (std::isinf(v) && infinite == Infinite::refused) fail(name, "holds an infinite number, expected finite ones");
    }
    return found;
  }

  std::vector<std::string> texts(const std::string& name, const Shape& expected) const {
    const auto set = open(name);
    check_class(set, name, H5T_STRING, "string");
    const std::size_t n = count(shape(set, name, expected));
    const Type type(H5Dget_type(set.get()));
    std::vector<std::string> result;
    if (n == 0) return result;
    if (H5Tis_variable_str(type.get()) > 0) {
      std::vector<char*> chars(n, nullptr);
      if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(chars.data())) < 0)
        fail(name, fmt::format("cannot be read: {}", last_error()));
      for (char* c : chars) {
        result.emplace_back(c == nullptr ? "" : c);
        H5free_memory(c);
      }
    } else {
      const std::size_t width = H5Tget_size(type.get());
      std::string block(n * width, '\0');
      if (H5Dread(set.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()) < 0)
        fail(name, fmt::format("cannot be read: {}", last_error()));
      for (std::size_t i = 0; i < n; ++i) result.emplace_back(block.substr(i * width, width).c_str());
    }
    return result;
  }
};

namespace {

void check_readable(const std::string& path) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (error || !fs::exists(status))
    throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(error ? error.value() : ENOENT)));
  if (!fs::is_regular_file(status)) throw FileError(fmt::format("{}: is not a regular file", path));
}

void check_version(const Reader& reader, hid_t file, const std::string& format, int major) {
  const std::string found = reader.attribute("format", "");
  if (found != format)
    throw FileError(
        found.empty()
            ? fmt::format("{}: is not a file of fastjoint (it has no attribute 'format'), expected a '{}' file",
                          reader.path(), format)
            : fmt::format("{}: is a '{}' file, expected '{}'", reader.path(), found, format));
  std::vector<int> version(2, -1);
  const Attribute attribute(H5Aopen(file, "version", H5P_DEFAULT));
  const Space space(H5Aget_space(attribute.get()));
  if (!attribute || H5Sget_simple_extent_npoints(space.get()) != 2 ||
      H5Aread(attribute.get(), H5T_NATIVE_INT, version.data()) < 0)
    throw FileError(fmt::format("{}: attribute 'version' is not [major, minor]", reader.path()));
  if (version[0] != major)
    throw FileError(fmt::format("{}: format version {}.{}, this program reads {}.x; {}", reader.path(), version[0],
                                version[1], major,
                                version[0] > major ? "use a newer program" : "run the earlier stage again"));
}

}  // namespace

Reader::Reader(std::string path, const std::string& format, int major) : impl_(std::make_unique<Impl>()) {
  impl_->path = std::move(path);
  check_readable(impl_->path);
  impl_->digest = checked_digest(impl_->path);
  if (H5Fis_hdf5(impl_->path.c_str()) <= 0)
    throw FileError(fmt::format("{}: is not an HDF5 file (expected a '{}' file)", impl_->path, format));
  const Properties access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access.get(), false, true);  // reading from a read-only or network file system
  impl_->file = File(H5Fopen(impl_->path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (!impl_->file) throw FileError(fmt::format("{}: is damaged or truncated: {}", impl_->path, last_error()));
  check_version(*this, impl_->file.get(), format, major);
}

Reader::~Reader() = default;

const std::string& Reader::path() const { return impl_->path; }

const std::string& Reader::digest() const { return impl_->digest; }

bool Reader::has(const std::string& dataset) const {
  for (auto end = dataset.find('/');; end = dataset.find('/', end + 1)) {
    if (H5Lexists(impl_->file.get(), dataset.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::string Reader::attribute(const std::string& name, const std::string& otherwise) const {
  return has_attribute(impl_->file.get(), name.c_str()) ? read_text_attribute(impl_->file.get(), name.c_str())
                                                        : otherwise;
}

int Reader::integer_attribute(const std::string& name) const {
  int value = 0;
  const Attribute attribute(H5Aopen(impl_->file.get(), name.c_str(), H5P_DEFAULT));
  const Space space(attribute ? H5Aget_space(attribute.get()) : H5I_INVALID_HID);
  if (!attribute || H5Sget_simple_extent_npoints(space.get()) != 1 ||
      H5Aread(attribute.get(), H5T_NATIVE_INT, &value) < 0)
    throw FileError(fmt::format("{}: attribute '{}' is missing or not one integer", path(), name));
  return value;
}

Eigen::VectorXd Reader::vector(const std::string& dataset, Eigen::Index n, const std::string& unit) const {
  std::vector<double> values;
  impl_->doubles(dataset, {n}, unit, values);
  return Eigen::Map<Eigen::VectorXd>(values.data(), values.size());
}

Eigen::MatrixXd Reader::matrix(const std::string& dataset, Eigen::Index rows, Eigen::Index cols,
                               const std::string& unit, Infinite infinite) const {
  std::vector<double> values;
  const Shape shape = impl_->doubles(dataset, {rows, cols}, unit, values, infinite);
  return Eigen::Map<RowMajorXd>(values.data(), shape[0], shape[1]);
}

std::vector<Eigen::MatrixXd> Reader::stack(const std::string& dataset, Eigen::Index n, Eigen::Index rows,
                                           Eigen::Index cols, const std::string& unit, Infinite infinite) const {
  std::vector<double> values;
  const Shape shape = impl_->doubles(dataset, {n, rows, cols}, unit, values, infinite);
  std::vector<Eigen::MatrixXd> result;
  for (Eigen::Index i = 0; i < shape[0]; ++i)
    result.emplace_back(Eigen::Map<RowMajorXd>(values.data() + i * shape[1] * shape[2], shape[1], shape[2]));
  return result;
}

Eigen::MatrixXd Reader::transposed(const std::string& dataset, Eigen::Index cols, Eigen::Index rows,
                                   const std::string& unit) const {
  std::vector<double> values;
  const Shape shape = impl_->doubles(dataset, {cols, rows}, unit, values);
  return Eigen::Map<Eigen::MatrixXd>(values.data(), shape[1], shape[0]);
}

Eigen::VectorXi Reader::integers(const std::string& dataset, Eigen::Index n) const {
  std::vector<int> values;
  impl_->read(dataset, {n}, H5T_INTEGER, H5T_NATIVE_INT, values);
  return Eigen::Map<Eigen::VectorXi>(values.data(), values.size());
}

Eigen::MatrixXi Reader::integer_matrix(const std::string& dataset, Eigen::Index rows, Eigen::Index cols) const {
  std::vector<int> values;
  const Shape shape = impl_->read(dataset, {rows, cols}, H5T_INTEGER, H5T_NATIVE_INT, values);
  return Eigen::Map<RowMajorXi>(values.data(), shape[0], shape[1]);
}

std::vector<std::string> Reader::strings(const std::string& dataset, Eigen::Index n) const {
  return impl_->texts(dataset, {n});
}

std::string Reader::text(const std::string& dataset) const { return impl_->texts(dataset, {}).at(0); }

}  // namespace fastjoint::h5
