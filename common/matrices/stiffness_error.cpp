// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/matrices/stiffness_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include "common/count.hpp"

namespace fastjoint::matrices {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity(), min_rate = 1.5;

/// Sum over all degrees k > p of (k / p)^-s, by the Euler-Maclaurin formula.
double tail(double p, double s) { return p / (s - 1) - 0.5 + s / (12 * p); }

/// Rate s of a sequence by its last difference and that two degrees before, or by its two differences; infinite for a
/// single difference.
double rate(const Eigen::VectorXd& values, const Eigen::VectorXi& p) {
  const auto n = values.size();
  if (n < 3) return infinite;
  const auto first = std::max<Eigen::Index>(n - 4, 0);
  const double before = values[first] - values[first + 1], last = values[n - 2] - values[n - 1];
  if (!(before > 0 && last > 0)) return min_rate;
  return std::log(before / last) / std::log(double(p[n - 1]) / p[first + 1]);
}

/// Diagonal entry i of each matrix.
Eigen::VectorXd diagonal(const std::vector<Eigen::MatrixXd>& S, Eigen::Index i) {
  Eigen::VectorXd values(std::ssize(S));
  for (int level = 0; level < count_of(S); ++level) values[level] = S[level](i, i);
  return values;
}

}  // namespace

double max_rate_of(const std::vector<Eigen::Matrix3d>& elasticity) {
  constexpr double smooth = 5, at_rollers = 3, nothing = 1e-9;
  const auto couples = [](const Eigen::Matrix3d& D) { return D.col(2).head<2>().norm() > nothing * D.norm(); };
  return std::any_of(elasticity.begin(), elasticity.end(), couples) ? at_rollers : smooth;
}

double extrapolated_error(const Eigen::VectorXd& values, const Eigen::VectorXi& p, double max_rate) {
  constexpr double max_rate_of_few = 3, max_rate_of_difference = 8;
  constexpr double full_rate_p = 6;  // from this degree on, max_rate applies in full
  const auto n = values.size();
  if (n < 2) return infinite;
  const double observed = rate(values, p), rounding = 1e-13 * std::abs(values[n - 1]);
  double limit = max_rate * std::min(1.0, (p[n - 1] - 1) / (full_rate_p - 1));
  if (n < 4) limit = std::min({limit, max_rate_of_few, max_rate - 1});
  double last = std::abs(values[n - 2] - values[n - 1]);
  if (n > 2)
    last = std::max(last,
                    std::abs(values[n - 3] - values[n - 2]) *
                        std::pow(double(p[n - 2]) / p[n - 1], std::clamp(observed, min_rate, max_rate_of_difference)));
  return std::max(tail(p[n - 1], std::clamp(observed, min_rate, std::max(min_rate, limit))) * last, rounding);
}

Eigen::MatrixXd stiffness_error(const std::vector<Eigen::MatrixXd>& S, const Eigen::VectorXi& p, double max_rate) {
  const auto n = S.back().rows();
  if (S.size() < 2) return Eigen::MatrixXd::Constant(n, n, infinite);
  const Eigen::MatrixXd last = S[S.size() - 2] - S.back();
  Eigen::VectorXd error(n);
  for (Eigen::Index i = 0; i < n; ++i) error[i] = extrapolated_error(diagonal(S, i), p, max_rate);
  constexpr double min_fraction = 0.15;  // of the Cauchy-Schwarz bound
  Eigen::MatrixXd result(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      const double bound = std::sqrt(error[i] * error[j]), bound_of_last = std::sqrt(last(i, i) * last(j, j));
      const double fraction = bound_of_last > 0 ? std::min(std::abs(last(i, j)) / bound_of_last, 1.0) : 1;
      result(i, j) = bound * std::hypot(fraction, min_fraction * std::sqrt(1 - fraction * fraction));
    }
  return result;
}

std::vector<RelativeError> relative_errors(const CondensedLevels& a, const Eigen::VectorXi& p,
                                           const Eigen::VectorXd& diagonal_of_K_cc, double max_rate) {
  std::vector<RelativeError> errors;
  if (const auto& S = a.S.back(); S.size() > 0)
    errors.push_back({"S", stiffness_error(a.S, p, max_rate).cwiseMax(a.rounding).norm() /
                               (S.isZero(0) ? diagonal_of_K_cc.norm() : S.norm())});
  if (const auto& R = a.R.back(); R.size() > 0 && !R.isZero(0)) {
    // The sequence `path` decreases by the norms of R's differences, so that it can be extrapolated.
    Eigen::VectorXd energy = Eigen::VectorXd::Zero(p.size()), path = energy;
    for (Eigen::Index i = 0; i < a.S.back().rows(); ++i) energy += diagonal(a.S, i);
    for (int i = count_of(a.R) - 1; i > 0; --i) path[i - 1] = path[i] + (a.R[i] - a.R[i - 1]).norm();
    errors.push_back({"R", extrapolated_error(path, p, std::min(max_rate, rate(energy, p))) / R.norm()});
  }
  if (const auto& C = a.C.back(); C.size() > 0) {
    std::vector<Eigen::MatrixXd> falling;
    for (const auto& each : a.C) falling.push_back(-each);
    errors.push_back({"C_t", stiffness_error(falling, p, max_rate).norm() / C.norm()});
  }
  return errors;
}

double largest(const std::vector<RelativeError>& errors) {
  double worst = 0;
  for (const auto& error : errors) worst = std::max(worst, error.value);
  return worst;
}

std::string to_text(const std::vector<RelativeError>& errors) {
  constexpr double rounding = 1e-10;
  std::string text;
  for (const auto& [of, value] : errors)
    text += fmt::format("{} {} {}", text.empty() ? "error of" : ", of", of,
                        value < rounding ? "below 1e-10" : fmt::format("about {:.2e}", value));
  return text;
}

}  // namespace fastjoint::matrices
