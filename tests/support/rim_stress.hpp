// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stage2_extract/field/fields.hpp"

namespace fastjoint::test {

/// A point of a rim as one side of it sees the point.
struct OnSide {
  pfem::Side side;
  double s;          ///< coordinate along the side's natural direction, in [-1, 1]
  double ds_dtheta;  ///< of that coordinate by the angle, 1 / radian
};

/// A point of a rim, and the one or two sides that meet there.
struct RimPoint {
  double angle;  ///< radians counter-clockwise from x
  std::vector<OnSide> on;
};

/// Steps of 5 degrees: the largest of a stress that goes as cos 2 theta, read off the parabola through three points,
/// is then known to 1e-4 of it.
inline constexpr int n_points_per_turn = 72;

/// Points all around a whole rim from 0 on, or from one end of a part of it to the other, both included, in as many
/// equal steps as come closest to 5 degrees. No point of a rim without sides.
[[nodiscard]] std::vector<RimPoint> rim_points(const pfem::Mesh& mesh, const pfem::Edges& edges, const rim::Rim& rim);

/// Stresses at points of a rim in k states, each of shape (k, n_points).
struct RimStresses {
  Eigen::MatrixXd rr, tt, rt;
};

/// The rim of a hole, ready to take stresses from fields of the degree that the solver has now: at points, where the
/// program has them in waves.
///
/// sigma_rr and sigma_rt are the known tractions of springs, waves of contact, bearing load and friction; sigma_tt
/// follows from them and the strain of the elements along the rim by the material's law, without a derivative across
/// the rim. The mean of both sides counts where two meet. tests/bench/rim_stress.cpp compares this with three other
/// ways.
class RimStress {
 public:
  RimStress(const stage2::FieldSolver& solver, int hole, const std::vector<RimPoint>& points);
  [[nodiscard]] RimStresses operator()(const stage2::Fields& fields) const;

 private:
  /// One side with its points.
  struct SidePoints {
    std::vector<int> points;
    plate::CondensedFunctions u_n_and_hoop;  ///< radial displacements of all its points, then their hoop strains
    Eigen::Matrix3Xd hoop;                   ///< what sigma_rr, that strain and sigma_rt give of sigma_tt at each
    Eigen::RowVectorXd share;                ///< of this side in the mean at each
  };
  void add_side(const stage2::FieldSolver& solver, int hole, const pfem::Side& side,
                const std::vector<RimPoint>& points);
  void add_tractions(const stage2::FieldSolver& solver, int hole, const std::vector<RimPoint>& points);

  std::vector<SidePoints> sides_;
  std::vector<Eigen::Index> loading_;  ///< unit cases with tractions at this rim
  Eigen::MatrixXd tractions_;          ///< (loading, 2 points) their sigma_rr at every point, then sigma_rt
  Eigen::RowVectorXd modulus_;         ///< (points) of the springs, 0 where none act
};

}  // namespace fastjoint::test
