// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/joint_equations.hpp"

#include <Eigen/LU>

namespace fastjoint::stage3 {

using Eigen::Index;
using Eigen::MatrixXd;

JointEquations make_equations(const JointModel& joint) {
  constexpr double negligible = 1e-9;  // a sheet that one fastener holds leaves rounding only
  JointEquations equations{condense(joint), {}};
  const Eigen::VectorXd k = equations.system.S_ud.diagonal();
  double largest = k.maxCoeff();
  if (!(largest > 0)) largest = 1;
  for (Index j = 0; j < k.size(); ++j) {
    const FastenerModel& fastener = joint.fasteners[static_cast<std::size_t>(j)];
    equations.contacts.push_back({.law = fastener.law,
                                  .gap = fastener.gap,
                                  .stiffness = k[j] > negligible * largest ? k[j] : largest,
                                  .one_sided = fastener.one_sided});
  }
  return equations;
}

MatrixXd tangent(const CondensedSystem& system, const ContactState& state) {
  MatrixXd J = system.S_ud * state.ddelta.asDiagonal();
  J.diagonal() += state.dF;
  if (!system.has_friction()) return J;
  for (Index j = 0; j < J.cols(); ++j)
    J.col(j) += state.F[j] < 0 ? -state.dF[j] * system.H_minus.col(j) : state.dF[j] * system.H_plus.col(j);
  return J;
}

std::vector<Index> undetermined(const CondensedSystem& system, const ContactState& state) {
  constexpr double singular = 1e-10;
  std::vector<Index> open;
  for (Index j = 0; j < state.dF.size(); ++j)
    if (state.dF[j] == 0) open.push_back(j);
  if (open.empty()) return {};
  MatrixXd J = tangent(system, state);
  for (Index j = 0; j < J.cols(); ++j) J.col(j) /= std::max(J.col(j).cwiseAbs().maxCoeff(), 1e-300);
  return Eigen::PartialPivLU<MatrixXd>(J).rcond() > singular ? std::vector<Index>{} : open;
}

}  // namespace fastjoint::stage3
