// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/pfem/stiffness_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fastjoint::pfem {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Sum over all degrees above p of what is 1 at p and falls as p^-s, by Euler and Maclaurin's formula.
double tail(double p, double s) { return p / (s - 1) - 0.5 + s / (12 * p); }

/// s of the differences of a sequence, from its last three.
double rate(const Eigen::VectorXd& values, const Eigen::VectorXi& p) {
  constexpr double slowest = 1.5, unknown = 3, fastest = 5;
  const auto n = values.size();
  if (n < 4) return unknown;
  const double before = values[n - 4] - values[n - 3], last = values[n - 2] - values[n - 1];
  if (!(before > 0 && last > 0)) return slowest;
  return std::clamp(std::log(before / last) / std::log(double(p[n - 1]) / p[n - 3]), slowest, fastest);
}

double last_difference(const Eigen::VectorXd& values) {
  const auto n = values.size();
  return std::abs(values[n - 2] - values[n - 1]);
}

}  // namespace

double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& p) {
  const auto n = values.size();
  if (n < 2) return infinite;
  const double rounding = 1e-13 * std::abs(values[n - 1]);
  return std::max(tail(p[n - 1], rate(values, p)) * last_difference(values), rounding);
}

Eigen::MatrixXd stiffness_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& p) {
  const auto n = S.back().rows();
  if (S.size() < 2) return Eigen::MatrixXd::Constant(n, n, infinite);
  const Eigen::MatrixXd last = S[S.size() - 2] - S.back();
  Eigen::VectorXd error(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd values(p.size());
    for (Eigen::Index level = 0; level < p.size(); ++level) values[level] = S[static_cast<std::size_t>(level)](i, i);
    error[i] = extrapolated_error(values, p);
  }
  constexpr double least = 0.15;  // of the bound
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double bound = std::sqrt(error[i] * error[j]), bound_of_last = std::sqrt(last(i, i) * last(j, j));
      const double share = bound_of_last > 0 ? std::min(std::abs(last(i, j)) / bound_of_last, 1.0) : 1;
      result(i, j) = bound * std::hypot(share, least * std::sqrt(1 - share * share));
    }
  return result;
}

double relative_error(const Eigen::MatrixXd& error, const Eigen::MatrixXd& S) {
  const double size = S.norm();
  return size > 0 ? error.norm() / size : 0;
}

}  // namespace fastjoint::pfem
