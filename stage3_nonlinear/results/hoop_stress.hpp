// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "common/rim/harmonics.hpp"
#include "common/rim/rim_compliance.hpp"

namespace fastjoint::stage3 {

/// Pressure and shear on the sheet at an angle on the modelled part of the rim, stress.
using Tractions = std::function<Eigen::Vector2d(double angle)>;

/// Tractions on a rim at equidistant points around the whole circle, and their waves.
class TractionWaves {
 public:
  /// @param rim       A whole rim, or a part of one by symmetry.
  /// @param tractions Those on the sheet; called with angles on the modelled part of the rim.
  TractionWaves(const rim::Harmonics& rim, Tractions tractions);

  /// Tractions along x and y at any angle of the whole circle, stress.
  [[nodiscard]] Eigen::Vector2d at(double angle) const;
  /// The same at the points, (2, n_points).
  [[nodiscard]] const Eigen::Matrix2Xd& values() const { return values_; }
  /// Waves m = 0.. of these, (2, n_points / 2).
  [[nodiscard]] const Eigen::Matrix2Xcd& waves() const { return waves_; }
  /// Angles of the points, radians.
  [[nodiscard]] static Eigen::VectorXd angles();

  static constexpr int n_points = 1024;

 private:
  rim::Harmonics rim_;
  Tractions tractions_;
  Eigen::Matrix2Xd values_;
  Eigen::Matrix2Xcd waves_;
};

/// Hoop stress around a rim as a function of the angle, from the long waves of its displacement and from its known
/// tractions (docs/theory.md, section 11).
///
/// The hoop strain is the sum of the long waves, which the finite elements give by energy products, and of the short
/// waves by the tractions in an infinite sheet (RimCompliance), which decay close to the hole. Hooke's law and the
/// tractions then give the hoop stress.
class HoopStress {
 public:
  /// @param waves        A whole rim, or a part of one by symmetry.
  /// @param displacement Normal, then tangential displacement of the disc relative to the sheet, or minus that of the
  ///                     sheet relative to any rigid body, (size + n_shears), length.
  HoopStress(const rim::RimCompliance& sheet, const rim::Harmonics& waves, const Eigen::VectorXd& displacement,
             std::shared_ptr<const TractionWaves> tractions);

  /// Hoop stress at an angle, radians.
  [[nodiscard]] double at(double angle) const;
  /// Change of the hoop stress at the points if orders first..end-1 of the elements followed from the tractions, as all
  /// shorter waves do, (n_points).
  [[nodiscard]] Eigen::VectorXd change_by_tractions(int first, int end) const;
  /// Angles of the points of TractionWaves, radians, and the hoop stress there.
  [[nodiscard]] const Eigen::VectorXd& angles() const { return angles_; }
  [[nodiscard]] const Eigen::VectorXd& values() const { return values_; }
  [[nodiscard]] const rim::RimCompliance& sheet() const { return sheet_; }
  [[nodiscard]] const TractionWaves& tractions() const { return *tractions_; }
  /// Waves m = 0.. of the sheet's displacements along x and y that are known from the elements, (2, n), length.
  [[nodiscard]] const Eigen::Matrix2Xcd& displacement_waves() const { return u_; }

 private:
  /// Hoop stress by the hoop strain.
  /// @param normal (cos, sin) of the angle.
  [[nodiscard]] double hoop(double angle, const Eigen::Vector2d& normal, double strain,
                            const Eigen::Vector2d& traction) const;
  /// Hoop strain.
  /// @param imaginary Imaginary part of the sum over m >= first_short of (X_m, Y_m) e^(-i m angle).
  [[nodiscard]] double strain(const Eigen::Vector2d& normal, const Eigen::Vector2d& imaginary,
                              const Eigen::Vector2d& traction) const;

  rim::RimCompliance sheet_;
  std::shared_ptr<const TractionWaves> tractions_;
  int first_short_;      ///< lowest order along x and y that is computed from the tractions
  Eigen::Matrix2Xcd u_;  ///< (2, first_short) waves m = 0.. of the displacements along x and y, length
  Eigen::VectorXd angles_, values_;
};

}  // namespace fastjoint::stage3
