// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/blas.hpp"

#include <cblas.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace fastjoint::linalg {

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
  std::error_code error;  // whatever fails, the run goes on as it is
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (better.empty() || error || ::setenv("OPENBLAS_CORETYPE", better.c_str(), 0) != 0) return;
  ::execv(program.c_str(), argv);
#else
  static_cast<void>(argv);
#endif
}

}  // namespace fastjoint::linalg
