// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <string>
#include <utility>

#include "common/errors.hpp"
#include "common/linalg/processor.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace fastjoint::program {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double kilobyte = 1024;

/// Reads the number after a word in a file of the Linux kernel, in bytes; `otherwise` if there is no such file or word.
double entry(const std::string& path, const std::string& name, double otherwise, double unit = kilobyte) {
  std::ifstream in(path);
  for (std::string word; in >> word;)
    if (double value = 0; word == name && in >> value) return unit * value;
  return otherwise;
}

/// Reads a file that contains one number; "max" or a missing file means no limit.
double number(const std::string& path) {
  std::ifstream in(path);
  double value = 0;
  return in >> value ? value : unlimited;
}

/// What the limits of this process leave: of its address space, and of what it may write in it (ulimit -v, -d).
double left_in_address_space() {
  double left = unlimited;
  for (const auto& [which, used] : {std::pair(RLIMIT_AS, "VmSize:"), std::pair(RLIMIT_DATA, "VmData:")}) {
    rlimit limit{};
    if (getrlimit(which, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      left = std::min(left, static_cast<double>(limit.rlim_cur) - entry("/proc/self/status", used, 0));
  }
  return left;
}

/// OpenBLAS reserves this for each thread, and retries without end if it fails, so all of it must be available.
constexpr double blas_of_thread = 1 << 27;

}  // namespace

double left_in_control_group(const std::string& folder) {
  const bool first_version = std::filesystem::exists(folder + "memory.limit_in_bytes");
  const auto cached = [&](const std::string& list) {
    return entry(folder + "memory.stat", first_version ? "total_" + list : list, unlimited, 1);
  };
  return number(folder + (first_version ? "memory.limit_in_bytes" : "memory.max")) -
         number(folder + (first_version ? "memory.usage_in_bytes" : "memory.current")) + cached("inactive_file") +
         cached("active_file");
}

double available_memory() {
  static const double found = [] {
    const double built_in = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    double min = entry("/proc/meminfo", "MemAvailable:", built_in);
    for (const double left : {left_in_control_group("/sys/fs/cgroup/"), left_in_control_group("/sys/fs/cgroup/memory/"),
                              left_in_address_space()})
      if (left < min) min = left;  // false for the NaN of a missing file
    return std::max(min, 0.0);
  }();
  return found;
}

double peak_memory() {
  // A child process inherits ru_maxrss of its parent, such as a large Python script; it does not inherit VmHWM.
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return entry("/proc/self/status", "VmHWM:", kilobyte * static_cast<double>(usage.ru_maxrss));
}

std::string bytes_text(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

void require_memory(const std::string& what, double need, const std::string& parts, const std::string& allowed) {
  if (const double available = available_memory(); need > available)
    throw InputError(fmt::format("{} takes about {} of memory{}, {} are available; allowed: {}", what, bytes_text(need),
                                 parts, bytes_text(available), allowed));
}

void require_memory_to_start() {
  constexpr std::size_t start = 16 << 20;
  void* block = ::operator new(start, std::nothrow);
  ::operator delete(block);
  const int n_threads = linalg::blas_threads();
  const std::string need = bytes_text(start + n_threads * blas_of_thread);
  if (block == nullptr || left_in_address_space() < n_threads * blas_of_thread)
    throw InputError(
        fmt::format("starting takes about {} of memory, less than {} are available; allowed: a higher limit (ulimit "
                    "-v, -d), or a lower OPENBLAS_NUM_THREADS than {}",
                    need, need, n_threads));
  linalg::reserve_blas_memory();
}

int threads_that_fit(int wanted) {
  constexpr double stack = 1 << 23, arena = 1 << 27;  // each thread has these besides
  const double left = left_in_address_space() / (blas_of_thread + stack + arena);
  return left < wanted - 1 ? 1 + static_cast<int>(std::max(left, 0.0)) : wanted;
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, 1 << 24);
#endif
}

}  // namespace fastjoint::program
