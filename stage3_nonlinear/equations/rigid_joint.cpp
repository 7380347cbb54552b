// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/rigid_joint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/errors.hpp"
#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

using SparseMatrix = RigidJoint::SparseMatrix;

/// Reciprocal condition below which a joint is a mechanism. The rounding of stage 2 gives a floating plate about 1e-12;
/// a long chain of fasteners has 1e-6, a plate on soft supports the stiffness of these over its own.
constexpr double singular = 1e-10;

/// First unknown of a disc in the joint's list.
Index disc(const JointModel& joint, const HoleModel& hole) { return joint.offset(hole.plate) + hole.disc; }

/// Reference hole of a fastener: that in the stiffest plate, or the ground, which counts as the one after the last.
Index reference(const JointModel& joint, const FastenerModel& fastener) {
  if (fastener.grounded) return std::ssize(fastener.holes);
  const auto own = [&](const HoleModel& hole) { return joint.plates[hole.plate].stiffest(); };
  return std::ranges::max_element(fastener.holes, {}, own) - fastener.holes.begin();
}

/// Matrix Y: displacements of all unknowns per relative displacement and moment.
SparseMatrix relative_motions(const JointModel& joint) {
  std::vector<Eigen::Triplet<double>> Y;
  for (Index at = 0; at < joint.n_planes(); ++at) {
    const ShearPlane& plane = joint.planes[at];
    const auto& holes = joint.fasteners[plane.fastener].holes;
    const bool before = reference(joint, joint.fasteners[plane.fastener]) > plane.first;
    for (Index d = 0; d < joint.n_directions(); ++d)
      for (Index hole = 0; hole < std::ssize(holes); ++hole)
        if ((hole <= plane.first) == before)
          Y.emplace_back(disc(joint, holes[hole]) + d, at * joint.n_directions() + d, before ? 1 : -1);
  }
  Index column = joint.n_planes() * joint.n_directions();
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    for (Index unknown = joint.plates[i].first_moment(); unknown < joint.plates[i].n_unknowns(); ++unknown)
      Y.emplace_back(joint.offset(i) + unknown, column++, 1);
  SparseMatrix result(joint.n_unknowns(), column);
  result.setFromTriplets(Y.begin(), Y.end());
  return result;
}

/// Matrix Z: each independent unknown has its own column, all discs of a fastener have that of its reference hole, tied
/// externals that of the first; the ground has none.
SparseMatrix free_unknowns(const JointModel& joint, const Held& held) {
  const Index N = joint.n_unknowns();
  std::vector<Index> leader(N);
  std::iota(leader.begin(), leader.end(), Index{0});
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const PlateModel& plate = joint.plates[i];
    for (Index unknown = plate.first_moment(); unknown < plate.n_unknowns(); ++unknown)
      leader[joint.offset(i) + unknown] = -1;
  }
  const auto unknown = [&](const std::pair<Index, Index>& external) {
    return joint.offset(external.first) + joint.plates[external.first].n_disc_unknowns() + external.second;
  };
  const auto loads = loads_of(joint);
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (held.displaced[i]) leader[unknown({loads[i].plate, loads[i].at})] = -1;
  for (const auto& group : held.ties)
    for (const auto& external : group) leader[unknown(external)] = unknown(group.front());
  for (const auto& fastener : joint.fasteners) {
    const Index at = reference(joint, fastener);
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
  SparseMatrix result(N, r);
  result.setFromTriplets(Z.begin(), Z.end());
  return result;
}

/// Null space of a scaled stiffness, (z, its dimension).
MatrixXd motions_without_stiffness(const MatrixXd& S_z) {
  constexpr double small = 1e3 * singular;  // since rcond is an estimate in another norm
  const auto eigen = matrices::symmetric_eigen(S_z);
  const auto n = (eigen.values.array() <= small * eigen.values.maxCoeff()).count();
  return eigen.vectors.leftCols(n);
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
      fmt::format("{}: the joint is a mechanism: plate {} can move freely even with rigid fasteners; give a plate "
                  "a support (stage 1), fix an external with \"displacement\": 0, or connect a fastener to the "
                  "\"ground\"",
                  joint.file, fmt::join(names, " with plate ")));
}

}  // namespace

RigidJoint::RigidJoint(const JointModel& joint, const Held& held)
    : Z_(free_unknowns(joint, held)), Y_(relative_motions(joint)), scale_(VectorXd::Zero(Z_.cols())) {
  VectorXd own(joint.n_unknowns());  // stiffness of the plate of each unknown
  for (Index i = 0; i < std::ssize(joint.plates); ++i)
    own.segment(joint.offset(i), joint.plates[i].n_unknowns()).setConstant(joint.plates[i].stiffest());
  for (Index j = 0; j < Z_.outerSize(); ++j)
    for (SparseMatrix::InnerIterator at(Z_, j); at; ++at) scale_[j] = std::max(scale_[j], own[at.row()]);
  MatrixXd S_z = MatrixXd::Zero(Z_.cols(), Z_.cols());
  for (Index i = 0; i < std::ssize(joint.plates); ++i) {
    const SparseMatrix its = Z_.middleRows(joint.offset(i), joint.plates[i].n_unknowns());
    S_z += its.transpose() * MatrixXd(joint.plates[i].S * its);
  }
  for (Index i = 0; i < scale_.size(); ++i) {
    const double at = std::max(S_z(i, i), singular * scale_[i]);
    scale_[i] = 1 / std::sqrt(at > 0 ? at : 1.0);
  }
  S_z = scale_.asDiagonal() * S_z * scale_.asDiagonal();
  factor_.compute(S_z);
  if (factor_.info() != Eigen::Success || !(factor_.rcond() > singular))
    fail_as_mechanism(joint, Z_ * MatrixXd(scale_.asDiagonal() * motions_without_stiffness(S_z)));
}

}  // namespace fastjoint::stage3
