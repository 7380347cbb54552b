// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "common/errors.hpp"
#include "stage3_nonlinear/equations/saddle.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The joint's rows S u + G+ b+ + G- b- + B F = load, before anything is eliminated.
struct Rows {
  MatrixXd S;                         ///< (N, N)
  MatrixXd B;                         ///< (N, n a)
  std::vector<FrictionRow> friction;  ///< (f)
  MatrixXd E;                         ///< (f, n a)
  MatrixXd G_plus, G_minus;           ///< (N, f)
  VectorXd load;                      ///< (N) at load factor 1
  VectorXd given;                     ///< (N) given displacements at load factor 1, else 0
  std::vector<Index> free;            ///< unknowns that are not given
};

std::vector<FrictionRow> friction_rows(const JointModel& joint) {
  std::vector<FrictionRow> rows;
  for (std::size_t fastener = 0; fastener < joint.fasteners.size(); ++fastener)
    for (std::size_t hole = 0; hole < joint.fasteners[fastener].holes.size(); ++hole)
      for (Index d = 0; d < std::ssize(joint.fasteners[fastener].holes[hole].friction); ++d)
        rows.push_back({fastener, hole, d});
  return rows;
}

void add_plate(Rows& rows, const PlateModel& plate, Index offset) {
  const Index m = plate.n_discs();
  const Index n = plate.n_unknowns();
  rows.S.block(offset, offset, n, n) = plate.S;
  rows.load.segment(offset, n) = -plate.T * plate.traction_force;
  rows.load.segment(offset + m, plate.n_externals()) += plate.external_force;
  for (Index i = 0; i < n; ++i) {
    const auto& displacement = i < m ? std::optional<double>() : plate.external_displacement[i - m];
    if (displacement) {
      rows.given[offset + i] = *displacement;
    } else {
      rows.free.push_back(offset + i);
    }
  }
}

void add_plane(Rows& rows, const JointModel& joint, Index at) {
  const ShearPlane& plane = joint.planes[at];
  const HoleModel& first = joint.first_hole(plane);
  const HoleModel& second = joint.second_hole(plane);
  for (Index d = 0; d < joint.n_directions(); ++d) {
    const Index column = at * joint.n_directions() + d;
    rows.B(joint.offset(first.plate) + first.disc + d, column) = 1;
    rows.B(joint.offset(second.plate) + second.disc + d, column) = -1;
  }
  for (std::size_t i = 0; i < rows.friction.size(); ++i) {
    const FrictionRow& row = rows.friction[i];
    if (row.fastener != plane.fastener) continue;
    const Index column = at * joint.n_directions() + row.direction;
    if (row.hole == plane.first) rows.E(i, column) = -1;
    if (row.hole == plane.first + 1) rows.E(i, column) = 1;
  }
}

void add_friction(Rows& rows, const JointModel& joint, Index at) {
  const FrictionRow& row = rows.friction[at];
  const HoleModel& hole = joint.fasteners[row.fastener].holes[row.hole];
  const auto& [plus, minus] = hole.friction[row.direction];
  const Index offset = joint.offset(hole.plate);
  if (plus.load.size() > 0) rows.G_plus.block(offset, at, plus.load.size(), 1) = plus.load;
  if (minus.load.size() > 0) rows.G_minus.block(offset, at, minus.load.size(), 1) = minus.load;
  // B F is the laws' force on the disc; what the rim bears on instead is in G.
  rows.G_plus(offset + hole.disc + row.direction, at) += 1 - plus.bearing;
  rows.G_minus(offset + hole.disc + row.direction, at) -= 1 - minus.bearing;
}

Rows assemble(const JointModel& joint) {
  const Index N = joint.n_unknowns();
  const Index n = joint.n_planes() * joint.n_directions();
  auto friction = friction_rows(joint);
  const Index f = friction.size();
  Rows rows{.S = MatrixXd::Zero(N, N),
            .B = MatrixXd::Zero(N, n),
            .friction = std::move(friction),
            .E = MatrixXd::Zero(f, n),
            .G_plus = MatrixXd::Zero(N, f),
            .G_minus = MatrixXd::Zero(N, f),
            .load = VectorXd::Zero(N),
            .given = VectorXd::Zero(N),
            .free = {}};
  for (std::size_t i = 0; i < joint.plates.size(); ++i) add_plate(rows, joint.plates[i], joint.offset(i));
  for (Index j = 0; j < joint.n_planes(); ++j) add_plane(rows, joint, j);
  for (Index i = 0; i < f; ++i) add_friction(rows, joint, i);
  return rows;
}

[[noreturn]] void fail_as_mechanism(const JointModel& joint, const Rows& rows, const Saddle& saddle) {
  constexpr double moves = 1e-3;  // of the largest displacement of the motion
  VectorXd largest = VectorXd::Zero(joint.n_unknowns());
  const MatrixXd motions = saddle.free_motions();
  if (motions.cols() > 0) largest(rows.free) = motions.cwiseAbs().rowwise().maxCoeff();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    if (largest.segment(joint.offset(i), joint.plates[i].n_unknowns()).maxCoeff() > moves)
      names.push_back(fmt::format("\"{}\"", joint.plates[i].name));
  throw NumericalError(
      fmt::format("{}: the joint is a mechanism: plate {} can move freely even with rigid fasteners, nothing "
                  "holds the joint there; give a plate a support (stage 1), or hold an external with "
                  "\"displacement\": 0",
                  joint.file, fmt::join(names, " with plate ")));
}

/// Right-hand sides of the saddle-point system, block after block: load, delta, b+, b-.
MatrixXd right_hand_sides(const Rows& rows) {
  const Index N = rows.free.size();
  const Index n = rows.B.cols();
  const Index n_friction = rows.G_plus.cols();
  MatrixXd rhs = MatrixXd::Zero(N + n, 1 + n + 2 * n_friction);
  const VectorXd load = rows.load - rows.S * rows.given;
  rhs.topLeftCorner(N, 1) = load(rows.free);
  rhs.block(N, 1, n, n).setIdentity();
  rhs.block(0, 1 + n, N, n_friction) = -rows.G_plus(rows.free, Eigen::all);
  rhs.block(0, 1 + n + n_friction, N, n_friction) = -rows.G_minus(rows.free, Eigen::all);
  return rhs;
}

CondensedSystem unpack(const Rows& rows, const MatrixXd& rhs, const MatrixXd& solution) {
  const Index n = rows.B.cols();
  const Index n_friction = rows.G_plus.cols();
  const MatrixXd F = solution.bottomRows(n);
  MatrixXd D = MatrixXd::Zero(rows.S.rows(), solution.cols());
  D(rows.free, Eigen::all) = solution.topRows(rows.free.size());
  D.col(0) += rows.given;
  return {.q = without_rounding(F.col(0), rhs.col(0).cwiseAbs().maxCoeff()),
          .S_ud = -F.middleCols(1, n),
          .friction = rows.friction,
          .E = rows.E,
          .H_plus = -F.middleCols(1 + n, n_friction),
          .H_minus = -F.rightCols(n_friction),
          .D_load = D.col(0),
          .D_delta = D.middleCols(1, n),
          .D_plus = D.middleCols(1 + n, n_friction),
          .D_minus = D.rightCols(n_friction)};
}

}  // namespace

VectorXd CondensedSystem::residual(const VectorXd& F, const VectorXd& delta, double load_factor) const {
  VectorXd r = F + S_ud * delta - load_factor * q;
  if (has_friction()) r += friction_forces(F);
  return r;
}

VectorXd CondensedSystem::friction_forces(const VectorXd& F) const {
  const VectorXd b = E * F;
  return H_plus * b.cwiseMax(0) + H_minus * (-b).cwiseMax(0);
}

MatrixXd CondensedSystem::friction_matrix(const VectorXd& F) const {
  const VectorXd b = E * F;
  MatrixXd H = H_plus;
  for (Index i = 0; i < b.size(); ++i)
    if (b[i] < 0) H.col(i) = -H_minus.col(i);
  return H * E;
}

VectorXd CondensedSystem::displacements(const VectorXd& F, const VectorXd& delta, double load_factor) const {
  VectorXd D = load_factor * D_load + D_delta * delta;
  if (!has_friction()) return D;
  const VectorXd b = E * F;
  return D + D_plus * b.cwiseMax(0) + D_minus * (-b).cwiseMax(0);
}

VectorXd without_rounding(const VectorXd& q, double largest_load) {
  constexpr double rounding = 1e-12;
  return (q.array().abs() > rounding * largest_load).select(q, 0);
}

CondensedSystem condense(const JointModel& joint) {
  const Rows rows = assemble(joint);
  VectorXd own(joint.n_unknowns());
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    own.segment(joint.offset(i), joint.plates[i].n_unknowns()).setConstant(joint.plates[i].S.diagonal().maxCoeff());
  const Saddle saddle(rows.S(rows.free, rows.free), own(rows.free), rows.B(rows.free, Eigen::all));
  if (!saddle.is_regular()) fail_as_mechanism(joint, rows, saddle);
  const MatrixXd rhs = right_hand_sides(rows);
  return unpack(rows, rhs, saddle.solve(rhs));
}

}  // namespace fastjoint::stage3
