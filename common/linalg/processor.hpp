// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace fastjoint::linalg {

/// Threads that for_each_index may use, from now on; 1 until then. BLAS and the loops of CHOLMOD run on one: their
/// blocks are small, and threads that wait for each other in each block made whole runs up to four times as long.
void set_threads(int n);
[[nodiscard]] int threads();

/// Calls f(0) ... f(n - 1), each once, on all threads, begun in this order; a loop inside f stays on its thread. An
/// exception of f ends the loop, and is thrown when all threads have stopped.
void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f);

/// Threads of BLAS, each of which reserves memory; 1 of one that is not OpenBLAS.
[[nodiscard]] int blas_threads();

/// Lets BLAS reserve the memory that it otherwise reserves when it is first called.
void reserve_blas_memory();

/// The processor for which the kernels of OpenBLAS are made, such as "Haswell"; empty for another BLAS.
[[nodiscard]] std::string blas_kernels();

/// The kernels to take instead of the chosen ones, or an empty string. OpenBLAS knows a processor by its model; for one
/// newer than itself it chooses "Prescott", of 2004, which takes up to four times as long.
[[nodiscard]] std::string better_kernels(const std::string& chosen, bool has_avx2, bool has_avx512);

/// Begins the program again with better kernels, where there are any and OPENBLAS_CORETYPE leaves the choice to
/// OpenBLAS: it chooses before main, and once. To be called first of all.
void take_better_kernels(char** argv);

}  // namespace fastjoint::linalg
