// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace fastjoint::pfem {

enum class Analysis { plane_stress, plane_strain };

/// Material constants (3D, engineering). Isotropic materials have E1 = E2 = E3 and so on.
struct OrthotropicConstants {
  double E1, E2, E3;        ///< stress
  double nu12, nu13, nu23;  ///< nu_ij = -strain_j / strain_i under stress along i
  double G12;               ///< stress
};

[[nodiscard]] OrthotropicConstants isotropic(double E, double nu);

/// True if the strain energy is positive for every strain that is possible in the analysis.
[[nodiscard]] bool is_stable(const OrthotropicConstants& constants, Analysis analysis);

/// Stiffness that relates (sigma_x, sigma_y, tau_xy) to (eps_x, eps_y, gamma_xy), for material axes turned by
/// `angle` (radians, counter-clockwise from x to axis 1). Plane stress ignores E3, nu13, nu23.
/// Jones, Mechanics of Composite Materials, 2nd ed. 1999, sections 2.4-2.6.
[[nodiscard]] Eigen::Matrix3d elasticity(const OrthotropicConstants& constants, double angle, Analysis analysis);

/// True if an elasticity, (3, 3), has no preferred direction, to rounding of its input.
[[nodiscard]] bool is_isotropic(const Eigen::Matrix3d& elasticity);

/// Rotation matrix, (3, 3), from stresses (sigma_x, sigma_y, tau_xy) to (sigma_rr, sigma_tt, sigma_rt) at the angle
/// theta, radians counter-clockwise from x. Its inverse is the matrix for -theta.
[[nodiscard]] Eigen::Matrix3d polar_stress(double theta);

}  // namespace fastjoint::pfem
