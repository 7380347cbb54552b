// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/tangent_factor.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace fastjoint::stage3 {
namespace {

/// Divides the derivatives of a state by columns whose largest entry exceeds 1, and returns the divisors. Small columns
/// stay: the tangent by contact coordinates is of order 1, and small columns are a lack of stiffness.
VectorXd scale_columns(const CondensedSystem& system, ContactState& state) {
  VectorXd scale(state.F.size());
  for (PlacedResponse& part : state.parts) {
    const Index n = part.F.size();
    const auto entries = [](const MatrixXd& A) { return A.cwiseAbs().colwise().maxCoeff().transpose().eval(); };
    auto its = scale.segment(part.row, n);
    its = entries(part.dF).cwiseMax(system.K[part.row] * entries(part.ddelta)).cwiseMax(1.0);
    for (MatrixXd* slopes : {&part.dF, &part.ddelta, &part.dLambda})
      if (slopes->rows() > 0) slopes->array().rowwise() /= its.transpose().array();
  }
  return scale;
}

/// Rows of J in the columns of a part, (rows, n), without its dF.
MatrixXd columns_of(const CondensedSystem& system, const PlacedResponse& part, const auto& rows) {
  MatrixXd J = system.S_ud(rows, Eigen::seqN(part.row, part.F.size())) * part.ddelta;
  if (const Index t = part.dLambda.rows(); t > 0)
    J.noalias() += system.H(rows, Eigen::seqN(part.friction, t)) * part.dLambda;
  return J;
}

constexpr double nearly_rounding = 1e-12, near_enough = 1e-10;  // of the right-hand side

}  // namespace

MatrixXd tangent(const CondensedSystem& system, const ContactState& state) {
  MatrixXd J(system.S_ud.rows(), system.S_ud.cols());
  for (const PlacedResponse& part : state.parts) {
    J.middleCols(part.row, part.F.size()) = columns_of(system, part, Eigen::all);
    J.block(part.row, part.row, part.F.size(), part.F.size()) += part.dF;
  }
  return J;
}

TangentFactor::TangentFactor(const CondensedSystem& system, ContactState state)
    : system_(system), state_(std::move(state)), scale_(scale_columns(system_, state_)), is_singular_(false) {
  Index first = system.S_ud.rows() - system.n_moments();
  kept_.resize(first);
  std::iota(kept_.begin(), kept_.end(), Index{0});
  for (std::size_t rim = 0; rim < system.rim_sizes.size(); ++rim) {
    for (Index i = 0; i < system.long_waves[rim]; ++i) kept_.push_back(first + i);
    first += system.rim_sizes[rim];
  }
  schur_.resize(n_kept(), n_kept());
  Index column = 0;
  const Index n_parts = std::ssize(state_.parts), n_rims = std::ssize(system.rim_sizes);
  for (Index i = 0; i < n_parts; ++i) {
    const PlacedResponse& part = state_.parts[i];
    const Index n = part.F.size(), n_long = i < n_parts - n_rims ? n : system.long_waves[i - (n_parts - n_rims)];
    const MatrixXd on_kept = columns_of(system, part, kept_);
    auto schur = schur_.middleCols(column, n_long);
    schur = on_kept.leftCols(n_long);
    schur.middleRows(column, n_long) += part.dF.topLeftCorner(n_long, n_long);
    if (n_long < n) {
      const Index n_short = n - n_long, begin = part.row + n_long;
      MatrixXd own = columns_of(system, part, Eigen::seqN(begin, n_short)) + part.dF.bottomRows(n_short);
      ShortWaves& rim = short_waves_.emplace_back(ShortWaves{part.row, begin, part.row + n, {}, {}, {}});
      rim.block = matrices::Lu(own.rightCols(n_short));
      rim.by_long = rim.block.solve(own.leftCols(n_long));
      rim.on_kept = on_kept.rightCols(n_short);
      rim.on_kept.middleRows(column, n_long) += part.dF.topRightCorner(n_long, n_short);
      schur.noalias() -= rim.on_kept * rim.by_long;
    }
    column += n_long;
  }
  lu_ = matrices::Lu(schur_);
  is_singular_ = n_kept() > 0 && !(lu_.rcond() * std::min(1.0, lu_.norm()) > singular_tangent);
}

/// Let J = U s V^T, where columns L of U and R of V span the null spaces. The determinant of J + L R^T has the sign of
/// det U det V, and the product of the other eigenvalues of J has that sign times the sign of det L^T R.
bool TangentFactor::is_negative() const {
  const auto its = [](const ShortWaves& rim) { return rim.block.is_negative(); };
  bool negative = std::ranges::count_if(short_waves_, its) % 2 == 1;
  if (!is_singular_) return negative != lu_.is_negative();
  const NullSpace& null = null_space();
  return negative != (null.lifted.is_negative() != matrices::Lu(null.left.transpose() * null.right).is_negative());
}

MatrixXd TangentFactor::product(const MatrixXd& x) const {
  MatrixXd result = state_.product(&Response::dF, x);
  result.noalias() += system_.S_times(state_.product(&Response::ddelta, x));
  if (state_.Lambda.size() > 0) result.noalias() += system_.H * state_.friction_by(x);
  return result;
}

MatrixXd TangentFactor::solve(const MatrixXd& b) const { return refined(b, by_lu(), nearly_rounding, near_enough); }

VectorXd TangentFactor::step(const VectorXd& b, double wanted) const {
  constexpr double enough = 0.1;
  return refined(b, by_lu(), wanted, enough);
}

/// Finds the smallest singular values and their vectors by inverse iteration. There are at first a few more vectors
/// than directions in which fasteners are open, and then more until one of them is outside the null space, which takes
/// fewer operations than all singular values.
const TangentFactor::NullSpace& TangentFactor::null_space() const {
  if (null_space_) return *null_space_;
  const Index n = schur_.rows();
  constexpr double shift = 1e-12;  // makes a singular matrix regular
  constexpr int turns = 2, powers = 6;
  Index first = 8;
  for (std::size_t i = 0; i + system_.rim_sizes.size() < state_.parts.size(); ++i)
    first += (state_.parts[i].dF.array() == 0).rowwise().all().count();
  const double norm = lu_.norm();
  MatrixXd shifted = schur_;
  shifted.diagonal().array() += shift * (norm > 0 ? norm : 1);  // J is 0 if no fastener of floating sheets bears
  const matrices::Lu lu(std::move(shifted));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  VectorXd x = VectorXd::NullaryExpr(n, [&] { return normal(random); });
  double largest = 0;  // largest singular value, by power iteration
  for (int i = 0; i < powers && x.norm() > 0; ++i) {
    x.normalize();
    x = schur_.transpose() * (schur_ * x).eval();
    largest = std::sqrt(x.norm());
  }
  const double size = std::max(largest, 1.0), max_null = singular_tangent * size;
  NullSpace result;
  for (Index k = std::min<Index>(first, n);; k = std::min(2 * k, n)) {
    const MatrixXd start = MatrixXd::NullaryExpr(n, k, [&] { return normal(random); });
    MatrixXd right = matrices::orthonormal_basis(start), left = right;
    for (int i = 0; i < turns; ++i) {
      right = matrices::orthonormal_basis(lu.solve(lu.solve_transposed(right)));
      left = matrices::orthonormal_basis(lu.solve_transposed(lu.solve(left)));
    }
    const auto of_right = matrices::singular_values(schur_ * right);
    const auto of_left = matrices::singular_values(schur_.transpose() * left);
    const Index found = std::max<Index>(1, (of_right.values.array() <= max_null).count());
    if (found == k && k < n) continue;
    result.right = right * of_right.V.rightCols(found);
    result.left = left * of_left.V.rightCols(found);
    break;
  }
  MatrixXd lifted = schur_;
  lifted.noalias() += size * result.left * result.right.transpose();
  result.lifted = matrices::Lu(std::move(lifted));
  return null_space_.emplace(std::move(result));
}

MatrixXd TangentFactor::solve_singular(const MatrixXd& b) const {
  const NullSpace& null = null_space();
  const auto solve = [&](const MatrixXd& f) { return null.lifted.solve(f - null.left * (null.left.transpose() * f)); };
  return refined(b, solve, nearly_rounding, std::nullopt);
}

MatrixXd TangentFactor::estimate_transposed(const MatrixXd& b) const {
  const auto solve = [&](const MatrixXd& f) -> MatrixXd {
    if (!is_singular_) return lu_.solve_transposed(f);
    const NullSpace& null = null_space();
    const MatrixXd x = null.lifted.solve_transposed(f);
    return x - null.left * (null.left.transpose() * x);
  };
  return by_factor_transposed(unscaled(b), solve);
}

MatrixXd TangentFactor::refined(const MatrixXd& b, const Solve& by_schur, double wanted,
                                std::optional<double> enough) const {
  if (short_waves_.empty()) return unscaled(by_schur(b));
  constexpr int max_steps = 30;
  constexpr double falls = 0.5, of_product = 1e-16, of_product_enough = 1e-14;
  MatrixXd x = by_factor(b, by_schur), residual = b - product(x);
  // x is large if J is nearly singular, and then J x has rounding of its own.
  const auto is_within = [&](double of_b, double of_J) {
    return residual.norm() <= std::max(of_b * b.norm(), of_J * lu_.norm() * x.norm());
  };
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_steps && !is_within(wanted, of_product) && residual.norm() < falls * before; ++i) {
    before = residual.norm();
    x += by_factor(residual, by_schur);
    residual = b - product(x);
  }
  if (!enough || is_within(*enough, of_product_enough)) return unscaled(x);
  return unscaled(matrices::Lu(tangent(system_, state_)).solve(b));
}

MatrixXd TangentFactor::extended(const MatrixXd& kept) const {
  MatrixXd x(scale_.size(), kept.cols());
  x(kept_, Eigen::all) = kept;
  for (const auto& rim : short_waves_)
    x.middleRows(rim.first, rim.end - rim.first) =
        -(rim.by_long * x.middleRows(rim.first_long, rim.first - rim.first_long));
  return x;
}

MatrixXd TangentFactor::by_factor(const MatrixXd& b, const Solve& solve) const {
  MatrixXd x = b, rest = b(kept_, Eigen::all);
  for (const auto& rim : short_waves_) {
    auto its = x.middleRows(rim.first, rim.end - rim.first);
    its = rim.block.solve(its);
    rest -= rim.on_kept * its;
  }
  x(kept_, Eigen::all) = solve(rest);
  for (const auto& rim : short_waves_)
    x.middleRows(rim.first, rim.end - rim.first) -=
        rim.by_long * x.middleRows(rim.first_long, rim.first - rim.first_long);
  return x;
}

MatrixXd TangentFactor::by_factor_transposed(const MatrixXd& b, const Solve& solve) const {
  MatrixXd x = b;
  for (const auto& rim : short_waves_)
    x.middleRows(rim.first_long, rim.first - rim.first_long) -=
        rim.by_long.transpose() * b.middleRows(rim.first, rim.end - rim.first);
  const MatrixXd kept = solve(x(kept_, Eigen::all));
  x(kept_, Eigen::all) = kept;
  for (const auto& rim : short_waves_) {
    auto its = x.middleRows(rim.first, rim.end - rim.first);
    its -= rim.on_kept.transpose() * kept;
    its = rim.block.solve_transposed(its);
  }
  return x;
}

}  // namespace fastjoint::stage3
