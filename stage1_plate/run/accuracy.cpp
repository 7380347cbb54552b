// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/accuracy.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "common/errors.hpp"
#include "stage1_plate/problem/plate_problem.hpp"
#include "stage1_plate/run/solve.hpp"

namespace fastjoint::stage1 {
namespace {

/// Upper bound of PlateScene::wave_tolerance.
constexpr double max_wave_tolerance = 1e-2;

bool has_free_rings(const PlateScene& scene, const Hole& hole) {
  return std::holds_alternative<GridGeometry>(scene.geometry) && !hole.has_rings;
}

/// Integrates once, then raises the degree until the targets are reached, at most to the scene's highest.
void raise_degree(Accuracy& model) {
  const PlateMesh plate = make_mesh(model.scene);
  PlateProblem problem = number_unknowns(model.scene, plate);
  check_rigid_motions(model.scene, plate, problem.unknowns);
  const plate::Skeleton skeleton(problem);
  if (problem.unknowns.n_controlled() == 0 && std::isfinite(model.targets.matrices))
    throw InputError(
        fmt::format("{}: --accuracy is the error of S, R and C_t, and the stiffness S of discs and rigid externals is "
                    "missing; allowed: a scene with a disc or a rigid external",
                    model.scene.file));
  const int highest = model.scene.p_high;
  const bool with_hoop = std::isfinite(model.targets.hoop);
  if (with_hoop && std::ranges::none_of(problem.waves, [](const auto& rim) { return rim.has_value(); }))
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
    const auto K =
        with_extremes(model.scene, plate, problem, [&] { return plate::PlateFactor(problem, skeleton, p, with_hoop); });
    auto cases = solve_degree(problem, K, p).cases;
    levels.S.push_back(std::move(cases.S));
    levels.R.push_back(std::move(cases.R));
    levels.C.push_back(std::move(cases.C_t));
    if (with_hoop)
      model.hoop_error =
          hoop_error(problem.waves, cases.W, below, problem.unknowns.n_controlled(), levels.C.back().cols());
    below = std::move(cases.W);
    const auto degrees = Eigen::VectorXi::LinSpaced(p - model.scene.p_low + 1, model.scene.p_low, p);
    model.errors =
        matrices::relative_errors(levels, degrees, K.diagonal_of_K_cc(), matrices::max_rate_of(model.scene.elasticity));
    model.scene.p_high = p;
    if (model.is_reached()) return;
  }
}

}  // namespace

Accuracy meet_accuracy(const PlateScene& scene, const Targets& targets) {
  if (scene.p_low == scene.p_high)
    throw InputError(fmt::format("{}: degree {} alone does not show its error; allowed: a range of degrees",
                                 std::isfinite(targets.matrices) ? "--accuracy" : "--peak-accuracy", scene.p_low));
  constexpr int max_rings = 4;
  constexpr double min_gain = 0.5;  // another ring must reduce the error by this factor
  Accuracy start{scene, targets, {}, 0, false};
  if (std::isfinite(targets.hoop))
    start.scene.wave_tolerance = std::clamp(0.03 * targets.hoop, 1e-7, max_wave_tolerance);
  Accuracy best = start;
  for (int rings = 1; rings <= max_rings; ++rings) {
    Accuracy model = start;
    for (auto& hole : model.scene.holes)
      if (has_free_rings(scene, hole)) {
        hole.rings = rings;
        model.free_rings = true;
      }
    raise_degree(model);
    const bool helps = rings == 1 || model.is_reached() || model.excess() < min_gain * best.excess();
    if (helps) best = model;
    if (!helps || best.is_reached() || !best.free_rings) break;
  }
  return best;
}

std::string to_text(const Accuracy& chosen) {
  int rings = 0;
  for (const auto& hole : chosen.scene.holes)
    if (has_free_rings(chosen.scene, hole)) rings = hole.rings;
  std::vector<std::string> targets, found;
  if (std::isfinite(chosen.targets.matrices)) {
    targets.push_back(fmt::format("{:g}", chosen.targets.matrices));
    found.push_back(matrices::to_text(chosen.errors));
  }
  if (std::isfinite(chosen.targets.hoop)) {
    targets.push_back(fmt::format("of hoop stresses {:g}", chosen.targets.hoop));
    found.push_back(fmt::format("error of hoop stresses about {:.2e}", chosen.hoop_error));
  }
  return fmt::format("accuracy {}: {} space, p = {}{}: {}{}", fmt::join(targets, ", "),
                     pfem::name_of(chosen.scene.space), chosen.scene.p_high,
                     chosen.free_rings ? fmt::format(", rings {}", rings) : std::string(), fmt::join(found, ", "),
                     chosen.is_reached() ? "" : ", not reached");
}

}  // namespace fastjoint::stage1
