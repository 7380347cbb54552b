// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/input/value.hpp"

namespace fastjoint::stage3 {

/// First guesses of Bortman & Szabo, section 6.1.
enum class Guess { rigid, linear, equal };

struct InitialScene {
  Guess guess = Guess::linear;
  std::optional<double> stiffness;  ///< of {"linear": K}, force / length
};

enum class Method {
  fitting,  ///< default: by the number of unknowns (iterative_method)
  hybridsj,
  damped_newton,
};

/// Values of "method" in JOINT.json, in the order of Method from hybridsj on.
inline const std::vector<std::string> method_names{"hybridsj", "damped newton"};

struct SolverScene {
  Method method = Method::fitting;
  double tolerance = 1e-10;  ///< largest residual, relative to the largest force of the increment
  int max_iterations = 200;  ///< of one try
};

/// Solver tried first for the increments. The default is hybridsj up to the number of unknowns above which damped
/// Newton takes less time, since GSL factorises without blocks (docs/solvers.md).
[[nodiscard]] inline Method iterative_method(Method method, std::ptrdiff_t n_unknowns) {
  constexpr std::ptrdiff_t max_for_hybridsj = 40;
  if (method == Method::hybridsj || method == Method::damped_newton) return method;
  return n_unknowns <= max_for_hybridsj ? Method::hybridsj : Method::damped_newton;
}

/// Reads "initial".
[[nodiscard]] InitialScene read_initial(const input::Value& value);
/// Reads "solver".
[[nodiscard]] SolverScene read_solver(const input::Value& value);

}  // namespace fastjoint::stage3
