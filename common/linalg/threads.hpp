// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>

namespace fastjoint::linalg {

/// Threads that for_each_index may use, from now on; 1 until then. BLAS and the loops of CHOLMOD run on one: their
/// blocks are small, and threads that wait for each other in each block made whole runs up to four times as long.
void set_threads(int n);
[[nodiscard]] int threads();

/// Calls f(0) ... f(n - 1), each once, on all threads, begun in this order; a loop inside f stays on its thread. An
/// exception of f ends the loop, and is thrown when all threads have stopped.
void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f);

}  // namespace fastjoint::linalg
