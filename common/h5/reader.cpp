// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/reader.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "common/errors.hpp"
#include "common/h5/handle.hpp"
#include "common/h5/whole_file.hpp"

namespace fastjoint::h5 {
namespace {

namespace fs = std::filesystem;

/// Reads texts of variable or fixed length, both of which h5py writes; read(memory) fills the memory in the file's
/// type.
template <class Read>
void read_texts(const Type& type, std::span<std::string> texts, const Read& read) {
  if (H5Tis_variable_str(type.get()) > 0) {
    std::vector<char*> chars(texts.size(), nullptr);
    read(static_cast<void*>(chars.data()));
    for (std::size_t i = 0; i < texts.size(); ++i) {
      texts[i] = chars[i] == nullptr ? "" : chars[i];
      H5free_memory(chars[i]);
    }
  } else {
    const std::size_t width = H5Tget_size(type.get());
    std::string block(texts.size() * width, '\0');
    read(block.data());
    for (std::size_t i = 0; i < texts.size(); ++i) texts[i] = block.substr(i * width, width).c_str();
  }
}

/// Reads a text attribute: nullopt if it does not exist, an empty text if it is not one text.
std::optional<std::string> read_text_attribute(hid_t owner, const char* name) {
  if (H5Aexists(owner, name) <= 0) return std::nullopt;
  const Attribute attribute(H5Aopen(owner, name, H5P_DEFAULT));
  const Type type(H5Aget_type(attribute.get()));
  const Space space(H5Aget_space(attribute.get()));
  std::string text;
  if (H5Tget_class(type.get()) == H5T_STRING && H5Sget_simple_extent_npoints(space.get()) == 1)
    read_texts(type, {&text, 1}, [&](void* into) { (void)H5Aread(attribute.get(), type.get(), into); });
  return text;
}

/// Path of the file of an object.
std::string file_of(hid_t object) {
  std::string path(std::max<ssize_t>(H5Fget_name(object, nullptr, 0), 0), '\0');
  H5Fget_name(object, path.data(), path.size() + 1);
  return path;
}

std::string shape_text(const Shape& shape) {
  std::vector<std::string> extents;
  for (const auto e : shape) extents.push_back(e == any ? "any" : e == some ? "at least 1" : std::to_string(e));
  return fmt::format("({})", fmt::join(extents, ", "));
}

/// A file that is held open.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw FileError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
    std::error_code none;
    path_ = fmt::format("/proc/self/fd/{}", descriptor_);
    if (!fs::exists(path_, none)) path_ = path;  // a system without /proc
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  /// A path at which it can be read even if another file takes its name meanwhile.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// True if it is what a path leads to now.
  [[nodiscard]] bool is_at(const std::string& path) const {
    struct stat here {
    }, there{};
    return ::fstat(descriptor_, &here) == 0 && ::stat(path.c_str(), &there) == 0 && here.st_dev == there.st_dev &&
           here.st_ino == there.st_ino;
  }

 private:
  int descriptor_;
  std::string path_;
};

}  // namespace

struct Reader::Impl {
  std::string path, digest;
  double size = 0;  ///< size of the file, bytes
  File file;
  bool compare_units = true;

  [[noreturn]] void fail(const std::string& dataset, const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", path, dataset, what));
  }

  /// Opens the file after a check of its digest; false if another file has taken its name meanwhile, which the library
  /// may have opened. The library itself opens no file that has lost its name.
  bool open_file(const std::string& format) {
    const OpenFile open(path);
    digest = checked_digest(open.path(), path);
    size = double(fs::file_size(open.path()));
    const Properties access(H5Pcreate(H5P_FILE_ACCESS));
    H5Pset_file_locking(access.get(), false, true);  // locks fail on read-only and network file systems
    const bool is_hdf5 = H5Fis_hdf5(path.c_str()) > 0;
    if (is_hdf5) file = File(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
    const std::string reason = last_error();
    if (!open.is_at(path)) return false;
    if (!is_hdf5) throw FileError(fmt::format("{}: is not an HDF5 file (expected a '{}' file)", path, format));
    if (!file) throw FileError(fmt::format("{}: is damaged or truncated: {}", path, reason));
    return true;
  }

  Dataset open(const std::string& name) const {
    if (!has(name)) fail(name, "dataset is missing");
    Dataset set(H5Dopen2(file.get(), name.c_str(), H5P_DEFAULT));
    if (!set) fail(name, fmt::format("dataset is damaged ({})", last_error()));
    check_own(set, name);
    return set;
  }

  /// Tells whether the file has a dataset or group. Rejects paths with links that do not end in the file.
  [[nodiscard]] bool has(const std::string& name) const {
    const Properties own_links(
        H5Pcreate(H5P_LINK_ACCESS));  // at an external one's end may be a pipe, which waits forever
    H5Pset_elink_cb(
        own_links.get(), [](const char*, const char*, const char*, const char*, unsigned*, hid_t, void*) { return -1; },
        nullptr);
    for (auto end = name.find('/');; end = name.find('/', end + 1)) {
      const std::string part = name.substr(0, end);
      const htri_t exists = H5Lexists(file.get(), part.c_str(), H5P_DEFAULT);
      if (exists < 0) fail(name, fmt::format("is damaged ({})", last_error()));
      if (exists == 0) return false;
      H5L_info_t link;
      if (H5Lget_info(file.get(), part.c_str(), &link, H5P_DEFAULT) < 0) fail(name, "is a damaged link");
      if (link.type != H5L_TYPE_HARD && link.type != H5L_TYPE_SOFT) refuse_foreign(name);
      if (H5Oexists_by_name(file.get(), part.c_str(), own_links.get()) <= 0)
        fail(name, fmt::format("\"{}\" leads to nothing in this file (a damaged object or a link elsewhere)", part));
      if (end == std::string::npos) return true;
    }
  }

  [[noreturn]] void refuse_foreign(const std::string& name) const {
    fail(name,
         "its values are in another file or dataset (a link, external or virtual storage), expected values in "
         "this file; read them and write them into it");
  }

  /// Rejects a dataset whose values are in other files or datasets. No digest covers those, and a virtual dataset that
  /// is its own source would put the library in an endless loop.
  void check_own(const Dataset& set, const std::string& name) const {
    const Properties creation(H5Dget_create_plist(set.get()));
    const H5D_layout_t layout = H5Pget_layout(creation.get());
    const bool known = layout == H5D_COMPACT || layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED;
    if (file_of(set.get()) == file_of(file.get()) && known && H5Pget_external_count(creation.get()) == 0) return;
    refuse_foreign(name);
  }

  /// Rejects extents that are too large for the file, before memory is allocated for them.
  void check_size(const Dataset& set, const std::string& name, const std::vector<hsize_t>& extents) const {
    constexpr double max_ratio = 1032;  // highest compression ratio of deflate
    const Type type(H5Dget_type(set.get()));
    const Properties creation(H5Dget_create_plist(set.get()));
    double entries = 1;
    for (const hsize_t extent : extents) entries *= double(extent);
    const double bytes = entries * double(H5Tget_size(type.get()));
    // Chunks may be compressed, and fill values need no bytes.
    const bool is_plain = H5Pget_layout(creation.get()) != H5D_CHUNKED && H5Dget_storage_size(set.get()) > 0;
    const bool is_text = H5Tget_class(type.get()) == H5T_STRING;  // which takes more memory than bytes of the file
    if (bytes > (is_plain ? 1 : max_ratio) * size || (is_text && entries * sizeof(std::string) > max_ratio * size))
      fail(name,
           fmt::format("claims {:.3g} bytes, shape ({}), more than a file of {:.0f} bytes can hold; it is damaged",
                       bytes, fmt::join(extents, ", "), size));
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
    check_size(set, name, extents);
    return found;
  }

  void check_unit(const Dataset& set, const std::string& name, const std::string& expected) const {
    const auto found = read_text_attribute(set.get(), "unit");
    if (compare_units && found && *found != expected)
      fail(name, fmt::format("unit is '{}', expected '{}'", *found, expected));
  }

  /// Reads the k-th of n equal parts.
  void read(const Dataset& set, const std::string& name, hid_t memory_type, void* into, std::size_t k = 0,
            std::size_t n = 1) const {
    const Space space(H5Dget_space(set.get())), part = select_part(space, k, n);
    if (H5Dread(set.get(), memory_type, part.get(), space.get(), H5P_DEFAULT, into) < 0)
      fail(name, fmt::format("cannot be read: {}", last_error()));
  }

  /// Root attribute of n integers; empty if the file has none.
  std::vector<int> integers(const char* name, int n) const {
    std::vector<int> values(n);
    const Attribute attribute(H5Aopen(file.get(), name, H5P_DEFAULT));
    const Space space(H5Aget_space(attribute.get()));
    const Type type(H5Aget_type(attribute.get()));
    const bool is_valid = attribute && H5Tget_class(type.get()) == H5T_INTEGER &&
                          H5Sget_simple_extent_npoints(space.get()) == n &&
                          H5Aread(attribute.get(), H5T_NATIVE_INT, values.data()) >= 0;
    return is_valid ? values : std::vector<int>();
  }

  /// Name of the program that wrote the file.
  [[nodiscard]] std::string maker() const {
    const std::string generator = read_text_attribute(file.get(), "generator").value_or("");
    const std::string name(generator.begin(), std::find(generator.begin(), generator.end(), ' '));
    return name.empty() ? "the earlier stage" : name;
  }

  void check_format(const Format& format) const {
    const std::string found = read_text_attribute(file.get(), "format").value_or("");
    if (found != format.name)
      throw FileError(
          found.empty()
              ? fmt::format("{}: is not a file of fastjoint (it has no attribute 'format'), expected a '{}' file", path,
                            format.name)
              : fmt::format("{}: is a '{}' file, expected '{}'", path, found, format.name));
    const auto version = integers("version", 2);
    if (version.empty()) throw FileError(fmt::format("{}: attribute 'version' is not [major, minor]", path));
    if (version[0] != format.major)
      throw FileError(fmt::format("{}: format version {}.{}, this program reads {}.x; {}", path, version[0], version[1],
                                  format.major,
                                  version[0] > format.major ? "use a newer program" : "run " + maker() + " again"));
  }

  template <class Scalar>
  void check_entries(const std::string& name, std::span<const Scalar> entries, const Allowed& allowed) const {
    const auto refuse = [&](const std::string& what) {
      fail(name, fmt::format("holds {}, expected {}", what, allowed.text));
    };
    if constexpr (std::is_same_v<Scalar, std::string>) {
      for (const auto& text : entries)
        if (allowed.words && std::ranges::find(*allowed.words, text) == allowed.words->end())
          refuse(fmt::format("\"{}\"", text));
    } else {
      for (std::size_t i = 0; i < entries.size(); ++i) {
        if (!(entries[i] >= allowed.low && entries[i] <= allowed.high) &&
            !(allowed.may_be_nan && std::isnan(double(entries[i]))))
          refuse(fmt::format("{}", entries[i]));
        if (i > 0 && entries[i] < entries[i - 1] + allowed.step)
          refuse(fmt::format("{}, {}", entries[i - 1], entries[i]));
      }
    }
  }
};

Reader::Reader(std::string path, const Format& format) : impl_(std::make_unique<Impl>()) {
  take_over_error_reporting();
  impl_->path = std::move(path);
  if (std::error_code none; fs::exists(impl_->path, none) && !fs::is_regular_file(impl_->path, none))
    throw FileError(fmt::format("{}: is not a regular file", impl_->path));
  while (!impl_->open_file(format.name)) impl_->file = File();
  impl_->check_format(format);
}

Reader::~Reader() = default;

const std::string& Reader::path() const { return impl_->path; }

const std::string& Reader::digest() const { return impl_->digest; }

void Reader::compare_units(bool compare) { impl_->compare_units = compare; }

bool Reader::has(const std::string& dataset) const { return impl_->has(dataset); }

void Reader::attribute(const std::string& name, std::string& text) const {
  text = read_text_attribute(impl_->file.get(), name.c_str()).value_or(text);
}

int Reader::integer_attribute(const std::string& name) const {
  const auto value = impl_->integers(name.c_str(), 1);
  if (value.empty()) throw FileError(fmt::format("{}: attribute '{}' is missing or not one integer", path(), name));
  return value[0];
}

template <class Scalar>
void Reader::get(const std::string& name, const Shape& expected, const std::string& unit, const Allowed& allowed,
                 const MakeRoom<Scalar>& make_room) const {
  constexpr bool is_text = std::is_same_v<Scalar, std::string>, is_integer = std::is_same_v<Scalar, int>;
  std::optional<Scalar> default_entry;
  if constexpr (is_text)
    default_entry = allowed.word;
  else
    default_entry = allowed.number;
  if (std::ranges::find(expected, 0) != expected.end()) default_entry = Scalar();
  if (default_entry && !has(name)) {
    Shape shape = expected;
    for (auto& extent : shape) extent = std::max<Eigen::Index>(extent, 0);
    for (const auto& entries : make_room(shape)) std::fill(entries.begin(), entries.end(), *default_entry);
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
      read_texts(type, parts[k], [&](void* into) { impl_->read(set, name, type.get(), into); });
    else
      impl_->read(set, name, is_integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, parts[k].data(), k, parts.size());
    impl_->check_entries<Scalar>(name, parts[k], allowed);
  }
}

template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<double>&) const;
template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<int>&) const;
template void Reader::get(const std::string&, const Shape&, const std::string&, const Allowed&,
                          const MakeRoom<std::string>&) const;

}  // namespace fastjoint::h5
