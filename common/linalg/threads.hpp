// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace fastjoint::linalg {

/// Threads that for_each_index and the dense kernels of BLAS may use, from now on; 1 until then. Loops that libraries
/// spread by themselves run on one: CHOLMOD asks for four threads whatever there are, which then wait for each other.
void set_threads(int n);

/// Threads of BLAS, each of which reserves memory; 1 of one that is not OpenBLAS.
[[nodiscard]] int blas_threads();

/// Lets BLAS reserve the memory that it otherwise reserves when it is first called.
void reserve_blas_memory();

/// Calls f(0) ... f(n - 1), each once, on all threads, in no order; BLAS has one thread in each. An exception of f ends
/// the loop, and is thrown when all threads have stopped.
void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f);

}  // namespace fastjoint::linalg
