// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stage3_nonlinear/equations/joint_equations.hpp"

namespace fastjoint::stage3 {

/// Load factors between which nothing happens: c = offset + |lambda| rate.
struct PathPiece {
  double begin, end;             ///< |lambda|
  Eigen::VectorXd offset, rate;  ///< (n) force
};

/// The path of a joint from no load on, for load factors of one sign.
struct ExactPath {
  double sign = 1;                ///< of the load factors
  std::vector<PathPiece> pieces;  ///< from |lambda| = 0 on, each from the end of the one before

  /// Largest |lambda| that the path covers.
  [[nodiscard]] double reach() const { return pieces.empty() ? 0 : pieces.back().end; }
  /// The piece of a load factor, 0 <= |load_factor| <= reach().
  [[nodiscard]] std::size_t piece_of(double load_factor) const;
  /// Contact coordinates there, (n).
  [[nodiscard]] Eigen::VectorXd at(double load_factor) const;
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

}  // namespace fastjoint::stage3
