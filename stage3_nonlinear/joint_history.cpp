// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/joint_history.hpp"

#include <fmt/format.h>

#include "stage3_nonlinear/rim_history.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;

formats::PlateHistory plate_history(const PlateModel& plate, const std::vector<JointState>& states, std::size_t at) {
  const auto steps = static_cast<Index>(states.size());
  formats::PlateHistory history;
  history.name = plate.name;
  history.disc_hole = plate.holes;
  history.disc_direction.assign(plate.holes.size(), "x");
  history.external_id = plate.externals;
  history.traction_id = plate.tractions;
  history.friction_hole = plate.friction_hole;
  history.friction_bearing = plate.friction_bearing;
  history.D.resize(steps, plate.n_discs());
  history.De.resize(steps, plate.n_externals());
  history.Pe.resize(steps, plate.n_externals());
  history.Lambda.resize(steps, plate.friction_unit_force.size());
  history.traction.resize(steps, plate.traction_force.size());
  for (Index step = 0; step < steps; ++step) {
    const PlateState& state = states[static_cast<std::size_t>(step)].plates[at];
    history.D.row(step) = state.D.transpose();
    history.De.row(step) = state.De.transpose();
    history.Pe.row(step) = state.Pe.transpose();
    history.Lambda.row(step) = state.Lambda.transpose();
    history.traction.row(step) = state.traction.transpose();
  }
  history.rims = rim_history(plate, states, at);
  return history;
}

/// A field with a comma, a quote or a line break stands in quotes.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

formats::JointResult joint_result(const JointModel& joint, const LoadPath& path,
                                  const std::vector<JointState>& states) {
  const auto steps = static_cast<Index>(path.steps.size());
  const Index n = joint.n_fasteners();
  formats::JointResult result;
  result.p = joint.p;
  result.complete = !path.failure;
  result.load_factor.resize(steps);
  result.converged = Eigen::VectorXi::Ones(steps);
  result.iterations.resize(steps);
  result.residual.resize(steps);
  for (auto* table : {&result.delta, &result.F, &result.transferred_first, &result.transferred_second})
    table->resize(steps, n);
  for (Index i = 0; i < steps; ++i) {
    const PathStep& step = path.steps[static_cast<std::size_t>(i)];
    const JointState& state = states[static_cast<std::size_t>(i)];
    result.load_factor[i] = step.load_factor;
    result.iterations[i] = step.iterations;
    result.residual[i] = step.residual;
    result.delta.row(i) = step.delta.transpose();
    result.F.row(i) = step.F.transpose();
    result.transferred_first.row(i) = state.transferred_first.transpose();
    result.transferred_second.row(i) = state.transferred_second.transpose();
  }
  for (const auto& fastener : joint.fasteners) result.fastener_id.push_back(fastener.id);
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    result.plates.push_back(plate_history(joint.plates[i], states, i));
  return result;
}

std::string csv(const JointModel& joint, const formats::JointResult& a) {
  std::string text =
      "increment,load_factor,fastener,delta,F,transferred_first,transferred_second,share,iterations,residual";
  for (const char* end : {"first", "second"}) text += rim_csv_names(end);
  text += "\n";
  for (Index i = 0; i < a.F.rows(); ++i) {
    const Eigen::VectorXd share = shares(a.transferred_first.row(i).transpose());
    for (Index j = 0; j < a.F.cols(); ++j) {
      text +=
          fmt::format("{},{},{},{},{},{},{},{},{},{}", i + 1, a.load_factor[i],
                      field(a.fastener_id[static_cast<std::size_t>(j)]), a.delta(i, j), a.F(i, j),
                      a.transferred_first(i, j), a.transferred_second(i, j), share[j], a.iterations[i], a.residual[i]);
      const auto& fastener = joint.fasteners[static_cast<std::size_t>(j)];
      for (const End end : {first_plate, second_plate}) {
        const FastenerEnd& at = fastener.ends[end];
        const auto& hole = joint.plates[at.plate].holes[static_cast<std::size_t>(at.disc)];
        text += rim_csv_fields(a.plates[at.plate].rims, hole, i);
      }
      text += "\n";
    }
  }
  return text;
}

}  // namespace fastjoint::stage3
