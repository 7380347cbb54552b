// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/factor/plate_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/count.hpp"
#include "common/linalg/threads.hpp"
#include "stage1_plate/factor/element_solution.hpp"

namespace fastjoint::stage1 {
namespace {

/// Adds an element's matrix to a lower triangle whose pattern has room for it.
class SkeletonAssembler {
 public:
  explicit SkeletonAssembler(Eigen::SparseMatrix<double>& A) : A_(A) {}

  /// @param rows Of C's rows in the pattern, -1 to leave out; several may be one. @param C Its lower triangle counts.
  void add(const std::vector<int>& rows, const Eigen::VectorXd& sign, double scale,
           const Eigen::Ref<const Eigen::MatrixXd>& C) {
    order_.resize(rows.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::erase_if(order_, [&](int i) { return rows[i] < 0; });
    std::sort(order_.begin(), order_.end(), [&](int i, int j) { return rows[i] < rows[j]; });
    for (std::size_t c = 0; c < order_.size(); ++c) {
      const int j = order_[c];
      const int column = rows[j];
      const int* end = A_.innerIndexPtr() + A_.outerIndexPtr()[column + 1];
      const int* at = A_.innerIndexPtr() + A_.outerIndexPtr()[column];
      for (std::size_t r = c; r < order_.size(); ++r) {
        const int i = order_[r];
        const int row = rows[i];
        while (*at != row) at = at[1] == row ? at + 1 : std::lower_bound(at, end, row);
        const double value = scale * sign[i] * sign[j] * C(std::max(i, j), std::min(i, j));
        A_.valuePtr()[at - A_.innerIndexPtr()] += row == column && i != j ? 2 * value : value;
      }
    }
  }
  void add(int i, int j, double value) { A_.coeffRef(std::max(i, j), std::min(i, j)) += value; }

 private:
  Eigen::SparseMatrix<double>& A_;
  std::vector<int> order_;
};

double largest(const Eigen::SparseMatrix<double>& A) { return A.nonZeros() > 0 ? A.coeffs().abs().maxCoeff() : 0; }

}  // namespace

Eigen::VectorXd shift(const PlateProblem& problem) {
  return problem.K_cc.diagonal().unaryExpr([](double k) { return k > 0 ? k : 1; });
}

PlateFactor::PlateFactor(const PlateProblem& problem, const Skeleton& skeleton, int p)
    : problem_(problem), kinds_(problem.elements.kinds.size()), rows_(skeleton.rows(problem, p)) {
  linalg::for_each_index(kinds_.size(), [&](std::size_t i) {
    const ElementKind& kind = problem.elements.kinds[i];
    kinds_[i] = condense(kind, problem.elements.stiffness[kind.shape], problem.numbering, p);
  });
  const Eigen::SparseMatrix<double> A = skeleton_stiffness(skeleton);
  diagonal_ = A.diagonal();
  factor_ = std::make_unique<linalg::Cholesky>(A, rows_.n_border);
}

const CondensedElement& PlateFactor::condensed(int element) const { return kinds_[problem_.elements.kind[element]]; }

Eigen::SparseMatrix<double> PlateFactor::skeleton_stiffness(const Skeleton& skeleton) const {
  Eigen::SparseMatrix<double> A = skeleton.pattern(rows_);
  SkeletonAssembler assembler(A);
  const auto& numbering = problem_.numbering;
  const auto n_modes = numbering.function.rows();
  for (Eigen::Index element = 0; element < numbering.function.cols(); ++element) {
    const CondensedElement& K = condensed(static_cast<int>(element));
    std::vector<int> rows;
    Eigen::VectorXd sign = Eigen::VectorXd::Ones(K.matrix.n_outside());
    for (const int coefficient : K.outside) {
      sign[rows.size()] = numbering.sign(coefficient % n_modes, element);
      const auto place = Eigen::Index{2} * numbering.function(coefficient % n_modes, element) + coefficient / n_modes;
      rows.push_back(rows_.of_target(problem_.unknowns.target[place]));
    }
    for (const int column : border_of(problem_, static_cast<int>(element))) rows.push_back(rows_.n_skeleton + column);
    assembler.add(rows, sign, problem_.elements.scale[element], K.matrix.outside());
  }
  for (const auto& tie : problem_.ties) {
    const int plate = rows_.of_target(tie.target), disc = rows_.n_skeleton + tie.controlled;
    assembler.add(plate, plate, tie.stiffness);
    assembler.add(disc, disc, tie.stiffness);
    assembler.add(plate, disc, -tie.stiffness);
  }
  // The friction cases come last, so that their diagonal changes nothing before them; it must be large enough for a
  // factor, that is above L^T K^-1 L (docs/theory.md, section 4.4).
  const auto s = shift(problem_);
  const double L = largest(problem_.L_f), large = L > 0 ? 1e30 * L * L / s.maxCoeff() : 1;
  for (int i = 0; i < rows_.n_border; ++i)
    assembler.add(rows_.n_skeleton + i, rows_.n_skeleton + i, i < s.size() ? s[i] : large);
  return A;
}

Eigen::MatrixXd PlateFactor::energy_rows() const { return factor_->border(problem_.K_cc.cols()); }

double PlateFactor::rounding(const Eigen::VectorXd& u) const {
  double sum = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    if (const int row = rows_.of_unknown[i]; row >= 0) sum += diagonal_[row] * u[i] * u[i];
  return std::numeric_limits<double>::epsilon() * sum;
}

Eigen::MatrixXd PlateFactor::solve(const Eigen::MatrixXd& B) const {
  constexpr Eigen::Index block = 64;  // right-hand sides at a time: what an element has of them fits into the cache
  Eigen::MatrixXd X(B.rows(), B.cols());
  for (Eigen::Index first = 0; first < B.cols(); first += block) {
    const auto k = std::min(block, B.cols() - first);
    Eigen::MatrixXd skeleton = Eigen::MatrixXd::Zero(rows_.n_skeleton, k);
    for (Eigen::Index i = 0; i < B.rows(); ++i)
      if (const int row = rows_.of_unknown[i]; row >= 0) skeleton.row(row) = B.row(i).segment(first, k);
    std::vector<ElementSolution> elements;
    elements.reserve(problem_.elements.kind.size());
    for (int element = 0; element < count_of(problem_.elements.kind); ++element)
      elements.emplace_back(problem_, element, condensed(element), rows_);
    linalg::for_each_index(elements.size(), [&](std::size_t i) { elements[i].eliminate(B.middleCols(first, k)); });
    for (const auto& element : elements) element.add_to(skeleton);
    skeleton = factor_->solve(skeleton);
    linalg::for_each_index(elements.size(),
                           [&](std::size_t i) { elements[i].restore(skeleton, X.middleCols(first, k)); });
    for (Eigen::Index i = 0; i < X.rows(); ++i)
      if (const int row = rows_.of_unknown[i]; row >= 0) X.row(i).segment(first, k) = skeleton.row(row);
  }
  return X;
}

}  // namespace fastjoint::stage1
