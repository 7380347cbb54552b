// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <algorithm>
#include <utility>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

MatrixXd stiffness_of_plates(const JointModel& joint) {
  MatrixXd S = MatrixXd::Zero(joint.n_unknowns(), joint.n_unknowns());
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const Index at = joint.offset(i), n = joint.plates[i].n_unknowns();
    S.block(at, at, n, n) = joint.plates[i].S;
  }
  return S;
}

/// Forces on all unknowns, and prescribed displacements, by a unit of each load column, (N, l) each.
std::pair<MatrixXd, MatrixXd> unit_loads(const JointModel& joint, const std::vector<LoadColumn>& columns) {
  MatrixXd loads = MatrixXd::Zero(joint.n_unknowns(), std::ssize(columns)), given = loads;
  for (Index i = 0; i < std::ssize(columns); ++i) {
    const PlateModel& plate = joint.plates[columns[i].plate];
    const Index first = joint.offset(columns[i].plate), external = plate.n_disc_unknowns() + columns[i].at;
    auto load = loads.col(i).segment(first, plate.n_unknowns());
    if (columns[i].is_traction) {
      load = -plate.T.col(columns[i].at);
    } else if (columns[i].is_displacement) {
      load = -plate.S.col(external);
      given(first + external, i) = 1;
    } else {
      load[external] = 1;
    }
  }
  return {loads, given};
}

/// H = D_delta^T G from the columns of every plate's R that are in use.
MatrixXd friction_matrix(const JointModel& joint, const std::vector<FrictionColumn>& columns, const MatrixXd& D_delta) {
  MatrixXd H(D_delta.cols(), std::ssize(columns));
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const auto D = D_delta.middleRows(joint.offset(i), plate.n_unknowns());
    std::vector<Index> of_H, of_R;
    for (Index at = 0; at < std::ssize(columns); ++at) {
      if (columns[at].plate != i) continue;
      if (columns[at].case_at < 0) {
        H.col(at) = D.row(columns[at].disc).transpose();
      } else {
        of_H.push_back(at);
        of_R.push_back(columns[at].case_at);
      }
    }
    if (!of_H.empty()) H(Eigen::all, of_H) = D.transpose() * MatrixXd(plate.R(Eigen::all, of_R));
  }
  return H;
}

/// Stiffness of the softer plate of each plane at its discs, (n).
VectorXd own_stiffness(const JointModel& joint) {
  VectorXd own(joint.n_planes());
  for (Index j = 0; j < own.size(); ++j) {
    const auto at = [&](const HoleModel& hole) {
      return joint.plates[hole.plate].S.diagonal().segment(hole.disc, joint.n_directions()).maxCoeff();
    };
    const auto holes = joint.holes(joint.planes[j]);
    const auto [softer, stiffer] = std::minmax({at(holes.front()), at(holes.back())});
    own[j] = softer > 0 ? softer : stiffer > 0 ? stiffer : 1.0;
  }
  return own;
}

}  // namespace

VectorXd without_rounding(const VectorXd& q, double largest_load) {
  constexpr double rounding = 1e-12;
  return (q.array().abs() > rounding * largest_load).select(q, 0);
}

void set_reference(CondensedSystem& system, const VectorXd& own) {
  constexpr double floating = 1e-13;  // S_ud over the plate's stiffness if the plate has a single fastener
  constexpr double margin = 1.05, negligible = 1e-9, rounding = 1e-12;
  const Index n = own.size(), a = own.size() == 0 ? 0 : (system.S_ud.rows() - system.n_moments()) / n;
  const std::vector<Index>& rims = system.rim_sizes;
  MatrixXd& S = system.S_ud;
  const VectorXd of_rows = S.topRows(n * a).cwiseAbs().rowwise().sum();
  for (Index i = 0; i < n * a; ++i) {
    if (of_rows[i] > floating * own[i / a]) continue;
    S.row(i).setZero();
    S.col(i).setZero();
  }
  const VectorXd rows = margin * S.cwiseAbs().rowwise().sum();
  const double largest = n > 0 ? rows.head(n * a).maxCoeff() : 0;
  system.stiffness.resize(n + std::ssize(rims));
  system.stiffness.head(n) = own;
  for (Index j = 0; j < n; ++j) {
    if (largest <= rounding * own[j]) continue;
    const double row = rows.segment(j * a, a).maxCoeff();
    system.stiffness[j] = row > negligible * largest ? row : largest;
  }
  MatrixXd W = -0.5 * (S + S.transpose());
  for (Index i = 0; i < n * a; ++i) W(i, i) += system.stiffness[i / a];
  Index first = n * a;
  for (Index rim = 0; rim < std::ssize(rims); ++rim) {
    system.stiffness[n + rim] = rows.segment(first, rims[rim]).maxCoeff();
    W.diagonal().segment(first, rims[rim]).array() += system.stiffness[n + rim];
    first += rims[rim];
  }
  system.metric = matrices::inverse_of_positive(std::move(W)).value();
}

CondensedSystem condense(const JointModel& joint, const Held& held) {
  const MatrixXd S = stiffness_of_plates(joint);
  CondensedSystem system{};
  system.rigid = RigidJoint(joint, held, S);
  const auto& Y = system.rigid.Y();
  const MatrixXd SY = S * Y;
  const MatrixXd half = system.rigid.half_solve(SY);
  system.D_delta = MatrixXd(Y) - system.rigid.restore(half);
  system.S_ud = Y.transpose() * SY;
  system.S_ud.noalias() -= half.transpose() * half;
  system.held = held;
  system.load_columns = load_columns(joint, held);
  const auto [loads, given] = unit_loads(joint, system.load_columns);
  system.Q = system.D_delta.transpose() * loads;
  system.Q_scale.resize(loads.cols());
  for (Index i = 0; i < loads.cols(); ++i) {
    const VectorXd forces = loads.col(i).cwiseAbs();
    system.Q_scale[i] = std::max((system.rigid.Z().transpose() * forces).lpNorm<Eigen::Infinity>(),
                                 (Y.transpose() * forces).lpNorm<Eigen::Infinity>());
  }
  system.D_load = given + system.rigid.moved(loads);
  system.friction = friction_layout(joint);
  system.H = friction_matrix(joint, system.friction.columns, system.D_delta);
  system.rim_sizes = joint.rim_sizes();
  set_reference(system, own_stiffness(joint));
  return system;
}

}  // namespace fastjoint::stage3
