// SPDX-License-Identifier: GPL-3.0-or-later
// Time of the exact path against the nonlinear solver, for rows of n fasteners with random clearances.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <random>

#include "stage3_nonlinear/path/exact_path.hpp"
#include "stage3_nonlinear/path/load_path.hpp"
#include "stage3_nonlinear/solvers/root.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace {

using namespace fastjoint;
using namespace fastjoint::stage3;

/// A row of n fasteners between equal sheets, three of four loose; the load closes most of them.
JointEquations row_of(int n, double friction) {
  std::mt19937 random(7);
  constexpr double k = 1e5;
  test::Lap lap{test::chain(n, 1, k, {{n - 1, n, k}}), test::chain(n, 0, k, {{0, test::ground, k}}), 1000.0 * n};
  if (friction > 0) {
    test::add_friction(lap.a, random);
    test::add_friction(lap.b, random);
  }
  auto joint = test::joint_of(lap, test::linear_law(2e4));
  for (Index j = 0; j < std::ssize(joint.planes); ++j) {
    if (j % 4 != 0) joint.planes[j].clearance = std::uniform_real_distribution<double>(0.001, 0.1)(random);
    if (friction > 0) test::set_friction(joint, j, friction);
  }
  return make_equations(joint);
}

/// Milliseconds, the least of several runs.
double milliseconds(const std::function<void()>& work) {
  constexpr int runs = 5;
  double least = 1e300;
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    least = std::min(least, time.count());
  }
  return least;
}

}  // namespace

int main() {
  take_over_gsl_errors();
  fmt::print("{:>4} {:>8} {:>8} {:>10} {:>12} {:>12}\n", "n", "friction", "corners", "increments", "exact [ms]",
             "hybridsj [ms]");
  for (const double friction : {0.0, 0.2})
    for (const int n : {10, 50, 100}) {
      const JointEquations equations = row_of(n, friction);
      for (const int increments : {1, 10, 100}) {
        std::vector<double> factors;
        for (int i = 1; i <= increments; ++i) factors.push_back(static_cast<double>(i) / increments);
        const auto follow_by = [&](stage3::Method method) {
          return milliseconds([&] { (void)follow(equations, factors, {{}, {.method = method}}); });
        };
        fmt::print("{:>4} {:>8} {:>8} {:>10} {:>12.2f} {:>12.2f}\n", n, friction,
                   exact_path(equations, 1).pieces.size() - 1, increments, follow_by(stage3::Method::exact_path),
                   follow_by(stage3::Method::hybridsj));
      }
    }
}
