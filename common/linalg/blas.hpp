// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace fastjoint::linalg {

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
