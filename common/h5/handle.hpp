// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Only the .cpp files of this folder include this header: hid_t stays here.

#include <hdf5.h>

#include <string>
#include <utility>

namespace fastjoint::h5 {

/// Turns off HDF5's error traces on stderr, since errors are reported as exceptions. Must precede all other calls of
/// HDF5.
void take_over_error_reporting();

/// Returns the innermost description on HDF5's error stack and clears the stack: the system's reason if a system call
/// failed, "unknown reason" if the stack is empty.
[[nodiscard]] std::string last_error();

/// Owns one HDF5 identifier and closes it with CloseFn.
template <herr_t (*CloseFn)(hid_t)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ >= 0) CloseFn(id_);
  }
  /// Closes the identifier; true if that succeeded.
  [[nodiscard]] bool close() { return CloseFn(std::exchange(id_, H5I_INVALID_HID)) >= 0; }
  [[nodiscard]] hid_t get() const { return id_; }
  [[nodiscard]] explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Attribute = Handle<H5Aclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Properties = Handle<H5Pclose>;

/// Selects the k-th of n equal parts of a dataspace along the first extent, and returns the dataspace of the part.
[[nodiscard]] Space select_part(const Space& whole, std::size_t k, std::size_t n);

/// Variable-length UTF-8 string, which h5py shows as str.
[[nodiscard]] Type utf8_string();

}  // namespace fastjoint::h5
