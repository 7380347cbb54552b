// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <numeric>
#include <stdexcept>

#include "common/count.hpp"
#include "common/errors.hpp"
#include "common/h5/handle.hpp"
#include "common/h5/whole_file.hpp"

namespace fastjoint::h5 {
struct Writer::Impl {
  std::string path;
  WholeFile target;
  File file;

  explicit Impl(const std::string& at) : path(at), target(at) {}

  [[noreturn]] void fail(const std::string& what) const {
    throw FileError(fmt::format("{}: {} cannot be written: {}", path, what, last_error()));
  }

  Properties properties(hid_t cls) const {
    Properties list(H5Pcreate(cls));
    H5Pset_obj_track_times(list.get(), false);  // so that equal input gives equal bytes
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

  void dataset(const std::string& name, const Shape& shape, hid_t file_type, hid_t memory_type,
               const std::vector<const void*>& parts, const std::string& unit, const std::string& meaning) const {
    make_groups(name);
    const std::vector<hsize_t> extents(shape.begin(), shape.end());
    const Space space(H5Screate_simple(count_of(extents), extents.data(), nullptr));
    const auto list = properties(H5P_DATASET_CREATE);
    const Dataset set(
        H5Dcreate2(file.get(), name.c_str(), file_type, space.get(), H5P_DEFAULT, list.get(), H5P_DEFAULT));
    if (!set) fail(name);
    const bool empty = H5Sget_simple_extent_npoints(space.get()) == 0;
    for (std::size_t k = 0; k < parts.size() && !empty; ++k) {
      const Space part = select_part(space, k, parts.size());
      if (H5Dwrite(set.get(), memory_type, part.get(), space.get(), H5P_DEFAULT, parts[k]) < 0) fail(name);
    }
    text_attribute(set.get(), "unit", unit);
    text_attribute(set.get(), "description", meaning);
  }
};

Writer::Writer(const std::string& path, const Format& format) : impl_(std::make_unique<Impl>(path)) {
  take_over_error_reporting();
  const Properties access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_file_locking(access.get(), false, true);  // the file is already locked by WholeFile
  impl_->file = File(H5Fcreate(impl_->target.unfinished_path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()));
  if (!impl_->file) impl_->fail("file");
  attribute("format", format.name);
  impl_->integer_attribute("version", {format.major, format.minor}, false);
}

Writer::~Writer() = default;

void Writer::attribute(const std::string& name, const std::string& text) {
  impl_->text_attribute(impl_->file.get(), name, text);
}

void Writer::attribute(const std::string& name, int value) { impl_->integer_attribute(name, {value}, true); }

template <class Scalar>
void Writer::put(const std::string& name, const Shape& shape, const std::vector<std::span<const Scalar>>& parts,
                 const std::string& unit, const std::string& meaning, const Allowed& allowed) {
  const auto n = std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies<>());
  std::size_t n_given = 0;
  std::vector<const void*> data;
  for (const auto& part : parts) {
    n_given += part.size();
    data.push_back(part.data());
  }
  if (n != n_given || (n > 0 && n % parts.size() != 0))
    throw std::logic_error(fmt::format("{}:{}: {} entries do not make the shape ({})", impl_->path, name, n_given,
                                       fmt::join(shape, ", ")));
  if constexpr (std::is_same_v<Scalar, std::string>) {
    std::vector<const char*> chars;
    for (const auto& text : parts[0]) chars.push_back(text.c_str());
    const auto type = utf8_string();
    impl_->dataset(name, shape, type.get(), type.get(), {chars.data()}, unit, meaning);
  } else if constexpr (std::is_same_v<Scalar, int>) {
    impl_->dataset(name, shape, H5T_STD_I32LE, H5T_NATIVE_INT, data, unit, meaning);
  } else {
    for (const auto& part : parts) {
      const Eigen::Map<const Eigen::ArrayXd> entries(part.data(), std::ssize(part));
      if (!allowed.may_be_nan && entries.isNaN().any())
        throw NumericalError(fmt::format("{}: {} would hold a NaN", impl_->path, name));
      if (allowed.high < infinite && entries.isInf().any())
        throw NumericalError(fmt::format(
            "{}: {} would hold a number beyond 1.8e308; the input has numbers that are far too large or small",
            impl_->path, name));
    }
    impl_->dataset(name, shape, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, data, unit, meaning);
  }
}

template void Writer::put(const std::string&, const Shape&, const std::vector<std::span<const double>>&,
                          const std::string&, const std::string&, const Allowed&);
template void Writer::put(const std::string&, const Shape&, const std::vector<std::span<const int>>&,
                          const std::string&, const std::string&, const Allowed&);
template void Writer::put(const std::string&, const Shape&, const std::vector<std::span<const std::string>>&,
                          const std::string&, const std::string&, const Allowed&);

template <class Scalar>
void Writer::make_rows(const std::string& name, const Shape& shape, const std::string& unit,
                       const std::string& meaning) {
  constexpr bool is_integer = std::is_same_v<Scalar, int>;
  impl_->dataset(name, shape, is_integer ? H5T_STD_I32LE : H5T_IEEE_F64LE,
                 is_integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, {}, unit, meaning);
}

template <class Scalar>
void Writer::rows(const std::string& name, std::size_t first, std::span<const Scalar> values) {
  const Dataset set(H5Dopen2(impl_->file.get(), name.c_str(), H5P_DEFAULT));
  if (!set) impl_->fail(name);
  const Space space(H5Dget_space(set.get()));
  std::vector<hsize_t> extents(H5Sget_simple_extent_ndims(space.get()));
  H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr);
  const std::size_t row = std::accumulate(extents.begin() + 1, extents.end(), std::size_t{1}, std::multiplies<>());
  if (values.empty()) return;
  std::vector<hsize_t> start(extents.size(), 0), count = extents;
  start[0] = first;
  count[0] = values.size() / row;
  const Space part(H5Screate_simple(count_of(count), count.data(), nullptr));
  H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  const hid_t type = std::is_same_v<Scalar, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
  if (H5Dwrite(set.get(), type, part.get(), space.get(), H5P_DEFAULT, values.data()) < 0) impl_->fail(name);
}

template void Writer::make_rows<double>(const std::string&, const Shape&, const std::string&, const std::string&);
template void Writer::make_rows<int>(const std::string&, const Shape&, const std::string&, const std::string&);
template void Writer::rows(const std::string&, std::size_t, std::span<const double>);
template void Writer::rows(const std::string&, std::size_t, std::span<const int>);

std::string Writer::commit() {
  if (!impl_->file.close()) impl_->fail("file");
  std::string found = digest(impl_->target.unfinished_path());
  impl_->target.append(seal(found));
  impl_->target.finish();
  return found;
}

}  // namespace fastjoint::h5
