// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/formats/plate_matrices.hpp"

namespace fastjoint::stage3 {

/// Names of the axes.
inline constexpr std::array axis_names{"x", "y"};

/// The matrices of a plate at the last of its degrees up to that of the joint, rising; S, R, T as PlateModel has them.
struct PlateDegrees {
  Eigen::VectorXi p;
  std::vector<Eigen::MatrixXd> S, R, T;
  std::vector<Eigen::MatrixXd> C;  ///< (q, q) C_t, length / force
};

/// A plate at one degree p: its m discs first, hole after hole, then its e rigid externals, as unknowns of one list.
///
/// Forces that must act on it from outside: S u + R Lambda + T f (docs/theory.md, section 4).
struct PlateModel {
  std::string name, file;
  std::string matrices_digest, plate_digest;                 ///< of its MATRICES.h5, and of its PLATE.h5
  std::vector<std::string> holes, externals, tractions;      ///< (m / a), (e), (q)
  std::vector<int> axes;                                     ///< (a) of each hole's discs in their order: 0 x, 1 y
  std::vector<bool> on_springs;                              ///< (m / a) the plate's own bearing is in S
  Eigen::MatrixXd S;                                         ///< (m+e, m+e), force / length
  Eigen::MatrixXd R;                                         ///< (m+e, h), length^2
  Eigen::MatrixXd T;                                         ///< (m+e, q), dimensionless
  std::vector<std::string> friction_hole, friction_bearing;  ///< (h)
  Eigen::VectorXd friction_unit_force, friction_resultant;   ///< (h), length^2
  std::vector<int> external_axis, traction_axis;             ///< (e), (q) 0 x, 1 y
  PlateDegrees degrees;                                      ///< whose sequence shows the error of S
  Eigen::MatrixXd S_error;  ///< (m+e, m+e) the file's; infinite where it does not know it or p is not its highest
  /// Estimated error of S over its largest entry, where the file knows it.
  std::optional<double> relative_error;
  formats::PlateStresses stresses;          ///< as the file has them
  std::optional<std::size_t> stress_level;  ///< those of the joint's degree, if there are any
  // Loads at load factor 1.
  Eigen::VectorXd external_force;                            ///< (e), 0 where a displacement is given
  std::vector<std::optional<double>> external_displacement;  ///< (e)
  Eigen::VectorXd traction_force;                            ///< (q)

  /// m: unknowns of the discs.
  [[nodiscard]] Eigen::Index n_discs() const { return holes.size() * axes.size(); }
  [[nodiscard]] Eigen::Index n_externals() const { return externals.size(); }
  /// Hole of a disc unknown.
  [[nodiscard]] const std::string& hole_of(Eigen::Index disc) const { return holes[disc / axes.size()]; }
  [[nodiscard]] int axis_of(Eigen::Index disc) const { return axes[disc % axes.size()]; }
  [[nodiscard]] Eigen::Index n_unknowns() const { return n_discs() + n_externals(); }
};

/// The matrices at degree p, checked: the same directions of all discs, names that stand once, S symmetric and positive
/// semi-definite. Throws FileError or InputError with the file and the dataset.
[[nodiscard]] PlateModel make_plate(const std::string& name, const std::string& file, formats::PlateMatrices matrices,
                                    int p);

}  // namespace fastjoint::stage3
