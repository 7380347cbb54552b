// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage3_nonlinear/equations/tangent_factor.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace fastjoint::stage3 {
namespace {

/// Number of waves of a rim, from `first` on, up to the last that is coupled to unknowns outside the rim. The measure
/// is the product of both couplings over both diagonal entries, which is dimensionless.
Index n_long(const MatrixXd& J, const VectorXd& diagonal, Index first, Index size) {
  constexpr double max_coupling = 1e-4, not_zero = std::numeric_limits<double>::min();
  Eigen::ArrayXd coupling = Eigen::ArrayXd::Zero(size);
  const auto add = [&](Index begin, Index end) {  // column by column, as J is stored
    for (Index j = begin; j < end; ++j)
      coupling = coupling.max(
          (J.col(j).segment(first, size).array() * J.row(j).segment(first, size).transpose().array()).abs() /
          std::max(std::abs(diagonal[j]), not_zero));
  };
  add(0, first);
  add(first + size, J.cols());
  Index n = size;
  while (n > 0 && coupling[n - 1] <= max_coupling * std::abs(diagonal[first + n - 1])) --n;
  return n;
}

constexpr double factor_rounding = 1e-14, nearly_rounding = 1e-10;
constexpr double for_errors = 1e-11;  // enough for error bars, which need J^T

}  // namespace

TangentFactor::TangentFactor(MatrixXd J, const std::vector<Index>& rims)
    : J_(std::move(J)), norm_(J_.size() > 0 ? J_.cwiseAbs().colwise().sum().maxCoeff() : 0) {
  Index first = J_.rows() - std::accumulate(rims.begin(), rims.end(), Index{0});
  kept_.resize(first);
  std::iota(kept_.begin(), kept_.end(), Index{0});
  const VectorXd diagonal = J_.diagonal();
  std::vector<Index> columns;  // of `schur_`, at which the long waves of a rim with short ones begin
  for (const Index size : rims) {
    const Index n = n_long(J_, diagonal, first, size);
    if (n < size) {
      columns.push_back(std::ssize(kept_));
      short_waves_.push_back({first, first + n, first + size, {}, {}, {}});
    }
    for (Index i = 0; i < n; ++i) kept_.push_back(first + i);
    first += size;
  }
  schur_ = short_waves_.empty() ? J_ : MatrixXd(J_(kept_, kept_));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto& rim = short_waves_[i];
    const Index n = rim.end - rim.first, n_before = rim.first - rim.first_long;
    rim.block = matrices::Lu(J_.block(rim.first, rim.first, n, n));
    rim.by_long = rim.block.solve(J_.block(rim.first, rim.first_long, n, n_before));
    rim.on_kept = J_(kept_, Eigen::seqN(rim.first, n));
    schur_.middleCols(columns[i], n_before) -= rim.on_kept * rim.by_long;
  }
  lu_ = matrices::Lu(schur_);
}

MatrixXd TangentFactor::solve(const MatrixXd& b) const {
  const auto solve = [this](const MatrixXd& f) { return lu_.solve(f); };
  return refined(b, false, solve, factor_rounding, nearly_rounding);
}

VectorXd TangentFactor::step(const VectorXd& b) const {
  constexpr double wanted = 1e-6, enough = 1e-3;
  return refined(
      b, false, [this](const MatrixXd& f) { return lu_.solve(f); }, wanted, enough);
}

MatrixXd TangentFactor::solve_transposed(const MatrixXd& b) const {
  const auto solve = [this](const MatrixXd& f) { return lu_.solve_transposed(f); };
  return refined(b, true, solve, factor_rounding, nearly_rounding);
}

/// Finds the smallest singular values and their vectors by inverse iteration. The number of vectors grows until one of
/// them is outside the null space, which takes fewer operations than all singular values.
const TangentFactor::NullSpace& TangentFactor::null_space() const {
  if (null_space_) return *null_space_;
  const Index n = schur_.rows();
  constexpr double shift = 1e-12;  // makes a singular matrix regular
  constexpr int turns = 3, first = 8;
  const double norm = lu_.norm();
  MatrixXd shifted = schur_;
  shifted.diagonal().array() += shift * (norm > 0 ? norm : 1);  // J is 0 if no fastener of floating sheets bears
  const matrices::Lu lu(std::move(shifted));
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  VectorXd x = VectorXd::NullaryExpr(n, [&] { return normal(random); });
  double largest = 0;  // largest singular value, by power iteration
  for (int i = 0; i < 2 * turns && x.norm() > 0; ++i) {
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
  return refined(b, false, solve, factor_rounding, std::nullopt);
}

MatrixXd TangentFactor::solve_singular_transposed(const MatrixXd& b) const {
  const NullSpace& null = null_space();
  const auto solve = [&](const MatrixXd& f) -> MatrixXd {
    const MatrixXd x = null.lifted.solve_transposed(f);
    return x - null.left * (null.left.transpose() * x);
  };
  return refined(b, true, solve, for_errors, std::nullopt);
}

MatrixXd TangentFactor::refined(const MatrixXd& b, bool transposed, const Solve& by_schur, double wanted,
                                std::optional<double> enough) const {
  if (short_waves_.empty()) return by_schur(b);
  constexpr int max_steps = 8;
  constexpr double falls = 0.5, of_product = 1e-16, of_product_enough = 1e-14;
  const auto solve = [&](const MatrixXd& f) {
    return transposed ? by_factor_transposed(f, by_schur) : by_factor(f, by_schur);
  };
  const auto residual_of = [&](const MatrixXd& its) -> MatrixXd {
    if (transposed) return b - J_.transpose() * its;
    return b - J_ * its;
  };
  MatrixXd x = solve(b), residual = residual_of(x);
  // x is large if J is nearly singular, and then J x has rounding of its own.
  const auto is_within = [&](double of_b, double of_J) {
    return residual.norm() <= std::max(of_b * b.norm(), of_J * norm_ * x.norm());
  };
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_steps && !is_within(wanted, of_product) && residual.norm() < falls * before; ++i) {
    before = residual.norm();
    x += solve(residual);
    residual = residual_of(x);
  }
  if (!enough || is_within(*enough, of_product_enough)) return x;
  const matrices::Lu whole(J_);
  return transposed ? whole.solve_transposed(b) : whole.solve(b);
}

MatrixXd TangentFactor::extended(const MatrixXd& kept) const {
  MatrixXd x(J_.cols(), kept.cols());
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
