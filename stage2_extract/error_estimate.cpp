// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage2_extract/error_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::stage2 {
namespace {

/// Remaining error x = S_p - S_inf >= 0 from the last two falls, first > last > 0: the error before them was x + last
/// and x + last + first, and the logarithms of the three are proportional to those of N. Bisection on log x, where the
/// defect rises monotonically. Infinite if they fall more slowly than any power of N.
double fit(double first, double last, double n0, double n1, double n2) {
  const double Q = std::log(n2 / n1) / std::log(n1 / n0);
  const auto defect = [&](double x) {
    return std::log(x / (x + last)) - Q * std::log((x + last) / (x + last + first));
  };
  double low = std::log(1e-12 * last);
  double high = std::log(1e6 * first);
  if (defect(std::exp(low)) > 0) return std::exp(low);
  if (defect(std::exp(high)) < 0) return std::numeric_limits<double>::infinity();
  constexpr int n_halvings = 60;
  for (int i = 0; i < n_halvings; ++i) {
    const double middle = (low + high) / 2;
    (defect(std::exp(middle)) > 0 ? high : low) = middle;
  }
  return std::exp(high);
}

}  // namespace

double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& N) {
  const auto n = values.size();
  if (n < 2) return std::numeric_limits<double>::infinity();
  const double last = values[n - 2] - values[n - 1];
  const double rounding = 1e-13 * std::abs(values[n - 1]);
  if (n < 3) return std::max(std::abs(last), rounding);
  const double first = values[n - 3] - values[n - 2];
  if (!(last > rounding && first > last)) return std::max(std::abs(last), rounding);
  const double fitted = fit(first, last, N[n - 3], N[n - 2], N[n - 1]);
  return std::isfinite(fitted) ? fitted : last;
}

Eigen::MatrixXd estimate_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& N) {
  const auto n = S.back().rows();
  Eigen::VectorXd diagonal(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd values(N.size());
    for (Eigen::Index level = 0; level < N.size(); ++level) values[level] = S[static_cast<std::size_t>(level)](i, i);
    diagonal[i] = extrapolated_error(values, N);
  }
  const Eigen::VectorXd root = diagonal.cwiseSqrt();
  return root * root.transpose();
}

}  // namespace fastjoint::stage2
