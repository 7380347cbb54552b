// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/contact.hpp"

namespace fastjoint::stage3 {

VectorXd magnitudes(const VectorXd& vectors, Index n_directions) {
  if (n_directions == 1) return vectors;
  return vectors.reshaped(n_directions, vectors.size() / n_directions).colwise().norm().transpose();
}

ContactState contact_state(const std::vector<PlacedInterface>& interfaces, const std::vector<History>& history,
                           Index n_directions, Index n_planes, const VectorXd& c) {
  ContactState state{VectorXd(c.size()), VectorXd(c.size()), {}, {}, MatrixXd(n_directions, n_planes), {}};
  if (!interfaces.empty()) state.Lambda.resize(interfaces.back().friction + interfaces.back().interface->n_friction());
  state.parts.reserve(interfaces.size());
  for (std::size_t i = 0; i < interfaces.size(); ++i) {
    const auto& [interface, row, friction] = interfaces[i];
    const Index n = interface->size();
    const Response& part =
        state.parts.emplace_back(interface->respond(c.segment(row, n), history.empty() ? History() : history[i]));
    state.F.segment(row, n) = part.F;
    state.delta.segment(row, n) = part.delta;
    state.Lambda.segment(friction, part.Lambda.size()) = part.Lambda;
    if (part.failed >= 0) state.failed = row + part.failed;
  }
  for (Index j = 0; j < n_planes; ++j) {
    const VectorXd here = c.segment(j * n_directions, n_directions);
    const double length = here.norm();
    state.direction.col(j) = length > 0 ? VectorXd(here / length) : VectorXd(VectorXd::Unit(n_directions, 0));
  }
  return state;
}

double ContactState::along(MatrixXd Response::*slopes, Index plane) const {
  const Index a = direction.rows();
  Index first = 0;
  for (const Response& part : parts) {
    const Index at = plane * a - first, n = part.F.size();
    if (at < n) return direction.col(plane).dot((part.*slopes).block(at, at, a, a) * direction.col(plane));
    first += n;
  }
  return 0;
}

MatrixXd ContactState::times(const MatrixXd& A, MatrixXd Response::*slopes) const {
  MatrixXd result(A.rows(), A.cols());
  Index first = 0;
  for (const Response& part : parts) {
    const MatrixXd& block = part.*slopes;
    const auto columns = A.middleCols(first, block.cols());
    if (block.isDiagonal(0)) {
      result.middleCols(first, block.cols()) = columns * block.diagonal().asDiagonal();
    } else {
      result.middleCols(first, block.cols()).noalias() = columns * block;
    }
    first += block.cols();
  }
  return result;
}

MatrixXd ContactState::product(MatrixXd Response::*slopes, const MatrixXd& x) const {
  MatrixXd result(x.rows(), x.cols());
  Index first = 0;
  for (const Response& part : parts) {
    const MatrixXd& block = part.*slopes;
    result.middleRows(first, block.rows()).noalias() = block * x.middleRows(first, block.rows());
    first += block.rows();
  }
  return result;
}

void ContactState::add(double factor, MatrixXd Response::*slopes, MatrixXd& A) const {
  Index first = 0;
  for (const Response& part : parts) {
    const MatrixXd& block = part.*slopes;
    A.block(first, first, block.rows(), block.cols()) += factor * block;
    first += block.cols();
  }
}

MatrixXd ContactState::friction_by(const MatrixXd& dc) const {
  MatrixXd result(Lambda.size(), dc.cols());
  Index row = 0, friction = 0;
  for (const Response& part : parts) {
    const Index t = part.dLambda.rows(), n = part.F.size();
    if (t > 0) result.middleRows(friction, t).noalias() = part.dLambda * dc.middleRows(row, n);
    friction += t;
    row += n;
  }
  return result;
}

}  // namespace fastjoint::stage3
