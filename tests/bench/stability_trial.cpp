// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/stability_trial.hpp"

#include <algorithm>
#include <chrono>

#include "stage3_nonlinear/equations/first_guesses.hpp"
#include "tests/stage3_nonlinear/hand_made.hpp"

namespace fastjoint::bench {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using stage3::Root;
using stage3::RootProblem;

/// Forces of all planes under delta, and their slopes as blocks like stage 3's.
stage3::ContactState state_at(const RandomJoint& joint, const VectorXd& delta, double steepest) {
  const auto& contacts = joint.equations.contacts;
  const Index n = contacts.size();
  const Index a = delta.size() / n;
  stage3::ContactState state = contact_state(joint.equations, VectorXd::Zero(delta.size()));  // for its shapes
  state.delta = delta;
  Index first = 0;
  for (std::size_t i = 0; i < state.parts.size(); ++i) {
    stage3::Response& part = state.parts[i];
    const Index rows = part.F.size();
    part.ddelta.setIdentity();
    for (Index j = first / a; j < (first + rows) / a; ++j) {
      const auto& contact = contacts[j];
      const VectorXd here = delta.segment(j * a, a);
      const double length = here.norm();
      const VectorXd e = length > 0 ? VectorXd(here / length) : VectorXd(VectorXd::Unit(a, 0));
      const bool open = contact.one_sided && here[0] < 0;
      const Force on = open ? Force{0, 0} : joint.curves[j].at(length, contact.clearance);
      const double along = std::min(on.slope, steepest),
                   across = length > 0 ? std::min(on.F / length, steepest) : along;
      state.F.segment(j * a, a) = on.F * e;
      auto dF = part.dF.block(j * a - first, j * a - first, a, a);
      dF = (along - across) * e * e.transpose();
      dF.diagonal().array() += across;
    }
    part.F = state.F.segment(first, rows);
    const auto& interface = joint.equations.interfaces[i];
    if (const MatrixXd by_force = interface.interface->friction_by_force(part.F); by_force.size() > 0) {
      part.dLambda = by_force * part.dF;
      state.Lambda.segment(interface.friction, by_force.rows()) = by_force * part.F;  // homogeneous of degree one
    }
    first += rows;
  }
  return state;
}

struct Counts {
  long residuals = 0, jacobians = 0;
};

RootProblem counted(const RootProblem& problem, Counts& counts) {
  RootProblem result = problem;
  result.residual = [&problem, &counts](const VectorXd& x) {
    ++counts.residuals;
    return problem.residual(x);
  };
  result.jacobian = [&problem, &counts](const VectorXd& x) {
    ++counts.jacobians;
    return problem.jacobian(x);
  };
  return result;
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

RootProblem displacement_problem(const RandomJoint& joint, double unit) {
  const double scale = joint.force_scale();
  const double steepest = 1e12 * joint.equations.contacts[0].stiffness;
  return {.residual = [&joint, unit, scale](const VectorXd& x) -> VectorXd {
            const auto state = state_at(joint, unit * x, 0);
            return joint.equations.residual(state, 1) / scale;
          },
          .jacobian = [&joint, unit, scale, steepest](const VectorXd& x) -> MatrixXd {
            return tangent(*joint.equations.system, state_at(joint, unit * x, steepest)) * (unit / scale);
          },
          .metric = {}};
}

std::vector<Trial> try_guesses(const RandomJoint& joint, stage3::SolveFunction solver, Coordinate coordinate,
                               const stage3::RootOptions& options) {
  const auto& equations = joint.equations;
  const double scale = joint.force_scale();
  const bool contact = coordinate == Coordinate::contact;
  const double unit = contact ? scale : scale / equations.contacts[0].stiffness;
  const RootProblem problem = contact ? root_problem(equations, 1, scale) : displacement_problem(joint, unit);
  std::vector<Trial> trials;
  for (const auto& guess : guesses_in_order({})) {
    const VectorXd c = first_guess(equations, guess, 1);
    const VectorXd start = contact ? c : contact_state(equations, c).delta;
    Counts counts;
    const double begin = now();
    const Root root = solver(counted(problem, counts), start / unit, options);
    const double seconds = now() - begin;
    Trial trial{root.converged, root.iterations, counts.residuals, counts.jacobians, seconds, {}};
    if (root.converged) {
      const VectorXd x = unit * root.x;
      trial.F = contact ? contact_state(equations, x).F : state_at(joint, x, 0).F;
    }
    trials.push_back(std::move(trial));
  }
  return trials;
}

Trial try_as_shipped(const RandomJoint& joint, const stage3::RootOptions& options) {
  const stage3::PathOptions path_options{{},
                                         {.tolerance = options.tolerance, .max_iterations = options.max_iterations}};
  const double begin = now();
  const auto path = follow(joint.equations, {1}, path_options);
  const double seconds = now() - begin;
  if (path.failure) return {.seconds = seconds, .F = {}};
  const auto& step = path.steps[0];
  return {.solved = step.residual <= options.tolerance, .iterations = step.iterations, .seconds = seconds, .F = step.F};
}

}  // namespace fastjoint::bench
