// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/fit_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/errors.hpp"
#include "stage3_nonlinear/cubic_law.hpp"
#include "stage3_nonlinear/least_squares.hpp"

namespace fastjoint::stage3 {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Held = std::array<bool, 3>;

/// Points in units of their last displacement and greatest force, so that constants are of order 1.
struct Scaled {
  double last = 0, greatest = 0;
  VectorXd x, y;  ///< (n)
};

/// @param contact Points up to this displacement are left out unless they have a force; those at 0 always.
Scaled scaled(const TestPoints& points, double contact) {
  Scaled s;
  TestPoints kept;
  for (const auto& [delta, F] : points) {
    s.last = std::max(s.last, delta);
    s.greatest = std::max(s.greatest, F);
    if (delta > 0 && (delta > contact || F > 0)) kept.push_back({delta, F});
  }
  s.x.resize(static_cast<Index>(kept.size()));
  s.y.resize(s.x.size());
  for (Index i = 0; i < s.x.size(); ++i) {
    s.x[i] = kept[static_cast<std::size_t>(i)][0] / s.last;
    s.y[i] = kept[static_cast<std::size_t>(i)][1] / s.greatest;
  }
  return s;
}

/// Squares and powers of what is outside overflow.
void require_range(const char* name, double largest) {
  constexpr double low = 1e-60, high = 1e60;
  if (!(largest >= low && largest <= high))
    throw InputError(fmt::format("the largest {} is {}; allowed: {} to {}, in other units", name, largest, low, high));
}

void require_enough(const TestPoints& points) {
  std::set<double> loaded;
  double last = 0, greatest = 0;
  for (const auto& [delta, F] : points)
    if (delta > 0 && F > 0) {
      loaded.insert(delta);
      last = std::max(last, delta);
      greatest = std::max(greatest, F);
    }
  if (loaded.size() < 3)
    throw InputError(fmt::format("forces > 0 at {} different delta > 0; allowed: at 3 or more of them", loaded.size()));
  require_range("delta", last);
  require_range("F", greatest);
}

/// The last displacement without force before the first with one, or 0.
double last_unloaded(const TestPoints& points) {
  double first = std::numeric_limits<double>::infinity(), last = 0;
  for (const auto& [delta, F] : points)
    if (F > 0) first = std::min(first, delta);
  for (const auto& [delta, F] : points)
    if (F <= 0 && delta < first) last = std::max(last, delta);
  return last;
}

double power(const Vector3d& c, double x) { return x > c[2] ? c[0] * std::pow(x - c[2], c[1]) : 0; }

Vector3d power_gradient(const Vector3d& c, double x) {
  const double u = x - c[2];
  if (u <= 0) return Vector3d::Zero();
  const double u_n = std::pow(u, c[1]);
  return {u_n, c[0] * u_n * std::log(u), -c[0] * c[1] * u_n / u};
}

Vector3d cubic_gradient(double x) { return {x, x * x, x * x * x}; }

/// Fit of scaled points.
struct ScaledFit {
  Held held;
  Vector3d constants;
  Matrix3d inverse;  ///< of J^T J, zero in rows of what is held
  double square_sum;
  bool converged;
};

/// The best of a grid of n and delta0, each with the A that suits it: least squares may have several valleys.
Vector3d start_from_grid(const Scaled& points, const Held& held, double least_delta0) {
  constexpr int n_delta0 = 40, n_n = 10;
  const auto& [last, greatest, x, y] = points;
  double half = 1;  // contact comes before half of the greatest force
  for (Index i = 0; i < x.size(); ++i)
    if (y[i] >= 0.5) half = std::min(half, x[i]);
  Vector3d start(1, 1, least_delta0);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < (held[2] ? 1 : n_delta0); ++i)
    for (int j = held[1] ? n_n : 1; j <= n_n; ++j) {
      const Vector3d trial(1, static_cast<double>(j) / n_n, least_delta0 + i * (half - least_delta0) / n_delta0);
      const VectorXd v = x.unaryExpr([&](double at) { return power(trial, at); });
      const double A = v.dot(y) / v.squaredNorm();
      const double sum = (A * v - y).squaredNorm();
      if (!(sum < least)) continue;
      least = sum;
      start = {A, trial[1], trial[2]};
    }
  return start;
}

/// Least squares of a power law with n held at 1 or delta0 at its least or both or none.
ScaledFit search_power(const Scaled& points, const Held& held, double least_delta0) {
  const Vector3d start = start_from_grid(points, held, least_delta0);
  std::vector<Index> free;
  for (Index i = 0; i < 3; ++i)
    if (!held[static_cast<std::size_t>(i)]) free.push_back(i);
  const auto all = [&](const VectorXd& some) {
    Vector3d c = start;
    c(free) = some;
    return c;
  };
  const auto residual = [&](const VectorXd& some) -> VectorXd {
    return points.x.unaryExpr([c = all(some)](double x) { return power(c, x); }) - points.y;
  };
  const auto jacobian = [&](const VectorXd& some) {
    Eigen::MatrixXd J(points.x.size(), some.size());
    for (Index i = 0; i < J.rows(); ++i) J.row(i) = power_gradient(all(some), points.x[i])(free).transpose();
    return J;
  };
  const LeastSquares found = nonlinear_least_squares({residual, jacobian}, start(free));
  Matrix3d inverse = Matrix3d::Zero();
  inverse(free, free) = found.inverse;
  return {held, all(found.x), inverse, residual(found.x).squaredNorm(), found.converged};
}

/// The best of the searches whose constants are inside their bounds, with as few held as need be.
ScaledFit search_power(const Scaled& points, double least_delta0) {
  constexpr double on_bound = 1e-9;  // what a search of exact points leaves
  constexpr double flat = 0.01;      // a law of less is a step
  const auto inside = [&](const ScaledFit& fit) {
    return (fit.held[1] || fit.constants[1] < 1 - on_bound) &&
           (fit.held[2] || fit.constants[2] > least_delta0 + on_bound);
  };
  ScaledFit best = search_power(points, {false, false, false}, least_delta0);
  if (!inside(best)) {
    best = search_power(points, {false, true, true}, least_delta0);
    for (const Held& held : {Held{false, true, false}, Held{false, false, true}}) {
      const ScaledFit fit = search_power(points, held, least_delta0);
      if (inside(fit) && fit.square_sum < best.square_sum) best = fit;
    }
  }
  if (!best.converged)
    throw NumericalError("the search for a power law did not end; leave out points before contact and after failure");
  if (best.constants[1] < flat)
    throw InputError(
        fmt::format("the force does not grow with delta, the power law that fits best has n = {:.3g}; "
                    "allowed: a test whose force grows",
                    best.constants[1]));
  return best;
}

/// Sets what all kinds have in common. @param inverse Of J^T J of the constants; @param n_free how many are not held.
void weigh(Fit& fit, const TestPoints& points, const Matrix3d& inverse, int n_free) {
  double all = 0, past_contact = 0;
  int n_past_contact = 0;
  for (const auto& [delta, F] : points) {
    const double square = std::pow(force(fit, delta) - F, 2);
    all += square;
    if (delta <= (fit.kind == Fit::Kind::power ? fit.constants[2] : 0)) continue;
    past_contact += square;
    ++n_past_contact;
  }
  fit.n_points = static_cast<int>(points.size());
  fit.rms = std::sqrt(all / fit.n_points);
  fit.has_uncertainty = n_past_contact > n_free;
  if (fit.has_uncertainty)
    fit.covariance = past_contact / (n_past_contact - n_free) * inverse;
  else
    fit.warnings.push_back(
        fmt::format("{} points past contact are too few for the uncertainty of {} constants", n_past_contact, n_free));
}

}  // namespace

Fit fit_power(const TestPoints& points) {
  require_enough(points);
  const double contact = last_unloaded(points);
  const Scaled s = scaled(points, contact);
  const ScaledFit found = search_power(s, contact / s.last);
  const double a = found.constants[0], n = found.constants[1], d = found.constants[2];
  const double unit = s.greatest / std::pow(s.last, n);
  Fit fit{
      .kind = Fit::Kind::power, .constants = {a * unit, n, d * s.last}, .on_bound = found.held, .last_delta = s.last};
  Matrix3d scale = Vector3d(unit, 1, s.last).asDiagonal();  // derivatives of A, n, delta0 by the scaled constants
  scale(0, 1) = -a * unit * std::log(s.last);
  scale /= s.greatest;  // and of residuals
  if (found.held[1]) fit.warnings.emplace_back("n is on its bound 1: the points rise as a line or steeper and steeper");
  weigh(fit, points, scale * found.inverse * scale.transpose(),
        static_cast<int>(std::count(found.held.begin(), found.held.end(), false)));
  return fit;
}

Fit fit_cubic(const TestPoints& points) {
  require_enough(points);
  const Scaled s = scaled(points, 0);
  Eigen::MatrixXd J(s.x.size(), 3);
  for (Index i = 0; i < J.rows(); ++i) J.row(i) = cubic_gradient(s.x[i]).transpose();
  const LeastSquares found = linear_least_squares(J, s.y);
  const Vector3d unit = cubic_gradient(1 / s.last);  // derivatives of a, b, c by the scaled constants, over the force
  Fit fit{.kind = Fit::Kind::cubic, .constants = s.greatest * unit.cwiseProduct(found.x), .last_delta = s.last};
  const auto deltas = cubic_deltas(fit);
  std::array<double, 3> forces{};
  for (std::size_t i = 0; i < 3; ++i) {
    forces[i] = force(fit, deltas[i]);
    if (!(forces[i] > 0))
      throw InputError(
          fmt::format("the cubic that fits best has F = {:.4g} at delta = {:.4g}; allowed: a test whose "
                      "cubic is above 0 at a third, two thirds and all of its last delta",
                      forces[i], deltas[i]));
  }
  weigh(fit, points, unit.asDiagonal() * found.inverse * unit.asDiagonal(), 3);
  for (auto& doubt : CubicLaw(deltas, forces).doubts()) fit.warnings.push_back(std::move(doubt));
  return fit;
}

double force(const Fit& fit, double delta) {
  return fit.kind == Fit::Kind::power ? power(fit.constants, delta) : fit.constants.dot(cubic_gradient(delta));
}

double force_uncertainty(const Fit& fit, double delta) {
  const Vector3d gradient = fit.kind == Fit::Kind::power ? power_gradient(fit.constants, delta) : cubic_gradient(delta);
  return std::sqrt(std::max(0.0, gradient.dot(fit.covariance * gradient)));
}

std::array<double, 3> cubic_deltas(const Fit& fit) {
  return {fit.last_delta / 3, 2 * fit.last_delta / 3, fit.last_delta};
}

}  // namespace fastjoint::stage3
