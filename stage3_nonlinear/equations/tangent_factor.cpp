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

/// Refines a solution iteratively until the residual is rounding or does not fall any more.
/// @param norm 1-norm of J: x is large if J is nearly singular, and then J x has rounding of its own.
/// @param wanted Residual over b.
template <typename Solve, typename Matrix>
MatrixXd corrected(const Solve& solve, const Matrix& J, double norm, const MatrixXd& b, double wanted) {
  constexpr int max_steps = 8;
  constexpr double of_product = 1e-16, falls = 0.5;
  MatrixXd x = solve(b), residual = b - J * x;
  double before = std::numeric_limits<double>::infinity();
  const auto is_left = [&] { return residual.norm() > std::max(wanted * b.norm(), of_product * norm * x.norm()); };
  for (int i = 0; i < max_steps && is_left() && residual.norm() < falls * before; ++i) {
    before = residual.norm();
    x += solve(residual);
    residual = b - J * x;
  }
  return x;
}

/// The same, or the solution by a factor of the whole matrix if the residual has not become small.
template <typename Solve, typename Matrix>
MatrixXd surely_corrected(const Solve& solve, const Matrix& J, double norm, const MatrixXd& b, double wanted,
                          double enough) {
  constexpr double of_product = 1e-14;
  MatrixXd x = corrected(solve, J, norm, b, wanted);
  if ((b - J * x).norm() <= std::max(enough * b.norm(), of_product * norm * x.norm())) return x;
  return matrices::Lu(J).solve(b);
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

double TangentFactor::rcond() const { return lu_.rcond() * std::min(1.0, lu_.norm()); }

MatrixXd TangentFactor::solve(const MatrixXd& b) const {
  if (short_waves_.empty()) return lu_.solve(b);
  const auto solve = [this](const MatrixXd& f) -> MatrixXd { return lu_.solve(f); };
  return surely_corrected([&](const MatrixXd& f) { return by_factor(f, solve); }, J_, norm_, b, factor_rounding,
                          nearly_rounding);
}

VectorXd TangentFactor::step(const VectorXd& b) const {
  if (short_waves_.empty()) return lu_.solve(b);
  constexpr double wanted = 1e-6, enough = 1e-3;
  const auto solve = [this](const MatrixXd& f) -> MatrixXd { return lu_.solve(f); };
  return surely_corrected([&](const MatrixXd& f) { return by_factor(f, solve); }, J_, norm_, b, wanted, enough);
}

MatrixXd TangentFactor::solve_transposed(const MatrixXd& b) const {
  if (short_waves_.empty()) return lu_.solve_transposed(b);
  const auto solve = [this](const MatrixXd& f) -> MatrixXd { return lu_.solve_transposed(f); };
  return surely_corrected([&](const MatrixXd& f) { return by_factor_transposed(f, solve); }, J_.transpose(), norm_, b,
                          factor_rounding, nearly_rounding);
}

/// Finds the smallest singular values and their vectors by inverse iteration. The number of vectors grows until one of
/// them is outside the null space, which takes fewer operations than all singular values.
TangentFactor::NullSpace TangentFactor::find_null_space(double tolerance) const {
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
  const double size = std::max(largest, 1.0), max_null = tolerance * size;
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
  return result;
}

const TangentFactor::NullSpace& TangentFactor::null_space(double tolerance) const {
  const auto known = null_spaces_.find(tolerance);
  return known != null_spaces_.end() ? known->second
                                     : null_spaces_.emplace(tolerance, find_null_space(tolerance)).first->second;
}

MatrixXd TangentFactor::free_motions(double tolerance) const { return extended(null_space(tolerance).right); }

TangentFactor::Singular TangentFactor::solve_singular(const MatrixXd& b, double tolerance) const {
  const NullSpace& null = null_space(tolerance);
  const auto solve = [&](const MatrixXd& f) -> MatrixXd {
    return null.lifted.solve(f - null.left * (null.left.transpose() * f));
  };
  const MatrixXd free = extended(null.right);
  if (short_waves_.empty()) return {solve(b), free};
  return {corrected([&](const MatrixXd& f) { return by_factor(f, solve); }, J_, norm_, b, factor_rounding), free};
}

TangentFactor::Singular TangentFactor::solve_singular_transposed(const MatrixXd& b, double tolerance) const {
  const NullSpace& null = null_space(tolerance);
  const auto solve = [&](const MatrixXd& f) -> MatrixXd {
    const MatrixXd x = null.lifted.solve_transposed(f);
    return x - null.left * (null.left.transpose() * x);
  };
  const MatrixXd free = extended(null.right);
  if (short_waves_.empty()) return {solve(b), free};
  return {corrected([&](const MatrixXd& f) { return by_factor_transposed(f, solve); }, J_.transpose(), norm_, b,
                    for_errors),
          free};
}

MatrixXd TangentFactor::extended(const MatrixXd& kept) const {
  MatrixXd x(J_.cols(), kept.cols());
  x(kept_, Eigen::all) = kept;
  for (const auto& rim : short_waves_)
    x.middleRows(rim.first, rim.end - rim.first) =
        -(rim.by_long * x.middleRows(rim.first_long, rim.first - rim.first_long));
  return x;
}

template <typename Solve>
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

template <typename Solve>
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
