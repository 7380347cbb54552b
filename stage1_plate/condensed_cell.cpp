// SPDX-License-Identifier: GPL-3.0-or-later
#include "stage1_plate/condensed_cell.hpp"

#include "common/pfem/shape_functions.hpp"

namespace fastjoint::stage1 {
namespace {

/// Coefficients of some modes: all of u_x, then all of u_y.
std::vector<int> coefficients(const std::vector<int>& modes, int n_modes) {
  std::vector<int> list = modes;
  for (const int mode : modes) list.push_back(n_modes + mode);
  return list;
}

/// Sums a cell's matrix: inside, outside, border.
class CellMatrix {
 public:
  CellMatrix(const CellShape& shape, const CondensedCell& cell, int p)
      : shape_(shape), p_(p), row_(2 * shape.kept.size(), -1), first_border_(0) {
    for (const auto* list : {&cell.inside, &cell.outside})
      for (const int coefficient : *list) row_[static_cast<std::size_t>(coefficient)] = first_border_++;
    M_.setZero(first_border_ + cell.n_border, first_border_ + cell.n_border);
  }

  void add_element(Eigen::Index element, const std::vector<int>& modes, const linalg::Condensed& K) {
    const auto rows = rows_of(element, modes);
    const Eigen::VectorXd sign = signs_of(element, modes) * std::sqrt(shape_.thickness[element]);
    const auto C = K.outside();
    for (Eigen::Index j = 0; j < C.cols(); ++j)
      for (Eigen::Index i = j; i < C.rows(); ++i)
        add(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)], sign[i] * sign[j] * C(i, j));
  }

  void add_rim(const CellShape::RimSide& rim) {
    const RimTerms& terms = rim.terms;
    const auto rows = rows_of(rim.element, terms.modes);
    const Eigen::VectorXd sign = signs_of(rim.element, terms.modes);
    const auto n_discs = terms.coupling.cols();
    const int disc = first_border_ + rim.hole * static_cast<int>(3 * n_discs);
    const int friction = disc + static_cast<int>(n_discs);
    for (Eigen::Index i = 0; i < sign.size(); ++i) {
      const int row = rows[static_cast<std::size_t>(i)];
      if (row < 0) continue;
      for (Eigen::Index j = 0; j <= i; ++j)
        add(row, rows[static_cast<std::size_t>(j)], sign[i] * sign[j] * terms.plate(i, j));
      for (int a = 0; a < n_discs; ++a) M_(disc + a, row) += sign[i] * terms.coupling(i, a);
      for (int c = 0; c < 2 * n_discs; ++c) M_(friction + c, row) -= sign[i] * terms.friction(i, c);
    }
    M_.block(disc, disc, n_discs, n_discs) += terms.disc;
  }

  Eigen::MatrixXd take() { return std::move(M_); }

 private:
  void add(int i, int j, double value) {
    if (i >= 0 && j >= 0) M_(std::max(i, j), std::min(i, j)) += value;
  }

  /// Of modes beyond degree p: -1.
  [[nodiscard]] std::vector<int> rows_of(Eigen::Index element, const std::vector<int>& modes) const {
    std::vector<int> rows;
    for (int component = 0; component < 2; ++component)
      for (const int mode : modes) {
        const int function = shape_.numbering.function(mode, element);
        rows.push_back(function < shape_.numbering.n_functions[static_cast<std::size_t>(p_)]
                           ? row_[static_cast<std::size_t>(2 * function + component)]
                           : -1);
      }
    return rows;
  }

  [[nodiscard]] Eigen::VectorXd signs_of(Eigen::Index element, const std::vector<int>& modes) const {
    const Eigen::VectorXd sign = shape_.numbering.sign(modes, element);
    return sign.replicate(2, 1);
  }

  const CellShape& shape_;
  int p_;
  std::vector<int> row_;  ///< of each coefficient, -1 inside an element
  int first_border_;
  Eigen::MatrixXd M_;  ///< lower triangle
};

}  // namespace

ElementModes modes_up_to(int p, const pfem::Numbering& numbering) {
  ElementModes list;
  const auto modes = pfem::modes(numbering.space, numbering.p);
  const int first_interior = pfem::edge_mode(numbering.p, pfem::n_local_edges, 2);
  for (int m = 0; m < static_cast<int>(modes.size()); ++m)
    if (modes[static_cast<std::size_t>(m)].degree <= p) (m < first_interior ? list.outer : list.interior).push_back(m);
  return list;
}

linalg::Condensed condense_element(const Eigen::MatrixXd& K, const ElementModes& modes) {
  const int n_modes = static_cast<int>(K.rows()) / 2;
  std::vector<int> order = coefficients(modes.interior, n_modes);
  const auto n_interior = static_cast<Eigen::Index>(order.size());
  const auto outer = coefficients(modes.outer, n_modes);
  order.insert(order.end(), outer.begin(), outer.end());
  return {K(order, order), n_interior};
}

CondensedCell condense_cell(const CellShape& shape, const std::vector<linalg::Condensed>& elements,
                            const ElementModes& modes, int p) {
  CondensedCell cell{{}, {}, 0, {}};
  for (int function = 0; function < shape.numbering.n_functions[static_cast<std::size_t>(p)]; ++function) {
    const auto f = static_cast<std::size_t>(function);
    if (shape.interior[f]) continue;
    auto& list = shape.kept[f] ? cell.outside : cell.inside;
    list.insert(list.end(), {2 * function, 2 * function + 1});
  }
  for (const auto& rim : shape.rims)
    cell.n_border = std::max(cell.n_border, (rim.hole + 1) * static_cast<int>(3 * rim.terms.coupling.cols()));
  CellMatrix matrix(shape, cell, p);
  for (std::size_t i = 0; i < shape.element_shape.size(); ++i)
    matrix.add_element(static_cast<Eigen::Index>(i), modes.outer,
                       elements[static_cast<std::size_t>(shape.element_shape[i])]);
  for (const auto& rim : shape.rims) matrix.add_rim(rim);
  cell.matrix = {matrix.take(), static_cast<Eigen::Index>(cell.inside.size())};
  return cell;
}

}  // namespace fastjoint::stage1
