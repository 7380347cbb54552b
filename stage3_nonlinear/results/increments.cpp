// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/increments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/errors.hpp"

namespace fastjoint::stage3 {
std::optional<Imbalance> imbalance(const JointEquations& equations, const PathStep& step, const JointState& state,
                                   double tolerance) {
  const double allowed = std::max(1e-8, 10 * tolerance);
  // Rounding of wide gaps may be far above all that acts: the largest force of the state, or of the path where the load
  // factor is about 0.
  double largest = step.F.lpNorm<Eigen::Infinity>();
  for (const double factor : {0.0, 1.0, step.load_factor})
    largest = std::max(largest, equations.rigid_forces(factor).lpNorm<Eigen::Infinity>());
  for (const auto& plate : state.plates)
    for (const VectorXd* forces : {&plate.Pe, &plate.traction})
      largest = std::max(largest, forces->lpNorm<Eigen::Infinity>());
  const double left = step.residual * step.scale / largest;
  if (largest > 0 && equations.rigid_forces(1).norm() > 0 && left > allowed)
    return Imbalance{"the load", left, allowed};
  const auto [worst, what] =
      std::max({std::pair(state.out_of_balance, "a row"), std::pair(state.fasteners_out_of_balance, "a fastener"),
                std::pair(state.plates_out_of_balance.value_or(0), "a sheet")});
  if (worst <= allowed) return std::nullopt;
  return Imbalance{what, worst, allowed};
}

namespace {

/// Hoop stress at the spots of all holes of each plate, which is taken out of their state.
std::vector<SpotExtremes> spots_of(JointState& state) {
  std::vector<SpotExtremes> spots;
  for (auto& plate : state.plates) {
    MatrixXd hoop = MatrixXd::Constant(TractionWaves::n_points, std::ssize(plate.rims), std::nan(""));
    for (Index i = 0; i < hoop.cols(); ++i)
      if (VectorXd its = std::exchange(plate.rims[i].hoop, {}); its.size() > 0) hoop.col(i) = its;
    spots.emplace_back(hoop);
  }
  return spots;
}

/// Throws InputError where a plane is not on the curve of its law, whose derivatives by the law's numbers are known.
void require_first_loading(const JointModel& joint, const SolvedPoint& point) {
  constexpr double same = 1e-9;
  const JointEquations& equations = point.equations();
  if (!equations.remembers()) return;
  JointEquations first = equations;
  first.history.clear();
  const VectorXd off = contact_state(first, point.c()).F - point.state().F;
  const Index a = equations.n_directions();
  for (Index j = 0; j < equations.n_planes(); ++j)
    if (off.segment(j * a, a).norm() > same * point.state().F.lpNorm<Eigen::Infinity>())
      throw InputError(
          fmt::format("--sensitivities: at load factor {:g} {} has unloaded or turned after it slipped or yielded, and "
                      "derivatives through such a history are not known; allowed: increments before that, or laws with "
                      "\"reversible\": true",
                      point.load_factor(), joint.name(joint.planes[j])));
}

}  // namespace

std::pair<LoadPath, Increments> follow_with_results(const JointModel& joint, const JointEquations& equations,
                                                    const std::vector<double>& load_factors, PathOptions options,
                                                    const Wanted& wanted) {
  Increments all;
  if (wanted.sensitivities) all.numbers = joint_numbers(joint, equations.parameters);
  const ForceErrors errors(joint, equations);
  std::vector<VectorXd> F_error;
  std::optional<SolvedPoint> last;
  StateSlopes slopes;
  options.each = [&](SolvedPoint point, const PathStep& step) -> std::optional<Imbalance> {
    JointState state = joint_state(joint, equations, step);
    if (auto found = imbalance(equations, step, state, wanted.tolerance)) return found;
    if (errors.are_known()) F_error.push_back(errors.at(point, state));
    all.stiffness.push_back(tangent_stiffness(joint, point));
    if (wanted.sensitivities) {
      require_first_loading(joint, point);
      slopes = state_slopes(all.numbers, point);
      all.sensitivity.push_back(sensitivity(slopes, point));
    }
    if (wanted.bending != nullptr) wanted.bending->add(point, step, state);
    append(all.spots, spots_of(state));
    if (!wanted.keep_loaded_rims)
      for (auto& plate : state.plates) std::vector<std::optional<LoadedRim>>().swap(plate.loaded);
    all.states.push_back(std::move(state));
    if (wanted.sensitivities) last.emplace(std::move(point));
    return std::nullopt;
  };
  const bool by_events = load_factors.empty() && equations.n_unknowns() > 0;  // without unknowns nothing happens
  LoadPath path = by_events ? follow_events(equations, options)
                            : follow(equations, load_factors.empty() ? std::vector{1.0} : load_factors, options);
  if (errors.are_known()) {
    all.F_error.emplace(std::ssize(F_error), joint.n_planes());
    for (Index i = 0; i < std::ssize(F_error); ++i) all.F_error->row(i) = F_error[i].transpose();
  }
  if (last) all.peak = peak_sensitivity(joint, all.numbers, slopes, *last, all.states.back());
  return {std::move(path), std::move(all)};
}

std::vector<JointGroup> increment_quantities(const Increments& increments) {
  const auto& stiffness = increments.stiffness;
  const Index loads = stiffness.empty() ? 0 : std::ssize(stiffness[0]);
  std::vector<JointGroup> groups{JointGroup(
      columns::Of::load, loads,
      {{"stiffness/tangent", columns::stiffness,
        "rise of force over that of displacement at each, as all loads grow together", "", h5::infinite_too}},
      [&stiffness, loads](const JointAt& at) {
        return VectorXd::NullaryExpr(loads, [&](Index i) { return stiffness[at.increment][i].stiffness; });
      })};
  if (increments.F_error)
    groups.emplace_back(
        columns::Of::plane, increments.F_error->cols(),
        std::vector<columns::Quantity>{
            {"F_error", columns::force, "estimated error of F by those of the plates' matrices", "", h5::infinite_too}},
        [&errors = *increments.F_error](const JointAt& at) { return errors.row(at.increment).transpose(); });
  return groups;
}

}  // namespace fastjoint::stage3
