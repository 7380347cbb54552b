// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/contact.hpp"

namespace fastjoint::stage3 {
namespace {

/// Unit vector along v; the first axis where v = 0.
VectorXd along(const VectorXd& v) {
  const double length = v.norm();
  return length > 0 ? VectorXd(v / length) : VectorXd(VectorXd::Unit(v.size(), 0));
}

}  // namespace

VectorXd amounts(const VectorXd& vectors, Index n_directions) {
  if (n_directions == 1) return vectors;
  return vectors.reshaped(n_directions, vectors.size() / n_directions).colwise().norm().transpose();
}

MatrixXd ContactState::times(const MatrixXd& A, const Blocks& blocks) const {
  const Index a = direction.rows();
  if (a == 1 && blocks.rims.empty()) return A * blocks.along.asDiagonal();
  MatrixXd result(A.rows(), A.cols());
  Index first = a * direction.cols();
  for (const auto& rim : blocks.rims) {
    const auto columns = A.middleCols(first, rim.cols());
    if (rim.isDiagonal(0)) {
      result.middleCols(first, rim.cols()) = columns * rim.diagonal().asDiagonal();
    } else {
      result.middleCols(first, rim.cols()).noalias() = columns * rim;
    }
    first += rim.cols();
  }
  for (Index j = 0; j < direction.cols(); ++j) {
    const VectorXd e = direction.col(j);
    const auto columns = A.middleCols(j * a, a);
    result.middleCols(j * a, a) =
        blocks.across[j] * columns + (blocks.along[j] - blocks.across[j]) * (columns * e) * e.transpose();
  }
  return result;
}

void ContactState::add(double factor, const Blocks& blocks, MatrixXd& A) const {
  const Index a = direction.rows();
  for (Index j = 0; j < direction.cols(); ++j) {
    const MatrixXd along = direction.col(j) * direction.col(j).transpose();
    A.block(j * a, j * a, a, a) +=
        factor * (blocks.along[j] * along + blocks.across[j] * (MatrixXd::Identity(a, a) - along));
  }
  Index first = a * direction.cols();
  for (const auto& rim : blocks.rims) {
    A.block(first, first, rim.rows(), rim.cols()) += factor * rim;
    first += rim.cols();
  }
}

ContactState contact_state(const std::vector<Contact>& contacts, const VectorXd& c) {
  const Index n = contacts.size(), a = c.size() / n;
  ContactState state{
      VectorXd(n * a), VectorXd(n * a), MatrixXd(a, n), {VectorXd(n), VectorXd(n)}, {VectorXd(n), VectorXd(n)}, {}};
  for (Index j = 0; j < n; ++j) {
    const Contact& contact = contacts[j];
    const VectorXd here = c.segment(j * a, a);
    const VectorXd e = along(here);
    const double k = contact.stiffness;
    const double length = here.norm();
    const Branch on =
        contact.is_pulled_open(here) ? Branch::open(length, k) : contact.law->at(length, k, contact.clearance);
    if (on.spent) state.spent = j;
    state.direction.col(j) = e;
    state.F.segment(j * a, a) = on.F * e;
    state.delta.segment(j * a, a) = on.delta * e;
    state.dF.along[j] = on.dF;
    state.ddelta.along[j] = on.ddelta;
    // At c = 0 the limits of F / |c| and delta / |c|.
    state.dF.across[j] = length > 0 ? on.F / length : on.dF;
    state.ddelta.across[j] = length > 0 ? on.delta / length : on.ddelta;
  }
  return state;
}

VectorXd contact_coordinates(const std::vector<Contact>& contacts, const VectorXd& F) {
  const Index a = F.size() / contacts.size();
  VectorXd c(F.size());
  for (Index j = 0; j < std::ssize(contacts); ++j) {
    const Contact& contact = contacts[j];
    const Index at = j * a;
    const VectorXd here = F.segment(at, a);
    const double force = here.norm();
    const bool carries = force > 0 && !contact.is_pulled_open(here);
    c.segment(at, a) =
        carries ? VectorXd(along(here) * contact.law->coordinate(force, contact.stiffness, contact.clearance)) : here;
  }
  return c;
}

}  // namespace fastjoint::stage3
