// SPDX-License-Identifier: GPL-3.0-or-later
// Tables in CSV: the points of a law, and each column of a study's. They are read by their path, here of a file in
// memory.
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

#include "common/input/csv.hpp"
#include "stage3_nonlinear/laws/law.hpp"
#include "stage3_nonlinear/study/variable.hpp"
#include "tests/fuzz/reading.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fastjoint;
  static const int file = memfd_create("table.csv", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  if (ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != ssize_t(size)) std::abort();
  fuzz::read(data, size, [](const std::string&) { (void)stage3::read_points(path); });
  return fuzz::read(data, size, [](const std::string&) {
    const auto rows = input::read_csv(path);
    if (!rows.empty())
      for (const auto& name : rows.front().cells) (void)stage3::read_column(path, name);
  });
}
