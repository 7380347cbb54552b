// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace fastjoint::linalg {

/// Sets the number of threads of for_each_index; the default is 1. BLAS and the loops of CHOLMOD run on one thread:
/// their blocks are small, and synchronising threads in each block made whole runs up to four times as long.
void set_threads(int n);
[[nodiscard]] int threads();

/// Calls f(0) ... f(n - 1), each once, on all threads, started in this order; a nested loop inside f stays on its
/// thread. An exception of f ends the loop and is rethrown when all threads have stopped.
void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f);

/// Number of threads of OpenBLAS, each of which reserves memory; 1 for another BLAS.
[[nodiscard]] int blas_threads();

/// Lets BLAS reserve the memory that it otherwise reserves when it is first called. Needs that are held against what is
/// left then mean what is left: without it stage2_extract --field began with too little and ran out of memory on the
/// way (test `memory`).
void reserve_blas_memory();

/// The processor for which the kernels of OpenBLAS are made, such as "Haswell"; empty for another BLAS.
[[nodiscard]] std::string blas_kernels();

/// Kernels that are faster than the chosen ones, or an empty string. OpenBLAS recognises a processor by its model; for
/// one newer than itself it chooses "Prescott" of 2004: stage1_plate took 1.01 s with it and 0.76 s with "Haswell" for
/// the panel of scripts/measure/make_panel 10 10.
[[nodiscard]] std::string better_kernels(const std::string& chosen, bool has_avx2, bool has_avx512);

/// Restarts the program with better kernels, if there are any and OPENBLAS_CORETYPE is not set. OpenBLAS chooses its
/// kernels once, before main, so this must be the first call in main.
void take_better_kernels(char** argv);

}  // namespace fastjoint::linalg
