// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/condensed_system.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// Stiffness of a joint whose shear planes do not move, scaled so that units and the stiffness of one unknown against
/// the next do not matter, as its Cholesky factor.
class RigidJoint {
 public:
  /// @param S_z Symmetric, positive semi-definite, shape (r, r), force / length.
  /// @param own Stiffness of the stiffest plate at each unknown, shape (r), force / length; 0 of plates without any.
  RigidJoint(const MatrixXd& S_z, const VectorXd& own) : scale_(own) {
    for (Index i = 0; i < std::ssize(own); ++i) {
      const double at = std::max(S_z(i, i), singular * own[i]);
      scale_[i] = 1 / std::sqrt(at > 0 ? at : 1.0);
    }
    S_z_ = scale_.asDiagonal() * S_z * scale_.asDiagonal();
    factor_.compute(S_z_);
  }

  /// False if some motion meets no stiffness.
  [[nodiscard]] bool is_held() const { return factor_.info() == Eigen::Success && factor_.rcond() > singular; }

  /// L^-1 f of forces f, shape (r, columns), where S_z = L L^T.
  [[nodiscard]] MatrixXd half_solve(const MatrixXd& f) const {
    return factor_.matrixL().solve(scale_.asDiagonal() * f);
  }
  /// L^-T of that: the displacements under the forces.
  [[nodiscard]] MatrixXd restore(const MatrixXd& half) const {
    return scale_.asDiagonal() * factor_.matrixU().solve(half);
  }

  /// Motions that meet no stiffness, shape (r, their number).
  [[nodiscard]] MatrixXd free_motions() const {
    // A little above the limit of is_held, whose rcond is an estimate in another norm.
    constexpr double small = 1e3 * singular;
    const auto eigen = matrices::symmetric_eigen(S_z_);
    const auto n = (eigen.values.array() <= small * eigen.values.maxCoeff()).count();
    return scale_.asDiagonal() * eigen.vectors.leftCols(n);
  }

 private:
  /// Stage 2's rounding leaves a floating plate about 1e-12 of its stiffness; a long chain of fasteners needs 1e-6, a
  /// floating plate the stiffness of what holds it over its own.
  static constexpr double singular = 1e-10;
  VectorXd scale_;  ///< (r)
  MatrixXd S_z_;
  Eigen::LLT<MatrixXd> factor_;
};

/// The joint's rows S u + G+ b+ + G- b- + B F = load, and their displacements u = Z z + Y delta + given: those of the
/// stiffest plate's disc of each fastener are in z, the others lie behind it by the delta of the planes between. All
/// discs of a fastener that the ground holds lie behind the ground. The moments of rims are entries of delta
/// themselves.
struct Rows {
  MatrixXd S;                         ///< (N, N)
  SparseMatrix Y;                     ///< (N, n a), of -1, 0 and 1; B^T Y = I
  SparseMatrix Z;                     ///< (N, r), of 0 and 1; B^T Z = 0
  std::vector<FrictionRow> friction;  ///< (f)
  MatrixXd E;                         ///< (f, n a)
  MatrixXd G_plus, G_minus;           ///< (N, f)
  MatrixXd G_shear;                   ///< (N, s)
  VectorXd load, load_reversed;       ///< (N) per unit load factor, positive or negative
  VectorXd given;                     ///< (N) given displacements at load factor 1, else 0
  VectorXd own;                       ///< (N) stiffness of each unknown's plate, force / length
};

void add_plate(Rows& rows, const PlateModel& plate, Index offset) {
  const Index m = plate.n_discs(), n = plate.n_unknowns();
  rows.S.block(offset, offset, n, n) = plate.S;
  rows.own.segment(offset, n).setConstant(plate.S.diagonal().maxCoeff());
  for (const auto& [load, factor] : {std::pair(&rows.load, 1), std::pair(&rows.load_reversed, -1)}) {
    load->segment(offset, n) = -plate.T * plate.traction_rate(factor);
    load->segment(offset + m, plate.n_externals()) += plate.external_force;
  }
  for (Index i = 0; i < plate.n_externals(); ++i)
    rows.given[offset + m + i] = plate.external_displacement[i].value_or(0);
}

/// First unknown of a disc in the joint's list.
Index disc(const JointModel& joint, const HoleModel& hole) { return joint.offset(hole.plate) + hole.disc; }

/// Hole of a fastener that the others lie behind: that in the stiffest plate, or the ground, which is behind the last.
Index reference(const JointModel& joint, const Rows& rows, const FastenerModel& fastener) {
  if (fastener.grounded) return std::ssize(fastener.holes);
  const auto own = [&](const HoleModel& hole) { return rows.own[disc(joint, hole)]; };
  return std::ranges::max_element(fastener.holes, {}, own) - fastener.holes.begin();
}

void add_planes(Rows& rows, const JointModel& joint) {
  std::vector<Eigen::Triplet<double>> Y;
  for (Index at = 0; at < joint.n_planes(); ++at) {
    const ShearPlane& plane = joint.planes[at];
    const auto& holes = joint.fasteners[plane.fastener].holes;
    const bool beyond = reference(joint, rows, joint.fasteners[plane.fastener]) > plane.first;
    for (Index d = 0; d < joint.n_directions(); ++d) {
      const Index column = at * joint.n_directions() + d;
      for (Index hole = 0; hole < std::ssize(holes); ++hole)
        if ((hole <= plane.first) == beyond) Y.emplace_back(disc(joint, holes[hole]) + d, column, beyond ? 1 : -1);
    }
    for (Index i = 0; i < std::ssize(rows.friction); ++i) {
      const FrictionRow& row = rows.friction[i];
      if (row.fastener != plane.fastener) continue;
      const Index column = at * joint.n_directions() + row.direction;
      if (row.hole == plane.first) rows.E(i, column) = -1;
      if (row.hole == plane.first + 1) rows.E(i, column) = 1;
    }
  }
  Index column = joint.n_planes() * joint.n_directions();
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index unknown = joint.plates[i].first_moment(); unknown < joint.plates[i].n_unknowns(); ++unknown)
      Y.emplace_back(joint.offset(i) + unknown, column++, 1);
  rows.Y.resize(rows.S.rows(), column);
  rows.Y.setFromTriplets(Y.begin(), Y.end());
}

/// Gives each free unknown that follows no other its column of Z, and those of a fastener that of its stiffest plate;
/// the ground has none.
void add_free_unknowns(Rows& rows, const JointModel& joint) {
  const Index N = rows.S.rows();
  std::vector<Index> leader(N);
  std::iota(leader.begin(), leader.end(), Index{0});
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index e = 0; e < plate.n_externals(); ++e)
      if (plate.external_displacement[e]) leader[joint.offset(i) + plate.n_discs() + e] = -1;
    for (Index unknown = plate.first_moment(); unknown < plate.n_unknowns(); ++unknown)
      leader[joint.offset(i) + unknown] = -1;
  }
  for (const auto& fastener : joint.fasteners) {
    const Index at = reference(joint, rows, fastener);
    for (const auto& hole : fastener.holes)
      for (Index d = 0; d < joint.n_directions(); ++d)
        leader[disc(joint, hole) + d] = fastener.grounded ? -1 : disc(joint, fastener.holes[at]) + d;
  }
  std::vector<Index> column(N, -1);
  Index r = 0;
  for (Index i = 0; i < N; ++i)
    if (leader[i] == i) column[i] = r++;
  std::vector<Eigen::Triplet<double>> Z;
  for (Index i = 0; i < N; ++i)
    if (leader[i] >= 0) Z.emplace_back(i, column[leader[i]], 1);
  rows.Z.resize(N, r);
  rows.Z.setFromTriplets(Z.begin(), Z.end());
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

/// Unit forces of the shears of all rims of contact with friction.
void add_shears(Rows& rows, const JointModel& joint) {
  rows.G_shear.resize(rows.S.rows(), 0);
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (const auto& rim : plate.contact) {
      if (joint.mu(i, rim.hole) == 0) continue;
      const Index n = rim.pressures.n_shears();
      rows.G_shear.conservativeResize(Eigen::NoChange, rows.G_shear.cols() + n);
      rows.G_shear.rightCols(n).setZero();
      rows.G_shear.block(joint.offset(i), rows.G_shear.cols() - n, plate.n_unknowns(), n) =
          plate.R.middleCols(plate.first_shear(rim), n) / rim.area;
    }
  }
}

Rows assemble(const JointModel& joint) {
  const Index N = joint.n_unknowns();
  const Index n = joint.n_planes() * joint.n_directions() + joint.n_moments();
  Rows rows;
  rows.S = MatrixXd::Zero(N, N);
  rows.load = rows.load_reversed = rows.given = rows.own = VectorXd::Zero(N);
  for (Index i = 0; i < std::ssize(joint.fasteners); ++i)
    for (Index hole = 0; hole < std::ssize(joint.fasteners[i].holes); ++hole)
      for (Index d = 0; d < std::ssize(joint.fasteners[i].holes[hole].friction); ++d)
        rows.friction.push_back({i, hole, d});
  const Index f = rows.friction.size();
  rows.E = MatrixXd::Zero(f, n);
  rows.G_plus = rows.G_minus = MatrixXd::Zero(N, f);
  for (Index i = 0; i < std::ssize(joint.plates); ++i) add_plate(rows, joint.plates[i], joint.offset(i));
  add_planes(rows, joint);
  add_free_unknowns(rows, joint);
  for (Index i = 0; i < f; ++i) add_friction(rows, joint, i);
  add_shears(rows, joint);
  return rows;
}

/// Stiffness of the stiffest plate at each free unknown, (columns of Z).
VectorXd own_stiffness(const Rows& rows) {
  VectorXd own = VectorXd::Zero(rows.Z.cols());
  for (Index j = 0; j < rows.Z.outerSize(); ++j)
    for (SparseMatrix::InnerIterator at(rows.Z, j); at; ++at) own[j] = std::max(own[j], rows.own[at.row()]);
  return own;
}

[[noreturn]] void fail_as_mechanism(const JointModel& joint, const MatrixXd& motions) {
  constexpr double moves = 1e-3;  // of the largest displacement of the motion
  std::vector<std::string> names;
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const auto of_plate = motions.middleRows(joint.offset(i), joint.plates[i].n_unknowns()).cwiseAbs();
    if ((of_plate.colwise().maxCoeff().array() > moves * motions.cwiseAbs().colwise().maxCoeff().array()).any())
      names.push_back(fmt::format("\"{}\"", joint.plates[i].name));
  }
  throw NumericalError(
      fmt::format("{}: the joint is a mechanism: plate {} can move freely even with rigid fasteners, nothing "
                  "holds the joint there; give a plate a support (stage 1), hold an external with "
                  "\"displacement\": 0, or a fastener by the \"ground\"",
                  joint.file, fmt::join(names, " with plate ")));
}

}  // namespace

VectorXd CondensedSystem::residual(const VectorXd& F, const VectorXd& delta, double load_factor,
                                   const VectorXd& shear) const {
  return F + S_ud * delta - load_factor * q_at(load_factor) + friction_forces(F, shear);
}

// OpenBLAS complains on stderr about matrices without rows or columns, which the conditions keep from it.

VectorXd CondensedSystem::friction_forces(const VectorXd& F, const VectorXd& shear) const {
  VectorXd forces = VectorXd::Zero(F.size());
  if (shear.size() > 0) forces += H_shear * shear;
  if (friction.empty()) return forces;
  const VectorXd b = E * F;
  return forces + H_plus * b.cwiseMax(0) + H_minus * (-b).cwiseMax(0);
}

MatrixXd CondensedSystem::friction_matrix(const VectorXd& F) const {
  if (friction.empty()) return MatrixXd::Zero(F.size(), F.size());
  const VectorXd b = E * F;
  MatrixXd H = H_plus;
  for (Index i = 0; i < std::ssize(b); ++i)
    if (b[i] < 0) H.col(i) = -H_minus.col(i);
  return H * E;
}

VectorXd CondensedSystem::displacements(const VectorXd& F, const VectorXd& delta, double load_factor,
                                        const VectorXd& shear) const {
  VectorXd D = load_factor * D_load_at(load_factor) + D_delta * delta;
  if (shear.size() > 0) D += D_shear * shear;
  if (friction.empty()) return D;
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

MatrixXd displacements_under(const JointModel& joint, const MatrixXd& loads) {
  const Rows rows = assemble(joint);
  const RigidJoint rigid(rows.Z.transpose() * MatrixXd(rows.S * rows.Z), own_stiffness(rows));
  return rows.Z * rigid.restore(rigid.half_solve(rows.Z.transpose() * loads));
}

CondensedSystem condense(const JointModel& joint) {
  const Rows rows = assemble(joint);
  const MatrixXd SZ = rows.S * rows.Z, SY = rows.S * rows.Y;
  const RigidJoint rigid(rows.Z.transpose() * SZ, own_stiffness(rows));
  if (!rigid.is_held()) fail_as_mechanism(joint, rows.Z * rigid.free_motions());
  const auto moved = [&](const MatrixXd& forces) -> MatrixXd {
    return rows.Z * rigid.restore(rigid.half_solve(rows.Z.transpose() * forces));
  };
  const MatrixXd half = rigid.half_solve(rows.Z.transpose() * SY);
  const MatrixXd D_delta = MatrixXd(rows.Y) - rows.Z * rigid.restore(half);
  MatrixXd S_ud = rows.Y.transpose() * SY;
  S_ud.noalias() -= half.transpose() * half;
  const auto forces = [&](const VectorXd& load) {
    const VectorXd amounts = load.cwiseAbs();
    return without_rounding(D_delta.transpose() * load,
                            std::max((rows.Z.transpose() * amounts).lpNorm<Eigen::Infinity>(),
                                     (rows.Y.transpose() * amounts).lpNorm<Eigen::Infinity>()));
  };
  const VectorXd by_given = rows.S * rows.given, load = rows.load - by_given;
  CondensedSystem system{.q = forces(load),
                         .S_ud = S_ud,
                         .friction = rows.friction,
                         .E = rows.E,
                         .H_plus = D_delta.transpose() * rows.G_plus,
                         .H_minus = D_delta.transpose() * rows.G_minus,
                         .H_shear = D_delta.transpose() * rows.G_shear,
                         .D_load = rows.given + moved(load),
                         .D_delta = D_delta,
                         .D_plus = -moved(rows.G_plus),
                         .D_minus = -moved(rows.G_minus),
                         .D_shear = -moved(rows.G_shear)};
  if (rows.load_reversed != rows.load) {
    const VectorXd reversed = rows.load_reversed - by_given;
    system.q_reversed = forces(reversed);
    system.D_load_reversed = rows.given + moved(reversed);
  }
  return system;
}

}  // namespace fastjoint::stage3
