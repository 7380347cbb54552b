// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/linalg/threads.hpp"

#include <cblas.h>
#include <omp.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

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
    for (std::size_t i = 1; i < n_workers; ++i) workers.emplace_back(work);
    work();
  }
  in_loop = false;
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace fastjoint::linalg
