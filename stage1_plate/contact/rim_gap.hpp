// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/count.hpp"
#include "common/rim/rim.hpp"
#include "stage1_plate/problem/plate_problem.hpp"

namespace fastjoint::stage1 {

/// Arcs of one rim, radians counter-clockwise; each starts in [-pi, pi), ascending, and none touches another.
using Arcs = std::vector<rim::AngleRange>;
inline const Arcs whole_rim = {{-rim::full_turn / 2, rim::full_turn / 2}};

/// Joins the pieces that touch, across +-pi too; a whole circle is one arc from -pi to pi. Pieces do not overlap.
[[nodiscard]] Arcs joined(std::vector<rim::AngleRange> pieces);

/// How far the farthest end has moved, radians; infinite if the number of arcs differs.
[[nodiscard]] double largest_move(const Arcs& before, const Arcs& after);

/// What the gap functions of contact depend on: the n_r free coefficients on the rims of the holes whose springs push
/// but do not pull, then the nc controlled displacements. z denotes their values, shape (n_r + nc).
struct RimUnknowns {
  std::vector<int> free;           ///< (n_r) free plate unknowns, ascending
  std::vector<int> index_in_free;  ///< (n_f) of each free unknown, or -1
  int n_controlled;

  [[nodiscard]] int size() const { return count_of(free) + n_controlled; }
  /// Index in z of a degree of freedom, or -1 for a fixed one.
  [[nodiscard]] int index(int dof) const;
};
[[nodiscard]] RimUnknowns find_rim_unknowns(const PlateScene& scene, const PlateMesh& plate,
                                            const PlateProblem& problem);

/// How deep the disc presses into the rim of one hole, g = D.n - u.n, as a linear function of z at every point: the
/// springs transmit the pressure k g where it is positive.
class RimGap {
 public:
  RimGap(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem, const RimUnknowns& unknowns,
         int hole);

  /// int k t a a^T ds over the arcs, where g = a.z: the springs' stiffness over z, shape (n_r + nc, n_r + nc).
  [[nodiscard]] Eigen::MatrixXd stiffness(const Arcs& arcs) const;
  /// The arcs on which g > 0, their ends to 1e-12 of a side.
  [[nodiscard]] Arcs pressed(const Eigen::VectorXd& z) const;
  /// The part of the rim that the model has and that bears along the unit vector d.
  [[nodiscard]] Arcs bearing_half(const Eigen::Vector2d& d) const;
  /// Angles where the rim ends, on lines of symmetry; none of a whole rim.
  [[nodiscard]] std::vector<double> ends() const;
  /// The largest g, and where.
  struct Peak {
    double gap, angle;
  };
  [[nodiscard]] Peak peak(const Eigen::VectorXd& z) const;

 private:
  /// Coefficients of g on one side.
  struct SideGap {
    std::vector<int> index;  ///< (n) in z
    Eigen::MatrixXd a;       ///< (n, n_points)
  };
  [[nodiscard]] SideGap side_gap(const pfem::Side& side, const pfem::SideRule& rule) const;
  /// g of a side as a function of its coordinate in [-1, 1].
  class Trace;

  const PlateScene& scene_;
  const PlateMesh& plate_;
  const PlateProblem& problem_;
  const RimUnknowns& unknowns_;
  int hole_;
};

}  // namespace fastjoint::stage1
