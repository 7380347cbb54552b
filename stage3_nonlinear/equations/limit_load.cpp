// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/limit_load.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

/// Motions of the planes, (n a, their number), that move the sheets as rigid bodies: S_ud does not resist them.
MatrixXd free_motions(const JointEquations& equations) {
  constexpr double rounding = 1e-11;  // of the largest singular value
  const auto svd = matrices::singular_values(equations.system->S_ud.leftCols(equations.n_plane_rows()));
  return svd.V.rightCols(svd.V.cols() - svd.rank(rounding));
}

}  // namespace

std::optional<LimitLoad> limit_load(const JointEquations& equations, double sign) {
  if (equations.has_cosine_friction || !equations.starts_unloaded()) return std::nullopt;
  const Index n = equations.n_planes(), a = equations.n_directions();
  VectorXd most(n);
  for (Index j = 0; j < n; ++j) most[j] = equations.contacts[j].law->most_force();
  if (!most.allFinite()) return std::nullopt;
  const MatrixXd motions = free_motions(equations);
  const VectorXd work = motions.transpose() * equations.q_at(sign).head(n * a);
  constexpr double nothing = 1e-12;
  if (motions.cols() == 0 || work.norm() <= nothing * equations.q_at(sign).norm()) return std::nullopt;
  // The laws do least work on one of the motions on which the unit load does unit work. Least squares find it, whose
  // weights follow the amounts of the turn before.
  constexpr int turns = 40;
  constexpr double least_amount = 1e-9;  // of the largest
  VectorXd weight = most;
  LimitLoad result{std::numeric_limits<double>::infinity(), {}};
  for (int turn = 0; turn < turns; ++turn) {
    const VectorXd of_rows = weight.transpose().replicate(a, 1).reshaped();
    const MatrixXd resistance = motions.transpose() * of_rows.asDiagonal() * motions;
    const VectorXd along = resistance.partialPivLu().solve(work);
    const VectorXd motion = motions * along / along.dot(work);
    const VectorXd amount = amounts(motion, a).cwiseAbs();
    const double largest = amount.maxCoeff();
    if (!(largest > 0) || !std::isfinite(largest)) break;
    if (const double factor = most.dot(amount); factor < result.factor) {
      result = {factor, {}};
      for (Index j = 0; j < n; ++j)
        if (amount[j] > least_amount * largest) result.planes.push_back(j);
    }
    weight = most.cwiseQuotient(amount.cwiseMax(least_amount * largest));
  }
  if (!(result.factor > 0) || !std::isfinite(result.factor)) return std::nullopt;
  return result;
}

}  // namespace fastjoint::stage3
