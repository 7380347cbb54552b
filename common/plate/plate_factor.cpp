// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/plate/plate_factor.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "common/count.hpp"
#include "common/linalg/processor.hpp"

namespace fastjoint::plate {
namespace {

/// Adds the terms of a rim to the lower triangle of M.
/// @param row Row of each degree of freedom of the element, -1 for those above the degree.
/// @param first_border Row of the first disc of the rim's hole.
void add_rim(const ElementClass::RimSide& rim, const std::vector<int>& row, Eigen::Index first_border,
             Eigen::MatrixXd& M) {
  const RimTerms& terms = rim.terms;
  const Eigen::Index n_modes = std::ssize(row) / 2;
  const Eigen::Index n = terms.modes.size();
  const auto n_discs = terms.coupling.cols(), n_waves = terms.waves.cols();
  const auto disc = first_border, wave = disc + n_discs, friction = wave + n_waves;
  const auto row_of = [&](Eigen::Index i) { return row[(i < n ? 0 : n_modes) + terms.modes[i % n]]; };
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    if (row_of(i) < 0) continue;
    for (Eigen::Index j = 0; j <= i; ++j)
      if (row_of(j) >= 0) M(std::max(row_of(i), row_of(j)), std::min(row_of(i), row_of(j))) += terms.plate(i, j);
    M.col(row_of(i)).segment(disc, n_discs) += terms.coupling.row(i).transpose();
    M.col(row_of(i)).segment(wave, n_waves) -= terms.waves.row(i).transpose();
    M.col(row_of(i)).segment(friction, terms.friction.cols()) -= terms.friction.row(i).transpose();
  }
  M.block(disc, disc, n_discs, n_discs) += terms.disc;
  M.block(wave, disc, n_waves, n_discs) += terms.reaction.transpose();
}

/// Adds element matrices to a lower triangle with a fixed pattern.
class SkeletonAssembler {
 public:
  explicit SkeletonAssembler(Eigen::SparseMatrix<double>& A) : A_(A) {}

  /// @param rows Row of the pattern for each row of C, -1 to omit it; rows may repeat. @param C Its lower triangle is
  /// read.
  void add(const std::vector<int>& rows, const Eigen::VectorXd& sign, double scale,
           const Eigen::Ref<const Eigen::MatrixXd>& C) {
    order_.resize(rows.size());
    std::iota(order_.begin(), order_.end(), 0);
    std::erase_if(order_, [&](int i) { return rows[i] < 0; });
    std::sort(order_.begin(), order_.end(), [&](int i, int j) { return rows[i] < rows[j]; });
    for (int c = 0; c < count_of(order_); ++c) {
      const int j = order_[c];
      const int column = rows[j];
      const int* end = A_.innerIndexPtr() + A_.outerIndexPtr()[column + 1];
      const int* at = A_.innerIndexPtr() + A_.outerIndexPtr()[column];
      for (int r = c; r < count_of(order_); ++r) {
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

/// Reduction of a diagonal entry by the elimination of an element's interior.
double reduction_of_diagonal(const std::vector<int>& rows, const Eigen::VectorXd& sign, int row,
                             const linalg::Condensed& matrix) {
  Eigen::RowVectorXd x = Eigen::RowVectorXd::Zero(matrix.n_interior());
  for (int i = 0; i < count_of(rows); ++i)
    if (rows[i] == row) x += sign[i] * matrix.X().row(i);
  return x.squaredNorm();
}

}  // namespace

CondensedElement condense(const ElementClass& elements, const Eigen::MatrixXd& K, const pfem::Numbering& numbering,
                          int p) {
  CondensedElement element{{}, {}, 0, {}};
  const int n_modes = count_of(elements.kept);
  for (int mode = 0; mode < n_modes; ++mode) {
    if (numbering.function(mode, elements.first) >= numbering.n_functions[p]) continue;
    auto& list = elements.kept[mode] ? element.boundary : element.interior;
    list.insert(list.end(), {mode, n_modes + mode});
  }
  std::map<int, Eigen::Index> border_of;  // by hole
  for (const auto& [hole, terms] : elements.rims)
    border_of[hole] = terms.coupling.cols() + terms.waves.cols() + terms.friction.cols();
  for (auto& [hole, width] : border_of) element.n_border += std::exchange(width, element.n_border);
  std::vector<int> order = element.interior, row(std::size_t{2} * n_modes, -1);
  order.insert(order.end(), element.boundary.begin(), element.boundary.end());
  const Eigen::Index n = order.size();
  for (int i = 0; i < n; ++i) row[order[i]] = i;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + element.n_border, n + element.n_border);
  M.topLeftCorner(n, n) = elements.thickness * K(order, order);
  for (const auto& rim : elements.rims) add_rim(rim, row, n + border_of[rim.hole], M);
  element.matrix = {std::move(M), std::ssize(element.interior)};
  return element;
}

FactorBytes factor_bytes(const PlateStiffness& plate, const Skeleton& skeleton, int p) {
  constexpr double number = sizeof(double), entry = sizeof(double) + sizeof(int);
  const auto square = [](double n) { return n * n; };
  const auto& function = plate.numbering.function;
  const double elements = count_of(plate.elements.congruent.first) * square(2.0 * double(function.rows()));
  double condensed = 0;
  for (const auto& each : plate.elements.classes)
    condensed += square(2.0 * double((function.col(each.first).array() < plate.numbering.n_functions[p]).count()) +
                        double(plate.unknowns.border_of(plate.elements.holes[each.first]).size()));
  auto rows = skeleton.rows(plate, p, plate.unknowns.n_border());
  const auto bordered = skeleton.size(rows);
  std::fill(rows.first.end() - rows.n_border - 1, rows.first.end(), rows.n_skeleton);
  const auto size = skeleton.size(rows);
  return {number * elements, number * condensed,
          entry * (bordered.entries + size.entries) + number * (size.factor + size.largest_front),
          number * bordered.elimination};
}

PlateFactor::PlateFactor(const PlateStiffness& plate, const Skeleton& skeleton, int p, bool with_other_waves)
    : plate_(plate),
      classes_(plate.elements.classes.size()),
      rows_(skeleton.rows(plate, p, with_other_waves ? plate.unknowns.n_border() : plate.unknowns.n_prescribed())) {
  linalg::for_each_index(classes_.size(), [&](std::size_t i) {
    const ElementClass& elements = plate.elements.classes[i];
    classes_[i] = condense(elements, plate.elements.stiffness[elements.congruent], plate.numbering, p);
  });
  const Eigen::SparseMatrix<double> A = bordered_stiffness(skeleton);
  const int n_controlled = plate.unknowns.n_controlled();
  coupling_ = A.bottomLeftCorner(rows_.n_border, rows_.n_skeleton);
  const Eigen::SparseMatrix<double> lower = A.bottomRightCorner(rows_.n_border, rows_.n_border);
  border_ = Eigen::SparseMatrix<double>(lower.selfadjointView<Eigen::Lower>());
  diagonal_of_K_cc_ += lower.diagonal().head(n_controlled);
  diagonal_ = A.diagonal().head(rows_.n_skeleton);
  factor_ = std::make_unique<linalg::Cholesky>(A, rows_.n_skeleton);
}

const CondensedElement& PlateFactor::element(int element) const { return classes_[plate_.elements.class_of[element]]; }

PlateFactor::ElementRows PlateFactor::rows_of(int element) const {
  const CondensedElement& K = this->element(element);
  const auto dofs = pfem::element_dofs(plate_.numbering, plate_.unknowns.dofs, element);
  ElementRows rows{{}, Eigen::VectorXd::Ones(K.matrix.n_boundary())};
  rows.sign.head(K.boundary.size()) = dofs.sign(K.boundary);
  for (const int i : K.boundary) rows.row.push_back(rows_.of_dof(dofs.dof[i]));
  for (const int column : plate_.unknowns.border_of(plate_.elements.holes[element]))
    rows.row.push_back(column < rows_.n_border ? rows_.n_skeleton + column : -1);
  return rows;
}

CondensedFunctions PlateFactor::condense_functions(int element, const Eigen::MatrixXd& weights) const {
  const CondensedElement& K = this->element(element);
  CondensedFunctions result{element, weights(K.interior, Eigen::all),
                            Eigen::MatrixXd::Zero(K.matrix.n_boundary(), weights.cols())};
  result.boundary.topRows(K.boundary.size()) = weights(K.boundary, Eigen::all);
  K.matrix.eliminate(result.interior, result.boundary);
  return result;
}

Eigen::SparseMatrix<double> PlateFactor::bordered_stiffness(const Skeleton& skeleton) {
  Eigen::SparseMatrix<double> A = skeleton.pattern(rows_);
  SkeletonAssembler assembler(A);
  diagonal_of_K_cc_ = Eigen::VectorXd::Zero(plate_.unknowns.n_controlled());
  for (int element = 0; element < count_of(plate_.elements.class_of); ++element) {
    const CondensedElement& K = this->element(element);
    const auto [rows, sign] = rows_of(element);
    const double scale = plate_.elements.scale[element];
    assembler.add(rows, sign, scale, K.matrix.schur_complement());
    for (const int row : std::set<int>(rows.begin(), rows.end()))
      if (const auto i = row - rows_.n_skeleton; i >= 0 && i < diagonal_of_K_cc_.size())
        diagonal_of_K_cc_[i] += scale * reduction_of_diagonal(rows, sign, row, K.matrix);
  }
  for (const auto& tie : plate_.ties) {
    const int vertex = rows_.of_dof(plate_.unknowns.dof_of(tie));
    const int disc = rows_.n_skeleton + plate_.unknowns.controlled_of_disc(tie.disc);
    assembler.add(vertex, vertex, tie.stiffness);
    assembler.add(disc, disc, tie.stiffness);
    assembler.add(vertex, disc, -tie.stiffness);
  }
  return A;
}

Eigen::MatrixXd PlateFactor::condensed(const Functions& functions) const {
  constexpr double rounding = 1e-12;
  const Eigen::Index n = rows_.n_border, n_prescribed = plate_.unknowns.n_prescribed(), nc = diagonal_of_K_cc_.size();
  std::vector<Eigen::Triplet<double>> on_skeleton, on_border;
  for (int i = 0; i < count_of(functions); ++i)
    for (const auto& part : functions[i]) {
      const auto [row, sign] = rows_of(part.element);
      for (int k = 0; k < count_of(row); ++k) {
        const double weight = sign[k] * part.boundary.row(k).sum();
        if (row[k] >= rows_.n_skeleton)
          on_border.emplace_back(i, row[k] - rows_.n_skeleton, weight);
        else if (row[k] >= 0)
          on_skeleton.emplace_back(n + i, row[k], weight);
      }
    }
  for (int column = 0; column < coupling_.outerSize(); ++column)
    for (Eigen::SparseMatrix<double>::InnerIterator entry(coupling_, column); entry; ++entry)
      on_skeleton.emplace_back(entry.row(), column, entry.value());
  Eigen::SparseMatrix<double> coupling(n + count_of(functions), rows_.n_skeleton), direct(count_of(functions), n);
  coupling.setFromTriplets(on_skeleton.begin(), on_skeleton.end());
  direct.setFromTriplets(on_border.begin(), on_border.end());
  std::vector<Eigen::Triplet<double>>().swap(on_skeleton);  // frees memory before the elimination, which needs it
  Eigen::MatrixXd forces(coupling.rows(), n_prescribed);
  forces << Eigen::MatrixXd(border_.leftCols(n_prescribed)), Eigen::MatrixXd(direct.leftCols(n_prescribed));
  forces -= factor_->products(coupling, n_prescribed).transpose();
  auto square = forces.topRows(n_prescribed);
  square.triangularView<Eigen::StrictlyUpper>() = square.transpose();  // the products are symmetric up to rounding
  auto S = forces.topLeftCorner(nc, nc);
  if (nc > 0 && S.cwiseAbs().maxCoeff() < rounding * diagonal_of_K_cc_.maxCoeff()) S.setZero();
  return forces;
}

}  // namespace fastjoint::plate
