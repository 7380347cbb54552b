// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/results/force_errors.hpp"

#include <algorithm>
#include <cmath>

#include "common/infinite.hpp"
#include "common/matrices/stiffness_error.hpp"

namespace fastjoint::stage3 {
namespace {

bool is_known(const PlateModel& plate) { return plate.degrees.p.size() > 1 || plate.S_error.allFinite(); }

std::vector<MatrixXd> stiffness_changes(const JointModel& joint, const CondensedSystem& system) {
  std::vector<MatrixXd> changes;
  Index moment = joint.n_planes() * joint.n_directions();
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const auto& S = plate.degrees.S;
    const Index m = plate.first_moment(), k = plate.n_unknowns() - m;
    MatrixXd& change = changes.emplace_back();
    if (S.size() < 2) continue;
    const MatrixXd dS = S[S.size() - 2] - S.back();
    const auto D = system.D_delta.middleRows(joint.offset(i), m);  // moments are unknowns themselves
    change = D.transpose() * (dS.topLeftCorner(m, m) * D);
    if (k > 0) {
      const MatrixXd mixed = D.transpose() * dS.topRightCorner(m, k);
      change.middleCols(moment, k) += mixed;
      change.middleRows(moment, k) += mixed.transpose();
      change.block(moment, moment, k, k) += dS.bottomRightCorner(k, k);
    }
    moment += k;
    change.diagonal() /= 2;
  }
  return changes;
}

/// Errors of all forces by one plate, (n).
/// @param A  (n, r) change of each force per unit of the residual of each row; w = A D^T.
/// @param D  (m + e + k, r) rows of D_delta. @param dS The plate's stiffness_changes.
VectorXd plate_errors(const PlateModel& plate, const MatrixXd& A, const Eigen::Ref<const MatrixXd>& D,
                      const MatrixXd& dS, const PlateState& state) {
  VectorXd u(plate.n_unknowns());
  u << state.D, state.De, state.moments;
  const VectorXd& f = state.traction;
  const PlateDegrees& degrees = plate.degrees;
  const auto n = degrees.S.size();
  if (n < 2) return (A * D.transpose()).cwiseAbs() * (plate.S_error * u.cwiseAbs());
  constexpr double of_bound = 0.25;                  // min error over the bound by energies
  const auto load = [&](Index before) -> VectorXd {  // at a degree before the last
    const auto R = degrees.R.rbegin() + before;
    return degrees.S[n - 1 - before] * u + degrees.T[n - 1 - before] * f + *R * state.Lambda;
  };
  VectorXd energy(degrees.p.size());  // u . S u + 2 u . T f - f . C f at every degree
  for (Index i = 0; i < std::ssize(energy); ++i)
    energy[i] = u.dot(degrees.S[i] * u) + 2 * u.dot(degrees.T[i] * f) - f.dot(degrees.C[i] * f);
  const double fall = std::abs(energy[energy.size() - 2] - energy[energy.size() - 1]);
  const double more = fall > 0 ? matrices::extrapolated_error(energy, degrees.p) / fall : 1;
  const VectorXd change = A * (D.transpose() * (load(1) - load(0)));
  const MatrixXd A_dS = A * dS.triangularView<Eigen::Lower>();
  const VectorXd fall_by_w = 2 * (A_dS.cwiseProduct(A) * VectorXd::Ones(A.cols())).cwiseAbs();
  return more * (change.cwiseAbs2() + of_bound * of_bound * fall * fall_by_w).cwiseSqrt();
}

}  // namespace

ForceErrors::ForceErrors(const JointModel& joint, const JointEquations& equations)
    : joint_(joint), equations_(equations), are_known_(std::ranges::all_of(joint.plates, is_known)) {
  if (are_known_) stiffness_changes_ = stiffness_changes(joint, *equations.system);
}

VectorXd ForceErrors::at(const SolvedPoint& point, const JointState& state) const {
  Slopes slopes = point.slopes();
  slopes.no_column.clear();  // errors of S have no resultant on a floating plate, so that these columns do not count
  const MatrixXd A = point.of_magnitudes(slopes);
  VectorXd result = VectorXd::Zero(A.rows());
  for (Index i = 0; i < std::ssize(joint_.plates); ++i) {
    const PlateModel& plate = joint_.plates[i];
    const auto D = equations_.system->D_delta.middleRows(joint_.offset(i), plate.n_unknowns());
    result += plate_errors(plate, A, D, stiffness_changes_[i], state.plates[i]);
  }
  if (point.check().at_limit_load()) result.setConstant(infinite);
  for (const Index row : slopes.no_row)
    if (row < equations_.n_plane_rows()) result[row / joint_.n_directions()] = infinite;
  return result;
}

}  // namespace fastjoint::stage3
