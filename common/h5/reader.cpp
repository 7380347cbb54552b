// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
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
  for (const auto e : shape) extents.push_back(e == any ? "any" : e == some ? "at least 1" : std::to_string(e));
  return fmt::format("({})", fmt::join(extents, ", "));
}

}  // namespace

struct Reader::Impl {
  std::string path, digest;
  File file;
  bool compare_units = true;

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
    for (std::size_t i = 0; fits && i < found.size(); ++i)
      fits = expected[i] == any || found[i] == expected[i] || (expected[i] == some && found[i] > 0);
    if (!fits) fail(name, fmt::format("shape is {}, expected {}", shape_text(found), shape_text(expected)));
    return found;
  }

  void check_unit(const Dataset& set, const std::string& name, const std::string& expected) const {
    if (!compare_units || !has_attribute(set.get(), "unit")) return;
    const std::string found = read_text_attribute(set.get(), "unit");
    if (found != expected) fail(name, fmt::format("unit is '{}', expected '{}'", found, expected));
  }

  /// Reads the k-th of n equal parts.
  void read(const Dataset& set, const std::string& name, hid_t memory_type, void* into, std::size_t k = 0,
            std::size_t n = 1) const {
    const Space space(H5Dget_space(set.get())), part = select_part(space, k, n);
    if (H5Dread(set.get(), memory_type, part.get(), space.get(), H5P_DEFAULT, into) < 0)
      fail(name, fmt::format("cannot be read: {}", last_error()));
  }

  /// Texts of either kind.
  void read_texts(const Dataset& set, const std::string& name, hid_t type, std::span<std::string> texts) const {
    if (H5Tis_variable_str(type) > 0) {
      std::vector<char*> chars(texts.size(), nullptr);
      read(set, name, type, static_cast<void*>(chars.data()));
      for (std::size_t i = 0; i < texts.size(); ++i) {
        texts[i] = chars[i] == nullptr ? "" : chars[i];
        H5free_memory(chars[i]);
      }
    } else {
      const std::size_t width = H5Tget_size(type);
      std::string block(texts.size() * width, '\0');
      read(set, name, type, block.data());
      for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = block.substr(i * width, width).c_str();
    }
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
  const std::string found = reader.text_attribute("format", "");
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

void Reader::compare_units(bool compare) { impl_->compare_units = compare; }

bool Reader::has(const std::string& dataset) const {
  for (auto end = dataset.find('/');; end = dataset.find('/', end + 1)) {
    if (H5Lexists(impl_->file.get(), dataset.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::string Reader::text_attribute(const std::string& name, const std::string& otherwise) const {
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

template <class Scalar>
void Reader::get(const std::string& name, const Shape& expected, const std::string& unit, const Allowed& allowed,
                 const MakeRoom<Scalar>& make_room) const {
  constexpr bool is_text = std::is_same_v<Scalar, std::string>, is_integer = std::is_same_v<Scalar, int>;
  std::optional<Scalar> stand_in;
  if constexpr (is_text)
    stand_in = allowed.word;
  else
    stand_in = allowed.number;
  if (std::find(expected.begin(), expected.end(), 0) != expected.end()) stand_in = Scalar();
  if (stand_in && !has(name)) {
    Shape shape = expected;
    for (auto& extent : shape) extent = std::max<Eigen::Index>(extent, 0);
    for (const auto& entries : make_room(shape)) std::fill(entries.begin(), entries.end(), *stand_in);
    return;
  }
  const auto set = impl_->open(name);
  const Type type(H5Dget_type(set.get()));
  if (H5Tget_class(type.get()) != (is_text ? H5T_STRING : is_integer ? H5T_INTEGER : H5T_FLOAT))
    impl_->fail(name, fmt::format("type is not {}", is_text ? "string" : is_integer ? "integer" : "floating point"));
  const Shape found = impl_->shape(set, name, expected);
  impl_->check_unit(set, name, unit);
  const auto parts = make_room(found);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (parts[k].empty()) return;
    if constexpr (is_text)
      impl_->read_texts(set, name, type.get(), parts[k]);
    else
      impl_->read(set, name, is_integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, parts[k].data(), k, parts.size());
    check_entries<Scalar>(name, parts[k], allowed);
  }
}

template <class Scalar>
void Reader::check_entries(const std::string& name, std::span<const Scalar> entries, const Allowed& allowed) const {
  const auto refuse = [&](const std::string& what) {
    impl_->fail(name, fmt::format("holds {}, expected {}", what, allowed.text));
  };
  if constexpr (std::is_same_v<Scalar, std::string>) {
    for (const auto& text : entries)
      if (allowed.words && std::find(allowed.words->begin(), allowed.words->end(), text) == allowed.words->end())
        refuse(fmt::format("\"{}\"", text));
  } else {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (!(entries[i] >= allowed.low && entries[i] <= allowed.high)) refuse(fmt::format("{}", entries[i]));
      if (i > 0 && entries[i] < entries[i - 1] + allowed.step)
        refuse(fmt::format("{}, {}", entries[i - 1], entries[i]));
    }
  }
}

template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<double>&) const;
template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<int>&) const;
template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<std::string>&) const;
template void Reader::check_entries(const std::string&, std::span<const double>, const Allowed&) const;
template void Reader::check_entries(const std::string&, std::span<const int>, const Allowed&) const;
template void Reader::check_entries(const std::string&, std::span<const std::string>, const Allowed&) const;

}  // namespace fastjoint::h5
