// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/LU>
#include <map>
#include <optional>

#include "stage3_nonlinear/path/exact_path.hpp"

namespace fastjoint::stage3 {

/// A straight line of solutions in a cell: c = offset + t rate, where t is |lambda|, or at constant load a length.
struct Line {
  Eigen::VectorXd offset, rate;
  bool loads = true;  ///< t is |lambda|
};

/// Lines of solutions in the cells of a path. Neighbouring cells differ in the columns of a few planes, so that one
/// factor serves many of them (Woodbury's formula), as long as few columns have changed since, the matrix is far from
/// singular and the line balances to rounding; else the cell's own matrix is factorised.
class CellLines {
 public:
  /// @param joint Outlives this.
  /// @param q     Right-hand side of the equations at |lambda| = 1, (n).
  CellLines(const PiecewiseJoint& joint, Eigen::VectorXd q) : joint_(joint), q_(std::move(q)) {}

  /// The line in a cell; none if its matrix is singular.
  [[nodiscard]] std::optional<Line> in(const Cell& cell);
  /// Number of cells whose own matrix was factorised.
  [[nodiscard]] int n_factors() const { return n_factors_; }

 private:
  /// A cell with the factor of its matrix.
  struct Base {
    Cell cell;
    Eigen::PartialPivLU<Eigen::MatrixXd> lu;
    double stretch;  ///< least_stretch
    Line line;
    /// Column of each plane in the last cell in which it differed, and the solution for the difference.
    std::map<Eigen::Index, std::pair<CellColumn, CellColumn>> changes;
  };

  [[nodiscard]] std::optional<Line> from_base(const Cell& cell);

  const PiecewiseJoint& joint_;
  Eigen::VectorXd q_;
  std::optional<Base> base_;
  int n_factors_ = 0;
};

}  // namespace fastjoint::stage3
