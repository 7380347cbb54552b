// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Lines of a piece of a curve: F = F0 + dF c and delta = delta0 + ddelta c.
struct CurvePiece {
  double F0, dF, delta0, ddelta;
  int sign;  ///< of c
};

/// The curve of a shear plane between corners, over all of its coordinate c: odd or one-sided.
struct CornerCurve {
  std::vector<double> corners;     ///< (m) ascending, force
  std::vector<CurvePiece> pieces;  ///< (m + 1)
};

/// A cell of the piecewise linear equations: the piece of every plane's curve and the side that bears of every rim.
struct Cell {
  std::vector<Index> piece;  ///< (n) of each plane's curve
  std::vector<int> side;     ///< (f) 1 or -1: of each rim that friction acts on, the side that bears
};

/// The equations in a cell: J c + offset = lambda q.
struct CellEquations {
  MatrixXd J;
  VectorXd offset;
};

/// The equations of a joint with one direction whose laws are all linear between corners: piecewise linear in
/// (c, lambda), also with friction, whose pieces end where the force b on a rim changes its sign.
class PiecewiseJoint {
 public:
  /// @param equations is_piecewise_linear; outlives this.
  explicit PiecewiseJoint(const JointEquations& equations);

  [[nodiscard]] const CornerCurve& curve(Index plane) const { return curves_[plane]; }
  [[nodiscard]] Index n_planes() const { return curves_.size(); }
  /// Rims that two planes share: their side depends on both. That of all others goes with the plane's sign of c.
  [[nodiscard]] const std::vector<Index>& shared_rims() const { return shared_rims_; }
  /// The cell at no load, c = 0.
  [[nodiscard]] Cell start() const;
  [[nodiscard]] CellEquations equations(const Cell& cell) const;
  /// Bearing force b on a rim, linear in c: of c and a share of what it is at c = 0.
  [[nodiscard]] double rim_force(const Cell& cell, Index rim, const VectorXd& c, double share) const;
  /// Sets the sides of the rims that one plane alone bears on.
  void follow_signs(Cell& cell) const;

 private:
  /// One or two planes of a rim that friction acts on, and their signs: b is the sum of signs times F.
  using Rim = std::vector<std::pair<Index, double>>;
  [[nodiscard]] const CurvePiece& piece(const Cell& cell, Index plane) const {
    return curves_[plane].pieces[cell.piece[plane]];
  }
  /// Forces of friction on the planes per force b on a rim, on the side that bears, (n).
  [[nodiscard]] VectorXd friction(const Cell& cell, Index rim) const {
    return cell.side[rim] > 0 ? H_plus_.col(rim) : H_minus_.col(rim);
  }
  const CondensedSystem* system_;
  MatrixXd H_plus_, H_minus_;  ///< (n, f) forces of friction per force on a rim, by the side that bears
  std::vector<CornerCurve> curves_;
  std::vector<Rim> rims_;  ///< (f) rows of E
  std::vector<Index> shared_rims_;
};

/// True if all discs have one direction and all laws are linear between corners.
[[nodiscard]] bool is_piecewise_linear(const JointEquations& equations);

/// A straight line of solutions in a cell: c = offset + t rate, where t is |lambda|, or at constant load a length.
struct Line {
  VectorXd offset, rate;
  bool loads = true;  ///< t is |lambda|
};

/// Load factors between which nothing happens: c = offset + |lambda| rate.
struct PathPiece {
  double begin, end;      ///< |lambda|
  VectorXd offset, rate;  ///< (n) force
};

/// The path of a joint from no load on, for load factors of one sign.
struct ExactPath {
  double sign = 1;                ///< of the load factors
  std::vector<PathPiece> pieces;  ///< from |lambda| = 0 on, each from the end of the one before

  /// Largest |lambda| that the path covers.
  [[nodiscard]] double reach() const { return pieces.empty() ? 0 : pieces.back().end; }
  /// The piece of a load factor, 0 <= |load_factor| <= reach().
  [[nodiscard]] Index piece_of(double load_factor) const;
  /// Contact coordinates there, (n).
  [[nodiscard]] VectorXd at(double load_factor) const;
};

/// Follows a piecewise linear joint from corner to corner: a fastener makes or loses contact, yields, or a rim's
/// friction changes its side (docs/theory.md, section 8.6). Each piece is solved on its own, so that errors do not add
/// up.
///
/// A plate that gaps leave free moves as little as the equations allow; a load that meets no stiffness moves it at
/// constant load until a fastener bears. The path ends before `target` where none does, or where friction makes it turn
/// back.
///
/// @param equations is_piecewise_linear
/// @param target    Load factor, either sign.
[[nodiscard]] ExactPath exact_path(const JointEquations& equations, double target);

/// Forces of all planes on the exact path at a load factor, (n).
[[nodiscard]] VectorXd exact_forces(const JointEquations& equations, double load_factor);

}  // namespace fastjoint::stage3
