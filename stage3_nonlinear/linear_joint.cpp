// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/linear_joint.hpp"

#include <Eigen/LU>

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// H as one matrix, for forces of given signs: H+ F+ = H+ F where F > 0, H- F- = -H- F where F < 0.
MatrixXd friction_matrix(const CondensedSystem& system, const VectorXd& signs) {
  MatrixXd H = system.H_plus;
  for (Index j = 0; j < signs.size(); ++j)
    if (signs[j] < 0) H.col(j) = -system.H_minus.col(j);
  return H;
}

}  // namespace

LinearForces linear_forces(const CondensedSystem& system, const VectorXd& flexibility, double load_factor) {
  constexpr int most_tries = 8;
  MatrixXd A = system.S_ud * flexibility.asDiagonal();
  A.diagonal().array() += 1;
  const VectorXd rhs = load_factor * system.q;
  LinearForces result{A.partialPivLu().solve(rhs), 1, !system.has_friction()};
  while (!result.consistent && result.solves < most_tries) {
    const VectorXd signs = result.F;
    result.F = (A + friction_matrix(system, signs)).partialPivLu().solve(rhs);
    result.consistent = (result.F.array() * signs.array() >= 0).all();
    ++result.solves;
  }
  return result;
}

std::optional<VectorXd> linear_flexibility(const std::vector<Contact>& contacts) {
  VectorXd flexibility(static_cast<Index>(contacts.size()));
  for (Index j = 0; j < flexibility.size(); ++j) {
    const Contact& contact = contacts[static_cast<std::size_t>(j)];
    const auto stiffness = contact.law->stiffness();
    if (!stiffness || contact.gap > 0 || contact.one_sided) return std::nullopt;
    flexibility[j] = 1 / *stiffness;
  }
  return flexibility;
}

}  // namespace fastjoint::stage3
