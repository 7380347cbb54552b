// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace fastjoint::stage3 {
namespace {

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

/// Forces on all unknowns per unit of some amplitudes of friction, (N, columns).
MatrixXd unit_friction(const JointModel& joint, std::span<const FrictionColumn> columns) {
  MatrixXd G = MatrixXd::Zero(joint.n_unknowns(), std::ssize(columns));
  for (Index at = 0; at < std::ssize(columns); ++at) {
    const auto& [plate, case_at, disc] = columns[at];
    const Index first = joint.offset(plate);
    if (case_at < 0) {
      G(first + disc, at) = 1;
    } else {
      G.col(at).segment(first, joint.plates[plate].n_unknowns()) = joint.plates[plate].R.col(case_at);
    }
  }
  return G;
}

/// D_delta^T f, (r, columns), of forces on all unknowns.
MatrixXd on_planes(const CondensedSystem& system, const MatrixXd& f) {
  MatrixXd result = system.rigid.Y().transpose() * f;
  result.noalias() -= system.half.transpose() * system.rigid.half_solve(f);
  return result;
}

/// Number of waves of a rim, from row `first` of S on, up to the last that is coupled to rows outside the rim. The
/// measure is the square of an entry over both diagonal entries, which is dimensionless.
Index n_long(const MatrixXd& S, const VectorXd& diagonal, Index first, Index size) {
  constexpr double max_coupling = 1e-2;
  Index n = size;
  const auto coupling = [&](Index row) {
    const auto outside = [&](Index begin, Index count) {
      return count == 0 ? 0
                        : (S.col(row).segment(begin, count).array().square() / diagonal.segment(begin, count).array())
                              .maxCoeff();
    };
    const Index end = first + size;
    return std::max(outside(0, first), outside(end, S.rows() - end)) / diagonal[row];
  };
  while (n > 0 && coupling(first + n - 1) <= max_coupling) --n;
  return n;
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
  system.K.resize(S.rows());
  for (Index i = 0; i < n * a; ++i) system.K[i] = system.stiffness[i / a];
  Index first = n * a;
  const VectorXd diagonal = S.diagonal().cwiseMax(std::numeric_limits<double>::min());
  for (Index rim = 0; rim < std::ssize(rims); ++rim) {
    system.stiffness[n + rim] = rows.segment(first, rims[rim]).maxCoeff();
    system.K.segment(first, rims[rim]).setConstant(system.stiffness[n + rim]);
    system.long_waves.push_back(n_long(S, diagonal, first, rims[rim]));
    first += rims[rim];
  }
}

MatrixXd CondensedSystem::displaced(const MatrixXd& delta) const {
  return rigid.Y() * delta - rigid.restore(half * delta);
}

MatrixXd CondensedSystem::S_times(const MatrixXd& x) const {
  constexpr Index few = 4;  // up to these, to read half of the matrix for each is quicker
  if (x.cols() > few) return S_ud * x;
  MatrixXd result(x.rows(), x.cols());
  for (Index i = 0; i < x.cols(); ++i) result.col(i) = S_ud.selfadjointView<Eigen::Lower>() * x.col(i);
  return result;
}

VectorXd CondensedSystem::metric_times(const VectorXd& f) const {
  constexpr double tolerance = 1e-13;
  constexpr int max_steps = 200;  // some 70 are enough: each takes a third of the residual or more
  const auto times_W = [&](const VectorXd& x) -> VectorXd { return K.cwiseProduct(x) - S_times(x); };
  VectorXd x = f.cwiseQuotient(K), residual = f - times_W(x), direction = residual.cwiseQuotient(K);
  double size = residual.dot(direction);
  const double enough = tolerance * tolerance * x.dot(f);
  for (int i = 0; i < max_steps && size > enough; ++i) {
    const VectorXd by = times_W(direction);
    const double length = size / direction.dot(by);
    x += length * direction;
    residual -= length * by;
    const VectorXd next = residual.cwiseQuotient(K);
    const double before = std::exchange(size, residual.dot(next));
    direction = next + size / before * direction;
  }
  return x;
}

CondensedSystem condense(const JointModel& joint, const Held& held) {
  CondensedSystem system{};
  system.rigid = RigidJoint(joint, held);
  const auto& Y = system.rigid.Y();
  const Index r = Y.cols();
  system.S_ud.setZero(r, r);
  MatrixXd forces = MatrixXd::Zero(system.rigid.Z().cols(), r);
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    const RigidJoint::SparseMatrix own = Y.middleRows(joint.offset(i), plate.n_unknowns());
    const MatrixXd SY = plate.S * own;
    system.S_ud.noalias() += own.transpose() * SY;
    forces.noalias() += system.rigid.Z().middleRows(joint.offset(i), plate.n_unknowns()).transpose() * SY;
  }
  system.half = system.rigid.half_of(forces);
  system.S_ud.noalias() -= system.half.transpose() * system.half;
  system.held = held;
  system.load_columns = load_columns(joint, held);
  const auto [loads, given] = unit_loads(joint, system.load_columns);
  system.Q = on_planes(system, loads);
  system.Q_scale.resize(loads.cols());
  for (Index i = 0; i < loads.cols(); ++i) {
    const VectorXd its = loads.col(i).cwiseAbs();
    system.Q_scale[i] = std::max((system.rigid.Z().transpose() * its).lpNorm<Eigen::Infinity>(),
                                 (Y.transpose() * its).lpNorm<Eigen::Infinity>());
  }
  system.D_load = given + system.rigid.moved(loads);
  system.friction = friction_layout(joint);
  const std::span columns = system.friction.columns;
  constexpr std::size_t few = 256;  // columns at once, since there may be as many as rows
  system.H.resize(r, std::ssize(columns));
  for (std::size_t i = 0; i < columns.size(); i += few) {
    const auto some = columns.subspan(i, std::min(few, columns.size() - i));
    system.H.middleCols(static_cast<Index>(i), std::ssize(some)) = on_planes(system, unit_friction(joint, some));
  }
  system.rim_sizes = joint.rim_sizes();
  set_reference(system, own_stiffness(joint));
  return system;
}

}  // namespace fastjoint::stage3
