// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/run/accuracy.hpp"

#include <algorithm>
#include <limits>

namespace fastjoint::stage1 {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Strain along a rim, (-dv/dtheta - w) over its radius, times its area and radius, as coefficients of the whole
/// circle's basis, (2 highest + 1, columns).
MatrixXd strain(const rim::Harmonics& shape, const MatrixXd& rows) {
  const MatrixXd w = shape.pressures_of_whole() * rows.topRows(shape.size());
  const MatrixXd v = shape.shears_of_whole() * rows.bottomRows(shape.n_shears());
  MatrixXd waves = -w;
  for (Index k = 1; k <= shape.highest; ++k) {
    waves.row(2 * k - 1) -= double(k) * v.row(2 * k);
    waves.row(2 * k) += double(k) * v.row(2 * k - 1);
  }
  return waves;
}

/// Extrapolated sum of all further pairs of orders, for the norms of the last pair and of the pair before it.
double truncation_error(double last, double before) {
  constexpr double min_ratio = 0.1, max_ratio = 0.8;
  const double ratio = std::clamp(before > 0 ? last / before : max_ratio, min_ratio, max_ratio);
  return last * ratio / (1 - ratio);
}

/// Relative error of one rim in some unit cases.
double rim_error(int highest, const MatrixXd& waves, const MatrixXd& below) {
  const double size = waves.norm();
  if (size == 0) return 0;
  const auto norm_of_pair = [&](Index last) {  // orders last - 1 and last
    const Index rows = std::min<Index>(4, 2 * last);
    return last > 0 ? waves.middleRows(2 * last + 1 - rows, rows).norm() : 0;
  };
  return (2 * (waves - below).norm() + truncation_error(norm_of_pair(highest), norm_of_pair(highest - 2))) / size;
}

}  // namespace

double hoop_error(const std::vector<std::optional<rim::Waves>>& waves, const MatrixXd& W, const MatrixXd& below,
                  Index n_displacements, Index n_tractions) {
  double worst = 0;
  Index row = 0;
  for (const bool loaded : {true, false})
    for (const auto& rim : waves) {
      if (!rim || rim->loaded != loaded) continue;
      if (below.size() == 0) return std::numeric_limits<double>::infinity();
      const Index first = row;
      row += rim->size();
      const auto error = [&](Index column, Index n) {
        return n == 0 ? 0
                      : rim_error(rim->shape.highest, strain(rim->shape, W.block(first, column, rim->size(), n)),
                                  strain(rim->shape, below.block(first, column, rim->size(), n)));
      };
      worst = std::max({worst, error(0, n_displacements), error(W.cols() - n_tractions, n_tractions)});
    }
  return worst;
}

}  // namespace fastjoint::stage1
