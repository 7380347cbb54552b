// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
// Only the .cpp files of this folder include this header: hid_t stays here.

#include <hdf5.h>

#include <string>
#include <utility>

namespace fastjoint::h5 {

/// Deepest description on HDF5's error stack, which is then cleared; "unknown reason" if it is empty.
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
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) CloseFn(id_);
  }
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

/// Variable-length UTF-8 string, which h5py shows as str.
[[nodiscard]] Type utf8_string();

}  // namespace fastjoint::h5
