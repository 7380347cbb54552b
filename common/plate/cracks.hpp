// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "common/plate/plate_factor.hpp"

namespace fastjoint::plate {

/// Kolosov's constants of an isotropic elasticity: 2 mu (u + i v) = kappa phi - z conj(phi') - conj(psi).
struct Isotropic {
  double mu, kappa;
};
/// @param elasticity (3, 3) of plane stress or plane strain. Throws std::domain_error if it is not isotropic.
[[nodiscard]] Isotropic isotropic(const Eigen::Matrix3d& elasticity);

/// Fracture modes: opening and sliding.
enum class Mode { I, II };

/// A field around a tip at the origin of a crack along the negative x axis.
struct TipField {
  Eigen::Vector2d u;      ///< displacement, per unit of the field
  Eigen::Matrix2d sigma;  ///< stress, per unit of the field
};
/// The dual singular field that extracts a stress intensity factor: phi* = z^(-1/2), psi* = (3/2) z^(-1/2) for mode I,
/// phi* = i z^(-1/2), psi* = -(i/2) z^(-1/2) for mode II. Its crack faces are free (docs/theory.md, section 11.7).
[[nodiscard]] TipField dual_field(Mode mode, const Isotropic& material, const Eigen::Vector2d& x);

/// K_I and K_II of one element of a layer as functions of its coefficients, (2 n_modes, 2): its part of the contour
/// integral in cutoff form, with a cutoff function that falls from 1 to 0 across the layer (docs/theory.md,
/// section 11.7).
[[nodiscard]] Eigen::MatrixX2d stress_intensity_weights(const pfem::ElementMap& map, pfem::Space space, int p,
                                                        const Eigen::Matrix3d& elasticity, const pfem::CrackTip& tip);

/// K_I of all tips, then K_II of all, as functions of the plate's displacements at the degree of a factor, stress
/// length^1/2.
/// @param elasticity Elasticity of each material, stress; isotropic around tips.
/// @param layer The layer to integrate over. The results differ by the discretisation error only.
[[nodiscard]] PlateFactor::Functions stress_intensities(const PlateFactor& factor, const pfem::Mesh& mesh,
                                                        const pfem::Edges& edges, const pfem::Numbering& numbering,
                                                        const std::vector<Eigen::Matrix3d>& elasticity,
                                                        const std::vector<pfem::CrackTip>& tips, int layer = 0);

}  // namespace fastjoint::plate
