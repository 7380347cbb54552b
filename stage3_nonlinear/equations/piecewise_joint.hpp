// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// The curve of a shear plane between corners, over all of its coordinate c: odd or one-sided.
struct CornerCurve {
  std::vector<double> corners;  ///< (m) ascending, force
  /// Lines of the m + 1 pieces: F = F0 + dF c and delta = delta0 + ddelta c.
  Eigen::VectorXd F0, dF, delta0, ddelta;
  Eigen::VectorXi sign;  ///< of c in each piece

  [[nodiscard]] std::size_t piece_of(double c) const;
};

/// A cell of the piecewise linear equations: the piece of every plane's curve and the side that bears of every rim.
struct Cell {
  std::vector<std::size_t> piece;  ///< (n) of each plane's curve
  std::vector<int> side;           ///< (f) 1 or -1: of each rim that friction acts on, the side that bears
};

/// The equations in a cell: J c + offset = lambda q.
struct CellEquations {
  Eigen::MatrixXd J;
  Eigen::VectorXd offset;
};

/// The equations of a joint with one direction whose laws are all linear between corners: piecewise linear in
/// (c, lambda), also with friction, whose pieces end where the force b on a rim changes its sign.
class PiecewiseJoint {
 public:
  /// @param equations is_piecewise_linear; outlives this.
  explicit PiecewiseJoint(const JointEquations& equations);

  [[nodiscard]] const CornerCurve& curve(std::size_t plane) const { return curves_[plane]; }
  [[nodiscard]] std::size_t n_planes() const { return curves_.size(); }
  /// Rims that two planes share: their side depends on both. That of all others goes with the plane's sign of c.
  [[nodiscard]] const std::vector<Eigen::Index>& shared_rims() const { return shared_rims_; }
  /// The cell at no load, c = 0.
  [[nodiscard]] Cell start() const;
  [[nodiscard]] CellEquations equations(const Cell& cell) const;
  /// Bearing force b on a rim, linear in c: value at c and change along `rate`.
  [[nodiscard]] double rim_force(const Cell& cell, Eigen::Index rim, const Eigen::VectorXd& c) const;
  [[nodiscard]] double rim_rate(const Cell& cell, Eigen::Index rim, const Eigen::VectorXd& rate) const;
  /// Sets the sides of the rims that one plane alone bears on.
  void follow_signs(Cell& cell) const;

 private:
  /// A rim that friction acts on: b = sum of signs times F of its one or two planes.
  struct Rim {
    Eigen::Index at;  ///< row of E
    std::vector<std::pair<Eigen::Index, double>> planes;
  };
  const CondensedSystem* system_;
  std::vector<CornerCurve> curves_;
  std::vector<Rim> rims_;
  std::vector<Eigen::Index> shared_rims_;
};

/// True if all discs have one direction and all laws are linear between corners.
[[nodiscard]] bool is_piecewise_linear(const JointEquations& equations);

}  // namespace fastjoint::stage3
