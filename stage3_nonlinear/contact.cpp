// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/contact.hpp"

#include <cassert>
#include <cmath>

namespace fastjoint::stage3 {

ContactState contact_state(const std::vector<Contact>& contacts, const Eigen::VectorXd& c) {
  const auto n = static_cast<Eigen::Index>(contacts.size());
  assert(c.size() == n);
  ContactState state{Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n), {}};
  for (Eigen::Index j = 0; j < n; ++j) {
    const Contact& contact = contacts[static_cast<std::size_t>(j)];
    const double k = contact.stiffness;
    const double s = std::abs(c[j]) - k * contact.gap;
    const double side = c[j] < 0 ? -1 : 1;
    const bool open = s < 0 || (contact.one_sided && side < 0);
    const Branch branch = open ? Branch{} : contact.law->beyond(s, k);
    if (branch.spent) state.spent = j;
    state.F[j] = side * branch.F;
    state.delta[j] = open ? c[j] / k : side * (contact.gap + branch.stretch);
    state.dF[j] = branch.dF;
    state.ddelta[j] = open ? 1 / k : branch.dstretch;
  }
  return state;
}

Eigen::VectorXd contact_coordinates(const std::vector<Contact>& contacts, const Eigen::VectorXd& F) {
  Eigen::VectorXd c(F.size());
  for (Eigen::Index j = 0; j < F.size(); ++j) {
    const Contact& contact = contacts[static_cast<std::size_t>(j)];
    const double k = contact.stiffness;
    const bool carries = F[j] != 0 && !(contact.one_sided && F[j] < 0);
    c[j] = carries ? std::copysign(k * contact.gap + contact.law->coordinate(std::abs(F[j]), k), F[j]) : F[j];
  }
  return c;
}

}  // namespace fastjoint::stage3
