// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stage1_plate/contact/rim_gap.hpp"

namespace fastjoint::stage1 {

/// The plate condensed to its rim unknowns r and its controlled displacements c (docs/theory.md, section 6.5). Under
/// displacements D, tractions f, friction amplitudes Lambda and additional loads phi on r:
/// u_r = U_r D + V_r f + W_r Lambda + C phi,  P_c = S D + R Lambda + T f - U_r^T phi.
struct RimCondensation {
  Eigen::MatrixXd C;    ///< (n_r, n_r) length / force
  Eigen::MatrixXd U_r;  ///< (n_r, nc)
  Eigen::MatrixXd V_r;  ///< (n_r, q) length / force
  Eigen::MatrixXd W_r;  ///< (n_r, h) length / stress
  Eigen::MatrixXd S;    ///< (nc, nc) force / length
  Eigen::MatrixXd T;    ///< (nc, q)
  Eigen::MatrixXd R;    ///< (nc, h) length^2
};

/// The plate under the scene's loads with springs on given arcs of the holes whose springs push but do not pull.
///
/// The plate has the springs on the whole rims; those off the arcs are taken away again by the change of stiffness dM
/// over z. What is left is a system of three blocks for the rim's displacements, the controlled displacements and the
/// forces on these (docs/theory.md, section 6.5).
class ContactSystem {
 public:
  ContactSystem(const PlateScene& scene, const PlateMesh& plate, const PlateProblem& problem);

  struct State {
    Eigen::VectorXd z;             ///< (n_r + nc), see RimUnknowns
    Eigen::VectorXd displacement;  ///< (nc) length, the last part of z
    Eigen::VectorXd force;         ///< (nc) on externals and discs from outside
    Eigen::VectorXd friction;      ///< (h) amplitudes, stress
    bool friction_settled;         ///< whether the sides that bear are those that friction was taken on
  };
  /// The solution under the loads with these sprung arcs, one list for each of holes(). Throws NumericalError if they
  /// leave something free to move.
  [[nodiscard]] State solve(const std::vector<Arcs>& arcs);

  [[nodiscard]] const std::vector<int>& holes() const { return holes_; }
  [[nodiscard]] const RimGap& gap(std::size_t i) const { return gaps_[i]; }
  [[nodiscard]] const Eigen::VectorXd& traction() const { return traction_; }

 private:
  [[nodiscard]] Eigen::MatrixXd friction_per_force() const;
  [[nodiscard]] bool choose_sides(const Eigen::VectorXd& force);
  [[noreturn]] void lost(const std::vector<Arcs>& arcs) const;

  const PlateScene& scene_;
  const PlateMesh& plate_;
  const PlateProblem& problem_;
  RimUnknowns rim_;
  RimCondensation plate_matrices_;
  std::vector<int> holes_;
  std::vector<RimGap> gaps_;
  std::vector<Load> loads_;   ///< (nc)
  Eigen::VectorXd traction_;  ///< (q)
  std::vector<int> side_;     ///< (nc) of each disc: +1 or -1, the side that bears; 0 before that is known
  Eigen::MatrixXd whole_;     ///< stiffness over z of the springs on the whole rims
};

}  // namespace fastjoint::stage1
