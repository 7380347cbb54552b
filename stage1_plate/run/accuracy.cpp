// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/accuracy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "stage1_plate/run/hoop_error.hpp"
#include "stage1_plate/run/solve.hpp"

namespace fastjoint::stage1 {
namespace {

/// Most that waves may leave out (PlateScene::left_out_of_waves).
constexpr double most_left_out = 1e-2;

bool leaves_rings(const PlateScene& scene, const Hole& hole) {
  return std::holds_alternative<GridGeometry>(scene.geometry) && !hole.has_rings;
}

/// Integrates once, then raises the degree until it does, or to the scene's highest.
void raise_degree(Accuracy& model) {
  const PlateMesh plate = make_mesh(model.scene);
  PlateProblem problem = number_unknowns(model.scene, plate);
  check_held(model.scene, plate, problem.unknowns);
  const plate::Skeleton skeleton(problem);
  if (problem.unknowns.n_controlled() == 0 && std::isfinite(model.asked.matrices))
    throw InputError(
        fmt::format("{}: --accuracy is the error of S, R and C_t, and the stiffness S of discs and rigid externals is "
                    "missing; allowed: a scene with a disc or a rigid external",
                    model.scene.file));
  const int highest = model.scene.p_high;
  const bool with_hoop = std::isfinite(model.asked.hoop);
  const auto waves = rim_waves(model.scene, plate);
  if (with_hoop && std::ranges::none_of(waves, [](const auto& rim) { return rim.has_value(); }))
    throw InputError(
        fmt::format("{}: --peak-accuracy is the error of hoop stresses around holes, and no hole has any; allowed: a "
                    "scene with a hole that is not linked and has no \"stresses\": false",
                    model.scene.file));
  Eigen::MatrixXd below;
  matrices::CondensedLevels levels;
  for (int p = model.scene.p_low; p <= highest; ++p) {
    const auto alone = Eigen::VectorXi::Constant(1, p);
    require_memory(model.scene.file, p, memory_need(problem, skeleton, alone));
    if (p == model.scene.p_low) integrate(model.scene, plate, problem);
    const plate::PlateFactor K(problem, skeleton, p, with_hoop);
    auto cases = solve_degree(problem, K, p).cases;
    levels.S.push_back(std::move(cases.S));
    levels.R.push_back(std::move(cases.R));
    levels.C.push_back(std::move(cases.C_t));
    if (with_hoop)
      model.hoop_error = hoop_error(waves, cases.W, below, problem.unknowns.n_controlled(), levels.C.back().cols());
    below = std::move(cases.W);
    const auto degrees = Eigen::VectorXi::LinSpaced(p - model.scene.p_low + 1, model.scene.p_low, p);
    model.errors =
        matrices::relative_errors(levels, degrees, K.diagonal_of_K_cc(), matrices::max_rate_of(model.scene.elasticity));
    model.scene.p_high = p;
    if (model.is_reached()) return;
  }
}

}  // namespace

Accuracy meet_accuracy(const PlateScene& scene, const Wanted& wanted) {
  if (scene.p_low == scene.p_high)
    throw InputError(fmt::format("{}: degree {} alone does not show its error; allowed: a range of degrees",
                                 std::isfinite(wanted.matrices) ? "--accuracy" : "--peak-accuracy", scene.p_low));
  constexpr int most_rings = 4;
  constexpr double worth = 0.5;  // of the error before, that another ring must come below
  Accuracy start{scene, wanted, {}, 0, false};
  if (std::isfinite(wanted.hoop)) start.scene.left_out_of_waves = std::clamp(0.03 * wanted.hoop, 1e-7, most_left_out);
  Accuracy best = start;
  for (int rings = 1; rings <= most_rings; ++rings) {
    Accuracy model = start;
    for (auto& hole : model.scene.holes)
      if (leaves_rings(scene, hole)) {
        hole.rings = rings;
        model.free_rings = true;
      }
    raise_degree(model);
    const bool helps = rings == 1 || model.is_reached() || model.excess() < worth * best.excess();
    if (helps) best = model;
    if (!helps || best.is_reached() || !best.free_rings) break;
  }
  return best;
}

std::string to_text(const Accuracy& chosen) {
  int rings = 0;
  for (const auto& hole : chosen.scene.holes)
    if (leaves_rings(chosen.scene, hole)) rings = hole.rings;
  std::vector<std::string> asked, found;
  if (std::isfinite(chosen.asked.matrices)) {
    asked.push_back(fmt::format("{:g}", chosen.asked.matrices));
    found.push_back(matrices::to_text(chosen.errors));
  }
  if (std::isfinite(chosen.asked.hoop)) {
    asked.push_back(fmt::format("of hoop stresses {:g}", chosen.asked.hoop));
    found.push_back(fmt::format("error of hoop stresses about {:.2e}", chosen.hoop_error));
  }
  return fmt::format("accuracy {}: {} space, p = {}{}: {}{}", fmt::join(asked, ", "), pfem::name_of(chosen.scene.space),
                     chosen.scene.p_high, chosen.free_rings ? fmt::format(", rings {}", rings) : std::string(),
                     fmt::join(found, ", "), chosen.is_reached() ? "" : ", not reached");
}

}  // namespace fastjoint::stage1
