// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/program/memory.hpp"

#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace fastjoint::program {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number of kB behind a word of a file of the system, in bytes.
double entry(const char* path, const std::string& name) {
  std::ifstream in(path);
  std::string word;
  double kilobytes = 0;
  while (in >> word)
    if (word == name && in >> kilobytes) return 1024 * kilobytes;
  return unlimited;
}

/// The number that is all of a file; one that says "max", or is not there, sets no limit.
double number(const std::string& path) {
  std::ifstream in(path);
  double value = 0;
  return in >> value ? value : unlimited;
}

/// Of version 2 of control groups, as a container sees its own.
double left_in_control_group() {
  const std::string folder = "/sys/fs/cgroup/";
  return number(folder + "memory.max") - number(folder + "memory.current");
}

double left_in_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  return static_cast<double>(limit.rlim_cur) - entry("/proc/self/status", "VmSize:");
}

}  // namespace

double available_memory() {
  double least = entry("/proc/meminfo", "MemAvailable:");
  for (const double left : {left_in_control_group(), left_in_address_space()})
    if (left < least) least = left;  // not a number where a file is not there
  return std::max(least, 0.0);
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, 1 << 24);
#endif
}

}  // namespace fastjoint::program
