// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/h5/handle.hpp"

#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

namespace fastjoint::h5 {

void take_over_error_reporting() {
  H5dont_atexit();  // after a failed close (disk full), libhdf5 would crash at exit
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
  constexpr std::string_view number = "errno = ";  // only the number of the system's error is worth reporting
  if (const auto at = deepest.find(number); at != deepest.npos)
    return std::strerror(std::atoi(deepest.c_str() + at + number.size()));
  return deepest.empty() ? "unknown reason" : deepest;
}

Space select_part(const Space& whole, std::size_t k, std::size_t n) {
  if (n == 1) return Space(H5Scopy(whole.get()));
  const int rank = H5Sget_simple_extent_ndims(whole.get());
  std::vector<hsize_t> extents(rank), start(rank, 0);
  H5Sget_simple_extent_dims(whole.get(), extents.data(), nullptr);
  extents[0] /= n;
  start[0] = k * extents[0];
  H5Sselect_hyperslab(whole.get(), H5S_SELECT_SET, start.data(), nullptr, extents.data(), nullptr);
  return Space(H5Screate_simple(rank, extents.data(), nullptr));
}

Type utf8_string() {
  Type type(H5Tcopy(H5T_C_S1));
  H5Tset_size(type.get(), H5T_VARIABLE);
  H5Tset_cset(type.get(), H5T_CSET_UTF8);
  return type;
}

}  // namespace fastjoint::h5
