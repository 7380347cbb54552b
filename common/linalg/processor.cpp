// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/processor.hpp"

#include <cblas.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

/// What BLAS calls, in place of its own, for an argument that it does not take.
///
/// Eigen passes on products of matrices without rows, as those of sheets without fasteners have; BLAS refuses their
/// leading dimension 0 and returns, which is right: there is nothing to compute. All else is said as BLAS says it.
/// Programs of tests, which are to see any such call, have a definition of their own.
extern "C" [[gnu::weak]] void xerbla_(const char* name, const int* argument, std::size_t length) {
  constexpr std::array<std::pair<std::string_view, int>, 6> leading_dimensions{
      {{"DGEMV", 6}, {"DSYMV", 5}, {"DGEMM", 8}, {"DGEMM", 10}, {"DGEMM", 13}, {"DSYMM", 7}}};
  const std::string_view called(name, length);
  for (const auto& [known, at] : leading_dimensions)
    if (called.starts_with(known) && *argument == at) return;
  std::fprintf(stderr, " ** On entry to %.*s parameter number %d had an illegal value\n", int(length), name, *argument);
}

namespace fastjoint::linalg {
namespace {

int n_threads = 1;
thread_local bool in_loop = false;

}  // namespace

void set_threads(int n) {
  n_threads = n;
#ifdef FASTJOINT_HAS_OPENBLAS  // another BLAS keeps the threads that its own environment variable gives it
  openblas_set_num_threads(1);
#endif
  omp_set_max_active_levels(0);
}

int threads() { return n_threads; }

void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f) {
  const auto n_workers = in_loop ? 1 : std::min<std::size_t>(n, n_threads);
  if (n_workers <= 1) {
    for (std::size_t i = 0; i < n; ++i) f(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    in_loop = true;
    omp_set_max_active_levels(0);  // each thread has a setting of its own
    for (std::size_t i = next++; i < n; i = next++) try {
        f(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = n;
      }
  };
  {
    std::vector<std::jthread> workers;
    try {
      for (std::size_t i = 1; i < n_workers; ++i) workers.emplace_back(work);
    } catch (const std::system_error&) {  // a limit on processes: those that there are do all the work
    }
    work();
  }
  in_loop = false;
  if (thrown) std::rethrow_exception(thrown);
}

int blas_threads() {
#ifdef FASTJOINT_HAS_OPENBLAS
  return openblas_get_num_threads();
#else
  return 1;
#endif
}

void reserve_blas_memory() {
  const double A[] = {1, 0, 0, 1};
  double x[] = {0, 0, 0, 0};
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 2, 2, 1, A, 2, x, 2);
}

std::string blas_kernels() {
#ifdef FASTJOINT_HAS_OPENBLAS
  return openblas_get_corename();
#else
  return "";
#endif
}

std::string better_kernels(const std::string& chosen, bool has_avx2, bool has_avx512) {
  if (chosen != "Prescott" || !has_avx2) return "";
  return has_avx512 ? "SkylakeX" : "Haswell";
}

void take_better_kernels(char** argv) {
#ifdef __x86_64__
  if (std::getenv("OPENBLAS_CORETYPE") != nullptr) return;
  const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool has_avx512 =
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
  const std::string better = better_kernels(blas_kernels(), has_avx2, has_avx512);
  std::error_code error;  // after any failure the run continues with the chosen kernels
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (better.empty() || error || ::setenv("OPENBLAS_CORETYPE", better.c_str(), 0) != 0) return;
  ::execv(program.c_str(), argv);
#else
  static_cast<void>(argv);
#endif
}

}  // namespace fastjoint::linalg
