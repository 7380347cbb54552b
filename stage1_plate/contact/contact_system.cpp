// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/contact/contact_system.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>

#include "common/errors.hpp"
#include "common/plate/plate_states.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {
namespace {

/// The load on each controlled displacement.
std::vector<Load> controlled_loads(const PlateScene& scene, const Unknowns& unknowns) {
  const SceneLoads& given = scene.given_loads();
  std::vector<Load> loads;
  loads.reserve(unknowns.n_controlled());
  for (const int external : rigid_externals(scene)) loads.push_back(given.external[external]);
  loads.insert(loads.end(), given.disc.begin(), given.disc.end());
  return loads;
}

/// One factorisation at the highest degree. The states solved for are unit loads on the rim unknowns, then unit
/// tractions, displacements and friction cases.
RimCondensation condense_to_rims(const PlateProblem& problem, const RimUnknowns& rim) {
  const Eigen::Index n_r = rim.free.size(), q = problem.T_c.cols();
  const Eigen::Index nc = problem.unknowns.n_controlled(), h = problem.unknowns.n_friction_cases();
  Eigen::MatrixXd border = Eigen::MatrixXd::Zero(nc + h, n_r + q + nc + h);
  border.rightCols(nc + h).setIdentity();
  Eigen::SparseMatrix<double> loads(problem.T_f.rows(), border.cols());
  for (Eigen::Index i = 0; i < n_r; ++i) loads.insert(rim.free[i], i) = 1;
  loads.middleCols(n_r, q) = problem.T_f;
  const plate::PlateFactor K(problem, plate::Skeleton(problem), problem.numbering.p);
  const plate::PlateStates states(K, border, loads);
  const Eigen::MatrixXd u_r = states.work().topRows(n_r), forces = states.forces();
  return {u_r.leftCols(n_r),  u_r.middleCols(n_r + q, nc),    u_r.middleCols(n_r, q),
          u_r.rightCols(h),   forces.middleCols(n_r + q, nc), forces.middleCols(n_r, q) - problem.T_c,
          forces.rightCols(h)};
}

}  // namespace

ContactSystem::ContactSystem(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem)
    : scene_(scene),
      plate_(plate),
      problem_(problem),
      rim_(find_rim_unknowns(scene, plate, problem)),
      plate_matrices_(condense_to_rims(problem, rim_)),
      loads_(controlled_loads(scene, problem.unknowns)),
      traction_(problem.T_c.cols()),
      side_(loads_.size(), 0),
      whole_(Eigen::MatrixXd::Zero(rim_.size(), rim_.size())) {
  const auto tractions = traction_externals(scene);
  for (std::size_t i = 0; i < tractions.size(); ++i) traction_[i] = scene.given_loads().external[tractions[i]].value;
  for (int hole = 0; hole < count_of(scene.holes); ++hole) {
    const auto& spring = scene.holes[hole].spring;
    if (!spring || !spring->compression_only) continue;
    holes_.push_back(hole);
    gaps_.emplace_back(scene, plate, problem, rim_, holes_.back());
    whole_ += gaps_.back().stiffness(whole_rim);
  }
}

/// Solves the system of docs/theory.md, section 6.5, for x = (u_r, D, P / kappa), kappa the largest stiffness of the
/// springs. Its three rows of blocks are the rim's displacements, the forces and the given values.
ContactSystem::State ContactSystem::solve(const std::vector<Arcs>& arcs) {
  PlateScene sprung = scene_;
  for (std::size_t i = 0; i < arcs.size(); ++i)
    if (auto& spring = sprung.holes[holes_[i]].spring) spring->acts = arcs[i];
  if (!is_held_under_loads(sprung, plate_, problem_.unknowns)) lost(arcs);
  Eigen::MatrixXd dM = -whole_;
  for (std::size_t i = 0; i < gaps_.size(); ++i) dM += gaps_[i].stiffness(arcs[i]);
  const Eigen::Index n_r = rim_.free.size(), nc = rim_.n_controlled;
  const auto& [C, U_r, V_r, W_r, S, T, R] = plate_matrices_;
  const Eigen::MatrixXd A = friction_per_force();
  const double kappa = whole_.diagonal().maxCoeff();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n_r + 2 * nc, n_r + 2 * nc);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(K.rows());
  K.topLeftCorner(n_r, n_r + nc) = C * dM.topRows(n_r);
  K.topLeftCorner(n_r, n_r) += Eigen::MatrixXd::Identity(n_r, n_r);
  K.block(0, n_r, n_r, nc) -= U_r;
  K.topRightCorner(n_r, nc) = -kappa * W_r * A;
  b.head(n_r) = V_r * traction_;
  K.block(n_r, 0, nc, n_r + nc) = -(dM.bottomRows(nc) + U_r.transpose() * dM.topRows(n_r)) / kappa;
  K.block(n_r, n_r, nc, nc) -= S / kappa;
  K.block(n_r, n_r + nc, nc, nc) = Eigen::MatrixXd::Identity(nc, nc) - R * A;
  b.segment(n_r, nc) = T * traction_ / kappa;
  for (Eigen::Index i = 0; i < nc; ++i) {
    const Load& load = loads_[i];
    K(n_r + nc + i, load.is_force ? n_r + nc + i : n_r + i) = 1;
    b[n_r + nc + i] = load.is_force ? load.value / kappa : load.value;
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(K);
  constexpr double singular = 1e-13;
  if (!(lu.rcond() > singular)) lost(arcs);
  const Eigen::VectorXd x = lu.solve(b);
  State state{x.head(n_r + nc), x.segment(n_r, nc), kappa * x.tail(nc), {}, false};
  state.friction = A * state.force;
  state.friction_settled = choose_sides(state.force);
  return state;
}

/// A of Lambda = A P, shape (h, nc): mu / c on the side that bears.
Eigen::MatrixXd ContactSystem::friction_per_force() const {
  const Unknowns& unknowns = problem_.unknowns;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns.n_friction_cases(), rim_.n_controlled);
  for (int disc = 0; disc < unknowns.n_discs(); ++disc) {
    const int controlled = unknowns.controlled_of_disc(disc);
    const double friction = loads_[controlled].friction;
    const int side = side_[controlled];
    if (friction == 0 || side == 0) continue;
    const auto& rim = plate_.rims[index_of(scene_.holes, unknowns.disc_hole[disc], &Hole::id)];
    const Eigen::Vector2d e = rim::axis(unknowns.disc_direction[disc]);
    const double c = rim::bearing(plate_.mesh, plate_.edges, rim, side * e).unit_force;
    const int friction_case = 2 * disc + (side > 0 ? 0 : 1);
    if (c > 0) A(friction_case, controlled) = friction * side / c;
  }
  return A;
}

/// Whether the sides were right; a disc that carries next to nothing keeps its side.
bool ContactSystem::choose_sides(const Eigen::VectorXd& force) {
  constexpr double nothing = 1e-9;  // of the largest force
  const double largest = std::max(force.lpNorm<Eigen::Infinity>(), traction_.lpNorm<Eigen::Infinity>());
  bool right = true;
  for (std::size_t i = 0; i < side_.size(); ++i) {
    const double f = force[i];
    if (loads_[i].friction == 0 || std::abs(f) <= nothing * largest) continue;
    const int side = f > 0 ? 1 : -1;
    right = right && side == side_[i];
    side_[i] = side;
  }
  return right;
}

void ContactSystem::lost(const std::vector<Arcs>& arcs) const {
  for (std::size_t i = 0; i < arcs.size(); ++i)
    if (arcs[i].empty())
      throw NumericalError(fmt::format(
          "{}: /loads: hole \"{}\" has lost contact all round, and then something that carries load can move freely; "
          "allowed: loads that press discs against rims, or supports that hold the plate without them",
          scene_.file, scene_.holes[holes_[i]].id));
  if (std::ranges::all_of(arcs, [](const Arcs& each) { return each == whole_rim; }))
    throw NumericalError(
        fmt::format("{}: /loads: even with the whole rims sprung, something that carries load can move freely; "
                    "allowed: loads against which supports, held discs or held externals stand",
                    scene_.file));
  throw NumericalError(fmt::format(
      "{}: /loads: with springs on the parts of rims that bear, something that carries load can move freely; allowed: "
      "loads under which contact, supports and other springs hold the plate and its discs",
      scene_.file));
}

}  // namespace fastjoint::stage1
