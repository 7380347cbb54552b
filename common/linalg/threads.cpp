// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/threads.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

extern "C" {  // of OpenBLAS, whose header Debian keeps outside the usual path, and of the OpenMP that CHOLMOD is built
              // with
void openblas_set_num_threads(int);
void omp_set_max_active_levels(int);
}

namespace fastjoint::linalg {
namespace {

int n_threads = 1;

}  // namespace

void set_threads(int n) {
  n_threads = n;
  openblas_set_num_threads(n);
  omp_set_max_active_levels(0);
}

void for_each_index(std::size_t n, const std::function<void(std::size_t)>& f) {
  const auto n_workers = std::min<std::size_t>(n, n_threads);
  if (n_workers <= 1) {
    for (std::size_t i = 0; i < n; ++i) f(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i = next++; i < n; i = next++) try {
        f(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
        next = n;
      }
  };
  openblas_set_num_threads(1);
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 1; i < n_workers; ++i) workers.emplace_back(work);
    work();
  }
  openblas_set_num_threads(n_threads);
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace fastjoint::linalg
