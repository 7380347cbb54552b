// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/handle.hpp"

#include "common/h5/library.hpp"

namespace fastjoint::h5 {

void take_over_error_reporting() {
  H5dont_atexit();  // a close that failed (disk full) would crash libhdf5 at exit
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string last_error() {
  std::string deepest;
  const auto keep = [](unsigned, const H5E_error2_t* entry, void* text) -> herr_t {
    if (entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep, &deepest);
  H5Eclear2(H5E_DEFAULT);
  return deepest.empty() ? "unknown reason" : deepest;
}

Type utf8_string() {
  Type type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace fastjoint::h5
