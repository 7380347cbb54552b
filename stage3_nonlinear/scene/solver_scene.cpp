// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/scene/solver_scene.hpp"

#include "common/count.hpp"

namespace fastjoint::stage3 {

InitialScene read_initial(const input::Value& value) {
  if (value.is_object()) {
    value.only({"linear"});
    return {Guess::linear, value.at("linear").number(input::positive)};
  }
  if (!value.is_string()) value.not_allowed("\"rigid\", \"equal\" or {\"linear\": stiffness}");
  return {value.choice({"rigid", "equal"}) == "rigid" ? Guess::rigid : Guess::equal, std::nullopt};
}

SolverScene read_solver(const input::Value& value) {
  constexpr int max_iterations = 1000000;
  constexpr input::Range tolerances{.low = 1e-14, .high = 1e-2};
  value.only({"method", "tolerance", "max_iterations"});
  SolverScene solver;
  if (const auto method = value.find("method"))
    solver.method = static_cast<Method>(index_of(method_names, method->choice(method_names)) + 1);
  if (const auto tolerance = value.find("tolerance")) solver.tolerance = tolerance->number(tolerances);
  if (const auto given = value.find("max_iterations")) solver.max_iterations = given->integer(1, max_iterations);
  return solver;
}

}  // namespace fastjoint::stage3
