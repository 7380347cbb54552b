// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/errors.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// LU of the bordered system [[S, B], [B^T, 0]], scaled row and column so that units and the stiffness of one plate
/// against the next do not matter.
class BorderedSystem {
 public:
  /// @param S   Symmetric, positive semi-definite, shape (N, N), force / length.
  /// @param own Stiffness of each unknown's plate, shape (N), force / length; 0 of a plate without any.
  /// @param B   One column for each shear plane and direction, +1 at the first disc, -1 at the second, shape (N, n a).
  BorderedSystem(const MatrixXd& S, const VectorXd& own, const MatrixXd& B)
      : scale_(S.rows() + B.cols()), N_(S.rows()) {
    const double largest = S.diagonal().maxCoeff();
    for (Index i = 0; i < N_; ++i)
      scale_[i] = 1 / std::sqrt(S(i, i) > singular * own[i] ? S(i, i)
                                : own[i] > 0                ? own[i]
                                : largest > 0               ? largest
                                                            : 1.0);
    for (Index j = 0; j < B.cols(); ++j)
      scale_[N_ + j] = 1 / B.col(j).cwiseAbs().cwiseProduct(scale_.head(N_)).maxCoeff();
    matrix_.resize(scale_.size(), scale_.size());
    matrix_ << S, B, B.transpose(), MatrixXd::Zero(B.cols(), B.cols());
    matrix_ = scale_.asDiagonal() * matrix_ * scale_.asDiagonal();
    lu_.compute(matrix_);
  }

  /// False if some motion meets no stiffness while B^T holds.
  [[nodiscard]] bool is_regular() const { return least_stretch(lu_, matrix_) > singular; }

  /// @param rhs Shape (N + n a, columns): forces (force), then relative displacements (length).
  /// @return    Same shape: displacements (length), then forces (force).
  [[nodiscard]] MatrixXd solve(const MatrixXd& rhs) const {
    return scale_.asDiagonal() * lu_.solve(scale_.asDiagonal() * rhs);
  }

  /// Largest displacement of each unknown in motions that meet no stiffness, each with the largest entry 1, shape (N).
  [[nodiscard]] VectorXd free_motions() const {
    // A little above the limit of is_regular, whose rcond is an estimate in another norm.
    constexpr double small = 1e3 * singular;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(matrix_);
    const VectorXd values = eigen.eigenvalues().cwiseAbs();
    VectorXd largest = VectorXd::Zero(N_);
    for (Index i = 0; i < values.size(); ++i) {
      if (values[i] > small * values.maxCoeff()) continue;
      const VectorXd D = scale_.head(N_).cwiseProduct(eigen.eigenvectors().col(i).head(N_)).cwiseAbs();
      largest = largest.cwiseMax(D / D.maxCoeff());
    }
    return largest;
  }

 private:
  /// Stage 2's rounding leaves a floating plate about 1e-12 of its stiffness; a long chain of fasteners needs 1e-6. A
  /// plate may be as much softer than its neighbours as it likes: its rows are scaled by its own stiffness.
  static constexpr double singular = 1e-10;
  VectorXd scale_;  ///< (N + n a)
  MatrixXd matrix_;
  Eigen::PartialPivLU<MatrixXd> lu_;
  Index N_;
};

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

void add_plate(Rows& rows, const PlateModel& plate, Index offset) {
  const Index m = plate.n_discs();
  const Index n = plate.n_unknowns();
  rows.S.block(offset, offset, n, n) = plate.S;
  rows.load.segment(offset, n) = -plate.T * plate.traction_force;
  rows.load.segment(offset + m, plate.n_externals()) += plate.external_force;
  for (Index i = 0; i < n; ++i) {
    const auto displacement = i < m ? std::nullopt : plate.external_displacement[i - m];
    if (!displacement) rows.free.push_back(offset + i);
    rows.given[offset + i] = displacement.value_or(0);
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
  rows.G_plus.block(offset, at, plus.load.size(), 1) = plus.load;  // no rows where the rim cannot bear
  rows.G_minus.block(offset, at, minus.load.size(), 1) = minus.load;
  // B F is the laws' force on the disc; what the rim bears on instead is in G.
  rows.G_plus(offset + hole.disc + row.direction, at) += 1 - plus.bearing;
  rows.G_minus(offset + hole.disc + row.direction, at) -= 1 - minus.bearing;
}

Rows assemble(const JointModel& joint) {
  const Index N = joint.n_unknowns();
  const Index n = joint.n_planes() * joint.n_directions();
  Rows rows;
  rows.S = MatrixXd::Zero(N, N);
  rows.B = MatrixXd::Zero(N, n);
  rows.load = rows.given = VectorXd::Zero(N);
  for (std::size_t i = 0; i < joint.fasteners.size(); ++i)
    for (std::size_t hole = 0; hole < joint.fasteners[i].holes.size(); ++hole)
      for (Index d = 0; d < std::ssize(joint.fasteners[i].holes[hole].friction); ++d)
        rows.friction.push_back({i, hole, d});
  const Index f = rows.friction.size();
  rows.E = MatrixXd::Zero(f, n);
  rows.G_plus = rows.G_minus = MatrixXd::Zero(N, f);
  for (std::size_t i = 0; i < joint.plates.size(); ++i) add_plate(rows, joint.plates[i], joint.offset(i));
  for (Index j = 0; j < joint.n_planes(); ++j) add_plane(rows, joint, j);
  for (Index i = 0; i < f; ++i) add_friction(rows, joint, i);
  return rows;
}

[[noreturn]] void fail_as_mechanism(const JointModel& joint, const Rows& rows, const BorderedSystem& bordered) {
  constexpr double moves = 1e-3;  // of the largest displacement of the motion
  VectorXd largest = VectorXd::Zero(joint.n_unknowns());
  largest(rows.free) = bordered.free_motions();
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

/// Right-hand sides of the bordered system, block after block: load, delta, b+, b-.
MatrixXd right_hand_sides(const Rows& rows) {
  const Index N = rows.free.size(), n = rows.B.cols();
  MatrixXd forces(rows.S.rows(), 1 + n + 2 * rows.G_plus.cols());
  forces << rows.load - rows.S * rows.given, MatrixXd::Zero(forces.rows(), n), -rows.G_plus, -rows.G_minus;
  MatrixXd rhs = MatrixXd::Zero(N + n, forces.cols());
  for (Index i = 0; i < N; ++i) rhs.row(i) = forces.row(rows.free[i]);
  rhs.block(N, 1, n, n).setIdentity();
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

double least_stretch(const Eigen::PartialPivLU<MatrixXd>& lu, const MatrixXd& A) {
  if ((lu.matrixLU().diagonal().array() == 0).any()) return 0;
  return lu.rcond() * std::min(1.0, A.cwiseAbs().colwise().sum().maxCoeff());
}

CondensedSystem condense(const JointModel& joint) {
  const Rows rows = assemble(joint);
  VectorXd own(joint.n_unknowns());
  for (std::size_t i = 0; i < joint.plates.size(); ++i)
    own.segment(joint.offset(i), joint.plates[i].n_unknowns()).setConstant(joint.plates[i].S.diagonal().maxCoeff());
  const BorderedSystem bordered(rows.S(rows.free, rows.free), own(rows.free), rows.B(rows.free, Eigen::all));
  if (!bordered.is_regular()) fail_as_mechanism(joint, rows, bordered);
  const MatrixXd rhs = right_hand_sides(rows);
  return unpack(rows, rhs, bordered.solve(rhs));
}

}  // namespace fastjoint::stage3
