// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/factor/condensed_element.hpp"

#include <algorithm>

#include "common/count.hpp"

namespace fastjoint::stage1 {
namespace {

/// Adds what a rim brings to the lower triangle of M.
/// @param row Row of each degree of freedom of the element, -1 for those of higher degrees.
void add_rim(const ElementClass::RimSide& rim, const std::vector<int>& row, Eigen::Index first_border,
             Eigen::MatrixXd& M) {
  const RimTerms& terms = rim.terms;
  const Eigen::Index n_modes = std::ssize(row) / 2;
  const Eigen::Index n = terms.modes.size();
  const auto n_discs = terms.coupling.cols();
  const auto disc = first_border + 3 * n_discs * rim.hole;
  const auto row_of = [&](Eigen::Index i) { return row[(i < n ? 0 : n_modes) + terms.modes[i % n]]; };
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    if (row_of(i) < 0) continue;
    for (Eigen::Index j = 0; j <= i; ++j)
      if (row_of(j) >= 0) M(std::max(row_of(i), row_of(j)), std::min(row_of(i), row_of(j))) += terms.plate(i, j);
    M.col(row_of(i)).segment(disc, n_discs) += terms.coupling.row(i).transpose();
    M.col(row_of(i)).segment(disc + n_discs, 2 * n_discs) -= terms.friction.row(i).transpose();
  }
  M.block(disc, disc, n_discs, n_discs) += terms.disc;
}

}  // namespace

CondensedElement condense(const ElementClass& elements, const Eigen::MatrixXd& K, const pfem::Numbering& numbering,
                          int p) {
  CondensedElement element{{}, {}, 0, {}};
  const int n_modes = count_of(elements.kept);
  for (int mode = 0; mode < n_modes; ++mode) {
    if (numbering.function(mode, elements.first) >= numbering.n_functions[p]) continue;
    auto& list = elements.kept[mode] ? element.outside : element.inside;
    list.insert(list.end(), {mode, n_modes + mode});
  }
  for (const auto& rim : elements.rims)
    element.n_border = std::max(element.n_border, (rim.hole + 1) * 3 * rim.terms.coupling.cols());
  std::vector<int> order = element.inside, row(2 * n_modes, -1);
  order.insert(order.end(), element.outside.begin(), element.outside.end());
  const Eigen::Index n = order.size();
  for (int i = 0; i < n; ++i) row[order[i]] = i;
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(n + element.n_border, n + element.n_border);
  M.topLeftCorner(n, n) = elements.thickness * K(order, order);
  for (const auto& rim : elements.rims) add_rim(rim, row, n, M);
  element.matrix = {std::move(M), std::ssize(element.inside)};
  return element;
}

}  // namespace fastjoint::stage1
