// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/accuracy.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/errors.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "stage1_plate/run/solve.hpp"

namespace fastjoint::stage1 {
namespace {

bool leaves_rings(const PlateScene& scene, const Hole& hole) {
  return std::holds_alternative<GridGeometry>(scene.geometry) && !hole.has_rings;
}

/// Integrates once, then raises the degree until it does, or to the scene's highest.
void raise_degree(Accuracy& model) {
  const PlateMesh plate = make_mesh(model.scene);
  PlateProblem problem = number_unknowns(model.scene, plate);
  check_held(model.scene, plate, problem.unknowns);
  const plate::Skeleton skeleton(problem);
  if (problem.unknowns.n_controlled() == 0)
    throw InputError(
        fmt::format("{}: --accuracy is the error of S, R and C_t, and the stiffness S of discs and rigid externals is "
                    "missing; allowed: a scene with a disc or a rigid external",
                    model.scene.file));
  const int highest = model.scene.p_high;
  matrices::CondensedLevels levels;
  for (int p = model.scene.p_low; p <= highest; ++p) {
    const auto alone = Eigen::VectorXi::Constant(1, p);
    require_memory(model.scene.file, p, memory_need(problem, skeleton, alone));
    if (p == model.scene.p_low) integrate(model.scene, plate, problem);
    const plate::PlateFactor K(problem, skeleton, p, false);
    auto cases = solve_degree(problem, K, p).cases;
    levels.S.push_back(std::move(cases.S));
    levels.R.push_back(std::move(cases.R));
    levels.C.push_back(std::move(cases.C_t));
    const auto degrees = Eigen::VectorXi::LinSpaced(p - model.scene.p_low + 1, model.scene.p_low, p);
    model.errors =
        matrices::relative_errors(levels, degrees, K.held_stiffness(), matrices::fastest_rate(model.scene.elasticity));
    model.scene.p_high = p;
    if (model.is_reached()) return;
  }
}

}  // namespace

Accuracy meet_accuracy(const PlateScene& scene, double accuracy) {
  if (scene.p_low == scene.p_high)
    throw InputError(
        fmt::format("--accuracy: degree {} alone does not show its error; allowed: a range of degrees", scene.p_low));
  constexpr int most_rings = 4;
  constexpr double worth = 0.5;  // of the error before, that another ring must come below
  Accuracy start{scene, accuracy, {}, false};
  Accuracy best = start;
  for (int rings = 1; rings <= most_rings; ++rings) {
    Accuracy model = start;
    for (auto& hole : model.scene.holes)
      if (leaves_rings(scene, hole)) {
        hole.rings = rings;
        model.free_rings = true;
      }
    raise_degree(model);
    const bool helps = rings == 1 || model.is_reached() || model.error() < worth * best.error();
    if (helps) best = model;
    if (!helps || best.is_reached() || !best.free_rings) break;
  }
  return best;
}

std::string to_text(const Accuracy& chosen) {
  int rings = 0;
  for (const auto& hole : chosen.scene.holes)
    if (leaves_rings(chosen.scene, hole)) rings = hole.rings;
  return fmt::format("accuracy {:g}: {} space, p = {}{}: {}{}", chosen.asked, pfem::name_of(chosen.scene.space),
                     chosen.scene.p_high, chosen.free_rings ? fmt::format(", rings {}", rings) : std::string(),
                     matrices::to_text(chosen.errors), chosen.is_reached() ? "" : ", not reached");
}

}  // namespace fastjoint::stage1
