// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/limit_load.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "common/matrices/decompositions.hpp"

namespace fastjoint::stage3 {
namespace {

/// Motions of the planes by rigid bodies, (n a, their number), which S_ud does not resist.
MatrixXd free_motions(const JointEquations& equations) {
  constexpr double rounding = 1e-11;  // of the largest singular value
  const auto svd = matrices::singular_values(equations.system->S_ud.leftCols(equations.n_plane_rows()));
  return svd.V.rightCols(svd.V.cols() - svd.rank(rounding));
}

}  // namespace

std::optional<LimitLoad> limit_load(const JointEquations& equations, double sign) {
  if (equations.has_cosine_friction || !equations.starts_unloaded()) return std::nullopt;
  const Index n = equations.n_planes(), a = equations.n_directions();
  VectorXd max_force(n);
  for (Index j = 0; j < n; ++j) max_force[j] = equations.contacts[j].law->max_force();
  if (n == 0 || !max_force.allFinite()) return std::nullopt;
  const MatrixXd motions = free_motions(equations);
  const VectorXd work = motions.transpose() * equations.q_at(sign).head(n * a);
  constexpr double rounding = 1e-12;
  if (motions.cols() == 0 || work.norm() <= rounding * equations.q_at(sign).norm()) return std::nullopt;
  // Among the motions on which the unit load does unit work, one minimises the work of the laws, a weighted sum of
  // magnitudes. Iteratively reweighted least squares find it.
  constexpr int turns = 40;
  constexpr double min_magnitude = 1e-9;  // of the largest
  VectorXd weight = max_force;
  LimitLoad result{std::numeric_limits<double>::infinity(), {}};
  for (int turn = 0; turn < turns; ++turn) {
    const VectorXd of_rows = weight.transpose().replicate(a, 1).reshaped();
    const MatrixXd resistance = motions.transpose() * of_rows.asDiagonal() * motions;
    const VectorXd along = resistance.partialPivLu().solve(work);
    const VectorXd motion = motions * along / along.dot(work);
    const VectorXd magnitude = magnitudes(motion, a).cwiseAbs();
    const double largest = magnitude.maxCoeff();
    if (!(largest > 0) || !std::isfinite(largest)) break;
    if (const double factor = max_force.dot(magnitude); factor < result.factor) {
      result = {factor, {}};
      for (Index j = 0; j < n; ++j)
        if (magnitude[j] > min_magnitude * largest) result.planes.push_back(j);
    }
    weight = max_force.cwiseQuotient(magnitude.cwiseMax(min_magnitude * largest));
  }
  if (!(result.factor > 0) || !std::isfinite(result.factor)) return std::nullopt;
  return result;
}

}  // namespace fastjoint::stage3
