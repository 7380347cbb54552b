// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace fastjoint::stage3 {

/// Secondary bending of a sheet at one increment. Columns are free heads, clamped heads; NaN where not computed. Empty
/// without bending.
struct PlateBending {
  Eigen::MatrixXd moment;              ///< (rows, 4) before the row, then behind it; force length
  Eigen::MatrixXd k_b, deflection;     ///< (rows, 2) ratio, length
  Eigen::VectorXd pressed;             ///< (rows) 1 where free heads have the value of clamped ones
  Eigen::MatrixXd stress;              ///< (r, 2) of bending on the face with the larger peak, at its worse side
  Eigen::MatrixXd lower, lower_angle;  ///< (r, 2) peak with bending on the lower face, stress, degrees
  Eigen::MatrixXd upper, upper_angle;  ///< (r, 2) on the upper face
  Eigen::MatrixXd De, Pe;              ///< (e, 2) of rigid externals, length, force

  Eigen::MatrixXd at_tip;  ///< (t, 2) k_b of the row next to each tip of a crack

  std::array<bool, 2> computed{};  ///< heads

  PlateBending() = default;
  PlateBending(Eigen::Index rows, Eigen::Index holes, Eigen::Index externals, Eigen::Index tips)
      : moment(none(rows, 4)),
        k_b(none(rows, 2)),
        deflection(none(rows, 2)),
        pressed(Eigen::VectorXd::Zero(rows)),
        stress(none(holes, 2)),
        lower(none(holes, 2)),
        lower_angle(none(holes, 2)),
        upper(none(holes, 2)),
        upper_angle(none(holes, 2)),
        De(none(externals, 2)),
        Pe(none(externals, 2)),
        at_tip(none(tips, 2)) {}

 private:
  static Eigen::MatrixXd none(Eigen::Index rows, Eigen::Index columns) {
    return Eigen::MatrixXd::Constant(rows, columns, std::nan(""));
  }
};

}  // namespace fastjoint::stage3
