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
    const Response& part = state.parts.emplace_back(
        PlacedResponse{interface->respond(c.segment(row, n), history.empty() ? History() : history[i]), row, friction});
    state.F.segment(row, n) = part.F;
    state.delta.segment(row, n) = part.delta;
    state.Lambda.segment(friction, part.Lambda.size()) = part.Lambda;
    if (part.failed >= 0) state.failed = row + part.failed;
  }
  for (Index j = 0; j < n_planes; ++j) state.direction.col(j) = along(c.segment(j * n_directions, n_directions));
  return state;
}

double ContactState::along(MatrixXd Response::*slopes, Index plane) const {
  const Index a = direction.rows();
  const PlacedResponse& part = parts[part_of(plane * a)];
  const Index at = plane * a - part.row;
  return direction.col(plane).dot((part.*slopes).block(at, at, a, a) * direction.col(plane));
}

void ContactState::leave_out_friction() {
  Lambda.resize(0);
  for (PlacedResponse& part : parts) part.dLambda.resize(0, part.F.size());
}

MatrixXd ContactState::times(const MatrixXd& A, MatrixXd Response::*slopes) const {
  MatrixXd result(A.rows(), A.cols());
  for (const PlacedResponse& part : parts) {
    const MatrixXd& block = part.*slopes;
    const auto columns = A.middleCols(part.row, block.cols());
    if (block.isDiagonal(0)) {
      result.middleCols(part.row, block.cols()) = columns * block.diagonal().asDiagonal();
    } else {
      result.middleCols(part.row, block.cols()).noalias() = columns * block;
    }
  }
  return result;
}

MatrixXd ContactState::product(MatrixXd Response::*slopes, const MatrixXd& x) const {
  MatrixXd result(x.rows(), x.cols());
  for (const PlacedResponse& part : parts)
    result.middleRows(part.row, part.F.size()).noalias() = part.*slopes * x.middleRows(part.row, part.F.size());
  return result;
}

MatrixXd ContactState::friction_by(const MatrixXd& dc) const {
  MatrixXd result = MatrixXd::Zero(Lambda.size(), dc.cols());
  for (const PlacedResponse& part : parts)
    if (const Index t = part.dLambda.rows(); t > 0)
      result.middleRows(part.friction, t).noalias() = part.dLambda * dc.middleRows(part.row, part.F.size());
  return result;
}

}  // namespace fastjoint::stage3
